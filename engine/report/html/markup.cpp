#include "engine/report/html/markup.h"

#include <fmt/format.h>

#include <cstddef>
#include <cstdint>

namespace poesy {
namespace {

constexpr std::string_view kReplacement = "\xEF\xBF\xBD";

unsigned char byte_at(std::string_view text, std::size_t at) { return static_cast<unsigned char>(text[at]); }

/// How many bytes a character has that begins so; 0 where none does.
std::size_t length_from(unsigned char first) {
  if (first < 0x80) return 1;
  if (first >= 0xC2 && first <= 0xDF) return 2;
  if (first >= 0xE0 && first <= 0xEF) return 3;
  return first >= 0xF0 && first <= 0xF4 ? 4 : 0;
}

/// Whether so many bytes at the start of the text are one character: no overlong form, no surrogate, no number above
/// U+10FFFF.
bool is_character(std::string_view text, std::size_t length) {
  if (length == 0 || length > text.size()) return false;
  for (std::size_t n = 1; n < length; ++n) {
    if ((byte_at(text, n) & 0xC0) != 0x80) return false;
  }
  if (length < 3) return true;
  const unsigned char first = byte_at(text, 0);
  const unsigned char second = byte_at(text, 1);
  if (first == 0xE0) return second >= 0xA0;
  if (first == 0xED) return second < 0xA0;
  if (first == 0xF0) return second >= 0x90;
  return first != 0xF4 || second < 0x90;
}

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
      return byte_at(character, 0) < 0x20 || character.front() == 0x7F ? kReplacement : character;
  }
}

}  // namespace

std::string escaped(std::string_view text) {
  std::string safe;
  safe.reserve(text.size());
  while (!text.empty()) {
    const std::size_t length = length_from(byte_at(text, 0));
    const bool whole = is_character(text, length);
    const std::string_view character = text.substr(0, whole ? length : 1);
    if (!whole) {
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
