#pragma once

#include <cstddef>
#include <limits>
#include <span>
#include <string>
#include <string_view>

#include "engine/report/table.h"

namespace poesy {

/// The width of what is no terminal: nothing is left out.
inline constexpr std::size_t kUnlimitedWidth = std::numeric_limits<std::size_t>::max();

/// What shows the columns that a narrower one has no room for.
inline constexpr std::string_view kWiderTerminal = "a wider terminal";

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
std::string text_of(const Table& table, std::size_t width, std::string_view remedy = kWiderTerminal);

/// Tables one below the other, with an empty line in between.
std::string text_of(std::span<const Table> tables, std::size_t width, std::string_view remedy = kWiderTerminal);

}  // namespace poesy
