#include "engine/report/html/markup.h"

#include <fmt/format.h>

#include <cstddef>

#include "engine/base/text.h"

namespace poesy {
namespace {

constexpr std::string_view kReplacement = "\xEF\xBF\xBD";

/// One character of one byte.
std::string_view escaped_ascii(std::string_view character) {
  switch (character.front()) {
    case '&':
      return "&amp;";
    case '<':
      return "&lt;";
    case '>':
      return "&gt;";
    case '"':
      return "&quot;";
    case '\'':
      return "&#39;";
    case '\n':
    case '\t':
      return character;
    default:
      return static_cast<unsigned char>(character.front()) < 0x20 || character.front() == 0x7F ? kReplacement
                                                                                               : character;
  }
}

}  // namespace

std::string escaped(std::string_view text) {
  std::string safe;
  safe.reserve(text.size());
  while (!text.empty()) {
    const std::size_t length = character_length(text);
    const std::string_view character = text.substr(0, length == 0 ? 1 : length);
    if (length == 0) {
      safe += kReplacement;
    } else {
      safe += length == 1 ? escaped_ascii(character) : character;
    }
    text.remove_prefix(character.size());
  }
  return safe;
}

std::string element(std::string_view tag, std::string_view text, std::string_view attributes) {
  return fmt::format("<{0}{1}{2}>{3}</{0}>", tag, attributes.empty() ? "" : " ", attributes, escaped(text));
}

}  // namespace poesy
