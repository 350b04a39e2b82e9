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
  /// The type of the cells; numbers are aligned to the right.
  enum class Kind { text, number };

  std::string name;        ///< name of the column in JSON: letters, digits and underscores; unique in its table
  std::string heading;     ///< heading for readers, without the unit
  std::string unit;        ///< unit of the whole column; empty if it has none, or if each cell states its own
  Kind kind = Kind::text;  ///< type of the cells
  /// The order in which columns are removed if there is not enough room: the columns with the largest number first.
  /// Columns with equal numbers form a group, which is removed as a whole and is named by the heading of its first
  /// column. Columns with 0 are never removed.
  int dispensable = 0;
  /// True if a page leaves the column out, because tolerance frames in another column show the same content.
  bool only_text = false;
  /// True if a narrow page never hides the column. If no column of a table is main, its first number is never hidden.
  bool main = false;
};

/// A cell of a table.
struct Cell {
  std::string text;  ///< text that is shown, with rounded numbers; "-" if there is no number
  /// The number that the text shows, in the same unit, not rounded; none if there is no number or it is not finite.
  std::optional<double> value;
  /// The number of the cell if it is a whole number. It is stored separately because a double rounds large whole
  /// numbers.
  std::optional<std::uint64_t> whole = std::nullopt;
  /// The boxes of a tolerance frame, from left to right, which a page draws instead of the text; empty: the page shows
  /// the text.
  std::vector<std::string> boxes = {};
};

/// A table as plain values. Terminal, report and JSON show the same cells, and for this reason the same digits.
struct Table {
  std::string name;                          ///< name in JSON and in links: letters, digits and underscores
  std::string caption;                       ///< one line that describes the table
  std::vector<Column> columns;               ///< columns from left to right
  std::vector<std::vector<Cell>> rows = {};  ///< rows, each with columns.size() cells
  std::vector<std::string> notes = {};       ///< sentences below the table
  bool ranked = false;                       ///< true if the rows are ranked errors
};

/// The value of `width` with which text_of() removes no column, for output that is not a terminal.
inline constexpr std::size_t kUnlimitedWidth = std::numeric_limits<std::size_t>::max();

/// The number of characters of a number from its decimal point to its end: 3 in "4.25". If it has no decimal point, the
/// characters from its exponent to its end count. 0 for a cell without a number.
std::size_t tail_of(const Cell& cell);

/// Wraps a text between words at `width`, at most at 100 characters. Lines end with '\n'. A longer word has a line of
/// its own. Control characters are shown as '?', here and in tables, because names may come from any file.
std::string prose_of(std::string_view prose, std::size_t width);

/// A table as lines of text that end with '\n': caption, headings with units, rows, notes. Texts are aligned left,
/// numbers by their decimal points. If the table is wider than `width`, columns are removed (Column::dispensable), and
/// a line names them and says that `remedy` shows more. If the table is still too wide, its lines are longer than
/// `width`; names are never cut. Notes are wrapped by prose_of(). No line ends with a blank.
std::string text_of(const Table& table, std::size_t width, std::string_view remedy = "a wider terminal");

/// Tables one below the other, with an empty line in between.
std::string text_of(std::span<const Table> tables, std::size_t width, std::string_view remedy = "a wider terminal");

}  // namespace poesy
