#pragma once

#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "engine/base/units.h"
#include "engine/io/csv_lines.h"

namespace poesy {

/// A column of numbers that a table may have.
struct KnownColumn {
  std::string_view name;   ///< as the header has it
  Dimension dimension;     ///< of its numbers
  std::string_view meant;  ///< the name that it means: its own, unless it is another word for it
};

/// What the header of a table may name.
struct KnownColumns {
  std::vector<KnownColumn> numbers;           ///< what is read
  std::vector<std::string_view> facts = {};   ///< other columns that `poesy export` writes: passed over
  std::vector<std::string_view> labels = {};  ///< of which one may name the rows
  std::string_view what;                      ///< a column of numbers, for messages: "pose coordinate"
};

/// A column of a table that is being read.
struct TableColumn {
  /// What its cells are.
  enum class Role { number, fact, label };
  Role role;                                ///< of its cells
  std::string_view name;                    ///< KnownColumn::meant, or one of KnownColumns::labels; refers to these
  std::string_view title;                   ///< as the header has it, with its unit; refers to the lines
  Dimension dimension = Dimension::number;  ///< of its numbers
  double si = 1.0;                          ///< by which its numbers are multiplied

  /// "z [mm]": how the header may say the unit in which people read such numbers.
  std::string with_unit() const;
};

/// Reads the first line. A name may be followed by the unit of its numbers in brackets, "z [mm]"; without one they are
/// SI. Throws InputError with its place for a column that is unknown, is there a second time, or has a unit that is
/// unknown or measures something else, and for two columns that name the rows.
std::vector<TableColumn> read_header(CsvLines& lines, const KnownColumns& known);

}  // namespace poesy
