#pragma once

#include <cstddef>
#include <optional>
#include <string_view>
#include <vector>

#include "engine/base/units.h"
#include "engine/study/text_file.h"

/// The titles of columns in tables that poesy reads.
namespace poesy {

/// The title of a column, split into name and unit: "z [mm]" has the name "z" and the unit "mm". A title without
/// brackets has no unit.
struct CsvTitle {
  explicit CsvTitle(std::string_view text);  ///< text: a cell of the first line, which must outlive this object.

  std::string_view name;                 ///< name without the unit
  std::optional<std::string_view> unit;  ///< unit as written; none if there are no brackets
};

/// The factor that converts numbers of the column to SI; 1 if the title has no unit. Throws InputError at the cell if
/// the unit is unknown or is not a unit of this dimension.
double size_of_unit(const CsvCell& cell, const CsvTitle& title, Dimension dimension);

/// Throws InputError if a title that the table does not know has its unit in parentheses ("z (mm)"), or begins with
/// "#", the sign of comments in other programs.
void refuse_other_tables(const CsvCell& cell);

/// Throws InputError if a line does not have this number of cells. columns: the number of columns of the table.
void check_cell_count(const std::vector<CsvCell>& cells, std::size_t columns);

}  // namespace poesy
