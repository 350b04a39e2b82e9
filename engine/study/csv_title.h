#pragma once

#include <optional>
#include <string_view>

#include "engine/base/units.h"
#include "engine/study/text_file.h"

/// Titles of the columns of a table that poesy reads.
namespace poesy {

/// A column's title, split into name and unit: "z [mm]" has the name "z" and the unit "mm". A title without brackets
/// has no unit.
struct CsvTitle {
  explicit CsvTitle(std::string_view text);  ///< text: a cell of the first line, which must outlive it.

  std::string_view name;                 ///< without the unit
  std::optional<std::string_view> unit;  ///< unit as written; none without brackets
};

/// The size in SI of the unit of a column; 1 if its title has no unit. Throws InputError at the cell if the unit is
/// unknown or belongs to another dimension.
double size_of_unit(const CsvCell& cell, const CsvTitle& title, Dimension dimension);

/// Throws InputError if a title is in quotes or holds tabs, because then the file is not a table that poesy reads.
void refuse_other_tables(const CsvCell& cell);

}  // namespace poesy
