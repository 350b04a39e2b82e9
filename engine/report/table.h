#pragma once

#include <optional>
#include <string>
#include <vector>

namespace poesy {

/// One column of a table.
struct Column {
  /// Numbers stand to the right.
  enum class Kind { text, number };

  std::string name;        ///< of the value in JSON: letters, digits and underscores; unique in its table
  std::string heading;     ///< what the reader sees above it, without the unit
  std::string unit;        ///< in which the whole column is shown; empty where it has none, or each cell names its own
  Kind kind = Kind::text;  ///< of what stands below the title
  /// Where the room does not suffice, the columns of the largest number go first, all of them together, for they belong
  /// to each other and the first one's heading speaks for all; those of 0 never go.
  int dispensable = 0;
};

/// What stands in one place of a table.
struct Cell {
  std::string text;  ///< as shown, rounded; "-" where there is no number
  /// The number behind it in the unit shown, not rounded; none where there is no finite one.
  std::optional<double> value;
};

/// A table as plain values. Terminal, report and JSON show the same cells, so they show the same digits.
struct Table {
  std::string name;                          ///< in JSON and as an anchor: letters, digits and underscores
  std::string caption;                       ///< one line that says what is seen
  std::vector<Column> columns;               ///< from left to right
  std::vector<std::vector<Cell>> rows = {};  ///< each of columns.size() cells
  std::vector<std::string> notes = {};       ///< sentences that a reader needs below the table
  bool ranked = false;                       ///< whether its rows are the errors in the order that was asked for
};

}  // namespace poesy
