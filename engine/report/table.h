#pragma once

#include <cstddef>
#include <cstdint>
#include <limits>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

/// Tables as plain values, and as text for a terminal.
namespace poesy {

/// One column of a table.
struct Column {
  /// The kind of cells; numbers are aligned to the right.
  enum class Kind { text, number };

  std::string name;        ///< name of the values in JSON: letters, digits and underscores; unique in its table
  std::string heading;     ///< heading for readers, without the unit
  std::string unit;        ///< unit of the whole column; empty if it has none, or if each cell states its own
  Kind kind = Kind::text;  ///< kind of its cells
  /// If there is too little room, the columns with the largest number are removed first, all of them together because
  /// they belong together; the heading of the first one names the group. Columns with 0 are never removed.
  int dispensable = 0;
  bool only_text = false;  ///< whether a page leaves it out, because boxes of another column show it
};

/// A cell of a table.
struct Cell {
  std::string text;  ///< text that is shown, rounded; "-" if there is no number
  /// The number in the unit shown, not rounded; none if it is not finite.
  std::optional<double> value;
  std::optional<std::uint64_t> whole =
      std::nullopt;  ///< the same number if it is whole, because a double rounds large ones
  /// What a page draws instead of the text: the boxes of a tolerance frame, from left to right. Empty: the text.
  std::vector<std::string> boxes = {};
};

/// A table as plain values. Terminal, report and JSON show the same cells and so the same digits.
struct Table {
  std::string name;                          ///< name in JSON and as an anchor: letters, digits and underscores
  std::string caption;                       ///< one line that describes the table
  std::vector<Column> columns;               ///< from left to right
  std::vector<std::vector<Cell>> rows = {};  ///< each of columns.size() cells
  std::vector<std::string> notes = {};       ///< sentences below the table
  bool ranked = false;                       ///< whether its rows are ranked errors
};

/// The width if stdout is not a terminal: columns are never removed.
inline constexpr std::size_t kUnlimitedWidth = std::numeric_limits<std::size_t>::max();

/// The number of characters after the whole part of a number: in "4.25" and "1e-05" from the point or the exponent on.
/// 0 for a cell without a number.
std::size_t tail_of(const Cell& cell);

/// Wraps a text between words at `width`, at most 100; lines end with '\n', and a longer word has its own line. Control
/// characters are shown as '?', here and in tables, because names may come from any file.
std::string prose_of(std::string_view prose, std::size_t width);

/// A table as lines of text that end with '\n': caption, headings with units, rows, notes. Text is aligned left,
/// numbers by their decimal points. If the table is wider than `width`, columns are removed (Column::dispensable), and
/// a line names them and says that `remedy` shows more. If it is still too wide, lines are longer; names are never cut.
/// Notes are wrapped by prose_of(). No line ends with a blank.
std::string text_of(const Table& table, std::size_t width, std::string_view remedy = "a wider terminal");

/// Tables one below the other, with an empty line in between.
std::string text_of(std::span<const Table> tables, std::size_t width, std::string_view remedy = "a wider terminal");

}  // namespace poesy
