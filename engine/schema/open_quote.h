#pragma once

#include <cstddef>
#include <optional>
#include <string_view>

namespace poesy {

/// A quote that opens a string of a TOML text.
struct OpenQuote {
  std::size_t line;        ///< line of the quote, from 1
  std::size_t column;      ///< column of the quote in characters, from 1
  std::string_view quote;  ///< one of " ' """ '''; a view of the text

  /// True if the string that the quote opens must end on the same line.
  bool is_of_one_line() const { return quote.size() == 1; }
};

/// The first quote whose string is not closed. A string in single or double quotes must be closed on its line, a string
/// in triple quotes before the end of the text. Quotes in comments and escaped quotes do not count. None if all strings
/// are closed.
std::optional<OpenQuote> open_quote(std::string_view text);

}  // namespace poesy
