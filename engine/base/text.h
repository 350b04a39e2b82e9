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

/// The text with a to z for A to Z, in any locale. Other characters stay as they are.
std::string lower_case(std::string_view text);

std::string_view trimmed(std::string_view text);  ///< The text without the blanks and tabs around it.

/// Bytes of the UTF-8 character at the start of this text, which is not empty; 0 where there is none: a cut or overlong
/// form, a surrogate, a number above U+10FFFF.
std::size_t character_length(std::string_view text);

std::uint32_t code_point(std::string_view character);  ///< Of a UTF-8 character, which is the whole text.

/// Whether a character acts on those beside it: a control character, the end of a line or paragraph (U+2028, U+2029),
/// or one that turns the direction of writing (Bidi_Control of Unicode 15), by which a name may look like another.
bool is_control(std::uint32_t code);

std::size_t text_width(std::string_view text);  ///< Characters of a UTF-8 text.

/// Lines of a text, broken at blanks, but not within numbers ("12 000", "5 %"). Each has at most `width` characters,
/// the first one `first` where that is given; a longer word has a line of its own.
std::vector<std::string> wrapped(std::string_view text, std::size_t width, std::optional<std::size_t> first = {});

/// A user's text as a message may show it: on one line, valid UTF-8, cut off after about `most` bytes. "?" stands for
/// a control character.
std::string printable(std::string_view text, std::size_t most = 60);

std::string printable_line(std::string_view text);  ///< The same, whole.

/// The sign with which a text begins a formula in a spreadsheet (= + - @, also of full width), behind blanks and what
/// has no width; empty: it begins none.
std::string_view formula_sign(std::string_view text);

/// A command line, word by word, as a shell takes it, on one line.
std::string shell_command(const std::vector<std::string>& words);

/// The known word that is close to this one, as after a slip of the pen; empty when none is.
std::string_view nearest(std::string_view word, std::span<const std::string_view> known);

/// "did you mean 'sigma'?" when a known word is close to this one, else the known words: "known: sigma, half_width".
std::string suggestion(std::string_view word, std::span<const std::string_view> known);

std::string either(std::span<const std::string_view> words);  ///< One of these words: "a, b or c".

/// The names of named things, for suggestion().
template <class Named>
std::vector<std::string_view> names(const std::vector<Named>& things) {
  std::vector<std::string_view> list;
  for (const Named& thing : things) list.push_back(thing.name);
  return list;
}

/// The first line in which two texts differ, of each as 'LINE'; "nothing more" where one has ended.
std::pair<std::string, std::string> first_difference(const std::string& one, const std::string& other);

}  // namespace poesy
