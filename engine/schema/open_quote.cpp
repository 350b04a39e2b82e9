#include "engine/schema/open_quote.h"

namespace poesy {
namespace {

/// A place in a text, with its line and column.
class Cursor {
 public:
  explicit Cursor(std::string_view text) : text_(text) {}

  bool at_end() const { return at_ == text_.size(); }
  char operator*() const { return text_[at_]; }
  bool is_before(std::string_view part) const { return text_.substr(at_).starts_with(part); }

  void advance(std::size_t bytes = 1) {
    for (; bytes > 0 && !at_end(); --bytes) {
      const char byte = text_[at_++];
      const bool begins_character = (static_cast<unsigned char>(byte) & 0xC0U) != 0x80U;
      if (byte == '\n') {
        ++line_;
        column_ = 1;
      } else if (begins_character) {
        ++column_;
      }
    }
  }

  /// The quote at this place: three equal characters, or one.
  OpenQuote quote() const {
    const std::string_view three = text_.substr(at_, 3);
    const bool is_long = three.size() == 3 && three[1] == three[0] && three[2] == three[0];
    return {line_, column_, three.substr(0, is_long ? 3 : 1)};
  }

 private:
  std::string_view text_;
  std::size_t at_ = 0;
  std::size_t line_ = 1;
  std::size_t column_ = 1;
};

/// Moves past the string that this quote opens. Returns true if the string is closed.
bool pass_string(Cursor& cursor, const OpenQuote& opened) {
  const char mark = opened.quote.front();
  cursor.advance(opened.quote.size());
  while (!cursor.at_end() && !cursor.is_before(opened.quote)) {
    if (*cursor == '\n' && opened.is_of_one_line()) return false;
    const bool escapes = mark == '"' && *cursor == '\\';
    cursor.advance();
    if (escapes && !cursor.at_end() && *cursor != '\n') cursor.advance();
  }
  if (cursor.at_end()) return false;
  cursor.advance(opened.quote.size());
  // A string in triple quotes may end with one or two quotes of its own before the closing three. Three quotes have
  // been passed, so one or two may be left.
  for (int own = 0; own < 2 && !opened.is_of_one_line() && !cursor.at_end() && *cursor == mark; ++own) cursor.advance();
  return true;
}

}  // namespace

std::optional<OpenQuote> open_quote(std::string_view text) {
  Cursor cursor(text);
  while (!cursor.at_end()) {
    if (*cursor == '#') {
      while (!cursor.at_end() && *cursor != '\n') cursor.advance();
    } else if (*cursor == '"' || *cursor == '\'') {
      const OpenQuote opened = cursor.quote();
      if (!pass_string(cursor, opened)) return opened;
    } else {
      cursor.advance();
    }
  }
  return std::nullopt;
}

}  // namespace poesy
