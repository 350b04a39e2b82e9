#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace poesy {

/// The text with A to Z replaced by a to z, in any locale. Other characters stay unchanged.
std::string lower_case(std::string_view text);

std::string_view trimmed(std::string_view text);  ///< The text without leading and trailing blanks and tabs.

/// The number of bytes of the UTF-8 character at the start of a text that is not empty; 0 for an invalid character: a
/// truncated or overlong form, a surrogate, a number above U+10FFFF.
std::size_t character_length(std::string_view text);

std::uint32_t code_point(std::string_view character);  ///< The code point of a text that is one UTF-8 character.

/// Returns true if a character affects its neighbours: a control character, the end of a line or paragraph (U+2028,
/// U+2029), or a character that changes the direction of writing (Bidi_Control of Unicode 15). The last kind of
/// character could make one name look like another.
bool is_control(std::uint32_t code);

std::size_t text_width(std::string_view text);  ///< The number of characters of a UTF-8 text.

/// Breaks a text into lines at blanks, but not within numbers such as "12 000" or "5 %". A line has at most `width`
/// characters; the first line has at most `first`, if that is given. A longer word has its own line.
std::vector<std::string> wrapped(std::string_view text, std::size_t width, std::optional<std::size_t> first = {});

/// A user's text for a message: on one line, valid UTF-8, cut off after about `most` bytes, with "?" instead of control
/// characters.
std::string printable(std::string_view text, std::size_t most = 60);

std::string printable_line(std::string_view text);  ///< A user's text for a message, as printable(), but not cut off.

/// The sign that makes a spreadsheet read a text as a formula (= + - @, also of full width). Blanks and characters of
/// zero width before it are skipped. Empty if the text does not begin with a sign of a formula.
std::string_view formula_sign(std::string_view text);

/// A command line of these words, quoted for a shell where necessary, on one line.
std::string shell_command(const std::vector<std::string>& words);

/// The known word that the user probably meant: one that differs by a few typing errors, or poesy's word for a word of
/// other programs ("sigma" for "std"). Empty if no known word is similar enough.
std::string_view nearest(std::string_view word, std::span<const std::string_view> known);

/// A hint for an unknown word: "did you mean 'sigma'?" if a known word is similar, otherwise the known words (of many
/// words, only the first): "known: sigma, half_width".
std::string suggestion(std::string_view word, std::span<const std::string_view> known);

/// The words as a list of alternatives, such as "a, b or c".
std::string either(std::span<const std::string_view> words);

/// The names of things, in the form that suggestion() takes.
template <class Named>
std::vector<std::string_view> names(const std::vector<Named>& things) {
  std::vector<std::string_view> list;
  for (const Named& thing : things) list.push_back(thing.name);
  return list;
}

/// The first line in which two texts differ: that line of each text, in quotes, or 'nothing more' if the text has ended
/// before.
std::pair<std::string, std::string> first_difference(const std::string& one, const std::string& other);

}  // namespace poesy
