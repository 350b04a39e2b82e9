#pragma once

#include <gtest/gtest.h>

#include <string>
#include <string_view>
#include <vector>

#include "engine/base/error.h"

namespace poesy::test {

/// A text in which '^' marks the place of a mistake: the text without the mark, and the line and column of the mark.
struct Marked {
  explicit Marked(std::string_view marked) : text(marked) {
    const std::size_t mark = text.find('^');
    if (mark == std::string::npos) return;
    text.erase(mark, 1);
    for (std::size_t k = 0; k < mark; ++k) {
      column = text[k] == '\n' ? 1 : column + 1;
      if (text[k] == '\n') ++line;
    }
  }

  std::string text;
  std::size_t line = 1;
  std::size_t column = 1;
};

/// Expects that read() throws an InputError that begins with this place, contains all words, and is one line that ends
/// with a remedy.
template <class Read>
void expect_input_error(Read&& read, const Place& place, const std::vector<std::string>& words) {
  try {
    read();
    ADD_FAILURE() << "accepted, although wrong at " << to_string(place);
  } catch (const InputError& error) {
    const std::string message = error.what();
    EXPECT_EQ(message.substr(0, message.find(": ")), to_string(place)) << message;
    for (const std::string& word : words) EXPECT_NE(message.find(word), std::string::npos) << word << " in " << message;
    EXPECT_EQ(message.find('\n'), std::string::npos) << message;
    EXPECT_NE(message.find("; "), std::string::npos) << message;
  }
}

/// The message with which read() refuses its input. Empty if it accepts the input.
template <class Read>
std::string refusal_of(Read&& read) {
  try {
    read();
    return {};
  } catch (const InputError& error) {
    return error.what();
  }
}

}  // namespace poesy::test
