#pragma once

#include <optional>
#include <string_view>

#include "engine/base/units.h"
#include "engine/study/text_file.h"

/// Titles of the columns of a table that poesy reads.
namespace poesy {

/// The parts of "z [mm]": "z" and "mm". Without brackets there is no unit.
struct CsvTitle {
  explicit CsvTitle(std::string_view text);  ///< text: a cell of the first line, which must outlive it.

  std::string_view name;                 ///< without the unit
  std::optional<std::string_view> unit;  ///< as written
};

/// The size of a column's unit in SI; 1 without a unit. Throws InputError if the unit is unknown or of another
/// dimension.
double size_of_unit(const CsvCell& cell, const CsvTitle& title, Dimension dimension);

/// Throws InputError if a title is in quotes or holds tabs.
void refuse_other_tables(const CsvCell& cell);

}  // namespace poesy
