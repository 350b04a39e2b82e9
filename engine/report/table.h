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
  std::optional<std::uint64_t> whole =
      std::nullopt;  ///< the same where it is a whole number: a double rounds large ones
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

/// The width of what is no terminal: nothing is left out.
inline constexpr std::size_t kUnlimitedWidth = std::numeric_limits<std::size_t>::max();

/// How many characters of a number as shown stand behind its whole part: of "4.25" and of "1e-05" those from the point
/// or the exponent on. 0 where the cell is no number.
std::size_t tail_of(const Cell& cell);

/// A sentence as lines that end with '\n', broken between words at `width`, or at 100 if that is less; a longer word
/// has a line of its own. Control characters are shown as '?', here and in tables: names may come from a stranger's
/// file.
std::string prose_of(std::string_view prose, std::size_t width);

/// A table as lines of text that end with '\n': caption, headings with their units, rows, notes. Text stands left,
/// numbers stand one under the other by their decimal points. Where the table is wider than `width`, the columns that
/// can be dispensed with go (Column::dispensable), and a line says which, and that `remedy` shows more; what cannot may
/// make lines that are longer. Names are never cut. Prose is that of prose_of. No line ends with a blank.
std::string text_of(const Table& table, std::size_t width, std::string_view remedy = "a wider terminal");

/// Tables one below the other, with an empty line in between.
std::string text_of(std::span<const Table> tables, std::size_t width, std::string_view remedy = "a wider terminal");

}  // namespace poesy
