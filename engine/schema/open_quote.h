#pragma once

#include <cstddef>
#include <optional>
#include <string_view>

namespace poesy {

/// A quote that opens a string of a TOML text.
struct OpenQuote {
  std::size_t line;        ///< counts from 1
  std::size_t column;      ///< counts from 1, in characters
  std::string_view quote;  ///< one of " ' """ '''; a view of the text

  bool is_of_one_line() const { return quote.size() == 1; }  ///< Whether its string has to end on its line.
};

/// The first quote whose string is not closed: on its line, or for a string of several lines up to the end of the text.
/// Comments and escaped quotes do not count. None if all strings are closed.
std::optional<OpenQuote> open_quote(std::string_view text);

}  // namespace poesy
