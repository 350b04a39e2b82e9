#include "engine/base/text.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cctype>
#include <cstdint>
#include <numeric>
#include <sstream>

namespace poesy {
namespace {

constexpr std::size_t kMostWords = 12;

/// A word that other programs use, and the word that poesy uses for the same thing.
struct Synonym {
  std::string_view word;
  std::string_view ours;
};

constexpr std::array<Synonym, 10> kSynonyms{{{"std", "sigma"},
                                             {"tolerance", "half_width"},
                                             {"stddev", "sigma"},
                                             {"std_dev", "sigma"},
                                             {"sd", "sigma"},
                                             {"gauss", "normal"},
                                             {"gaussian", "normal"},
                                             {"dx", "deviation_x"},
                                             {"dy", "deviation_y"},
                                             {"dz", "deviation_z"}}};

/// The smallest number of insertions, deletions and replacements of characters between two words (Levenshtein).
std::size_t edit_distance(std::string_view from, std::string_view to) {
  std::vector<std::size_t> row(to.size() + 1);
  std::iota(row.begin(), row.end(), std::size_t{0});
  for (std::size_t i = 1; i <= from.size(); ++i) {
    std::size_t diagonal = row[0];
    row[0] = i;
    for (std::size_t j = 1; j <= to.size(); ++j) {
      const std::size_t replaced = diagonal + (from[i - 1] == to[j - 1] ? 0 : 1);
      diagonal = row[j];
      row[j] = std::min({replaced, row[j] + 1, row[j - 1] + 1});
    }
  }
  return row[to.size()];
}

bool is_plain(const std::string& word) {
  constexpr std::string_view kPlain = "_-+./=:,@%";
  return !word.empty() && std::ranges::all_of(word, [&](char c) {
    return std::isalnum(static_cast<unsigned char>(c)) != 0 || kPlain.find(c) != std::string_view::npos;
  });
}

/// The word in single quotes, so that a shell reads it unchanged.
std::string quoted(const std::string& word) {
  std::string text = "'";
  for (const char c : word) text += c == '\'' ? std::string("'\\''") : std::string(1, c);
  return text + "'";
}

/// The word in the form $'...' of bash, ksh and zsh, with escapes for all bytes that are not printable ASCII.
std::string escaped_for_shell(const std::string& word) {
  constexpr std::string_view kDigits = "0123456789abcdef";
  std::string text = "$'";
  for (const char c : word) {
    const auto byte = static_cast<unsigned char>(c);
    if (byte < 0x20 || byte > 0x7E) {
      text.append("\\x").append({kDigits[byte >> 4U], kDigits[byte & 0xFU]});
    } else {
      if (c == '\'' || c == '\\') text += '\\';
      text += c;
    }
  }
  return text + "'";
}

/// Returns true if a blank between these two texts is inside a number, such as "12 000" or "5 %".
bool within_number(std::string_view before, std::string_view after) {
  const auto digit = [](char c) { return c >= '0' && c <= '9'; };
  return !before.empty() && !after.empty() && digit(before.back()) && (digit(after.front()) || after.front() == '%');
}

/// The text before the first blank at which a line may be broken.
std::string_view first_word(std::string_view text) {
  std::size_t end = text.find(' ');
  while (end < text.size() && within_number(text.substr(0, end), text.substr(end + 1))) end = text.find(' ', end + 1);
  return text.substr(0, end);
}

}  // namespace

std::string lower_case(std::string_view text) {
  std::string lower(text);
  std::ranges::transform(lower, lower.begin(), [](char c) { return c >= 'A' && c <= 'Z' ? char(c - 'A' + 'a') : c; });
  return lower;
}

std::string_view trimmed(std::string_view text) {
  const auto first = text.find_first_not_of(" \t");
  if (first == std::string_view::npos) return {};
  return text.substr(first, text.find_last_not_of(" \t") - first + 1);
}

std::size_t character_length(std::string_view text) {
  const auto byte = [&](std::size_t k) { return static_cast<unsigned char>(text[k]); };
  if (byte(0) < 0x80) return 1;
  const auto length = static_cast<std::size_t>(std::countl_one(byte(0)));
  if (length < 2 || length > 4 || length > text.size()) return 0;
  for (std::size_t k = 1; k < length; ++k) {
    if ((byte(k) & 0xC0U) != 0x80) return 0;
  }
  const std::uint32_t code = code_point(text.substr(0, length));
  // The smallest code point for each length in bytes, because only the shortest form is valid. Surrogates are invalid
  // (RFC 3629).
  constexpr std::array<std::uint32_t, 6> kFirst{0, 0, 0x80, 0x800, 0x10000, 0x110000};
  const bool surrogate = code >= 0xD800 && code < 0xE000;
  return code >= kFirst[length] && code < kFirst[length + 1] && !surrogate ? length : 0;
}

std::uint32_t code_point(std::string_view character) {
  const auto lead = static_cast<unsigned char>(character[0]);
  if (character.size() == 1) return lead;
  std::uint32_t code = lead & (0x7FU >> character.size());
  for (const char byte : character.substr(1)) code = code << 6U | (static_cast<unsigned char>(byte) & 0x3FU);
  return code;
}

bool is_control(std::uint32_t code) {
  const auto within = [&](std::uint32_t first, std::uint32_t last) { return code >= first && code <= last; };
  return code < 0x20 || within(0x7F, 0x9F) || code == 0x061C || within(0x200E, 0x200F) || within(0x2028, 0x202E) ||
         within(0x2066, 0x2069);
}

std::size_t text_width(std::string_view text) {
  const auto begins_character = [](char c) { return (c & 0xC0) != 0x80; };
  return static_cast<std::size_t>(std::ranges::count_if(text, begins_character));
}

std::vector<std::string> wrapped(std::string_view text, std::size_t width, std::optional<std::size_t> first) {
  std::vector<std::string> lines;
  while (!text.empty()) {
    const std::string_view word = first_word(text);
    text.remove_prefix(std::min(word.size() + 1, text.size()));
    const std::size_t room = lines.size() == 1 ? first.value_or(width) : width;
    if (!lines.empty() && text_width(lines.back()) + 1 + text_width(word) <= room) {
      lines.back().append(" ").append(word);
    } else {
      lines.emplace_back(word);
    }
  }
  return lines;
}

std::string printable(std::string_view text, std::size_t most) {
  std::string shown;
  while (!text.empty()) {
    if (shown.size() >= most) return shown + "...";
    const std::size_t length = character_length(text);
    const std::string_view character = text.substr(0, std::max(length, std::size_t{1}));
    shown += length == 0 || is_control(code_point(character)) ? "?" : character;
    text.remove_prefix(character.size());
  }
  return shown;
}

std::string printable_line(std::string_view text) { return printable(text, std::string_view::npos); }

std::string_view formula_sign(std::string_view text) {
  constexpr std::array<std::uint32_t, 8> kSigns{'=', '+', '-', '@', 0xFF1D, 0xFF0B, 0xFF0D, 0xFF20};
  constexpr std::array<std::uint32_t, 8> kUnseen{' ', 0xA0, 0x200B, 0x200C, 0x200D, 0x2060, 0x3000, 0xFEFF};
  while (!text.empty()) {
    const std::string_view character = text.substr(0, character_length(text));
    if (character.empty()) return {};
    const std::uint32_t code = code_point(character);
    if (std::ranges::find(kSigns, code) != kSigns.end()) return character;
    if (std::ranges::find(kUnseen, code) == kUnseen.end()) return {};
    text.remove_prefix(character.size());
  }
  return {};
}

std::string shell_command(const std::vector<std::string>& words) {
  std::string command;
  for (const std::string& word : words) {
    if (!command.empty()) command += ' ';
    command += is_plain(word) ? word : printable_line(word) == word ? quoted(word) : escaped_for_shell(word);
  }
  return command;
}

std::string_view nearest(std::string_view word, std::span<const std::string_view> known) {
  const auto synonym = std::ranges::find(kSynonyms, word, &Synonym::word);
  if (synonym != kSynonyms.end() && std::ranges::find(known, synonym->ours) != known.end()) return synonym->ours;
  const std::string lower = lower_case(word);
  const auto same = std::ranges::find_if(known, [&](std::string_view one) { return lower_case(one) == lower; });
  if (same != known.end()) return *same;
  const std::size_t allowed = std::max<std::size_t>(1, (word.size() + 2) / 3);
  std::string_view best;
  std::size_t best_distance = allowed + 1;
  for (const std::string_view candidate : known) {
    if (candidate.size() > word.size() + allowed || word.size() > candidate.size() + allowed) continue;
    const std::size_t distance = edit_distance(word, candidate);
    const bool nothing_in_common = distance == std::max(word.size(), candidate.size());
    if (distance >= best_distance || nothing_in_common) continue;
    best = candidate;
    best_distance = distance;
  }
  return best;
}

std::string suggestion(std::string_view word, std::span<const std::string_view> known) {
  if (const std::string_view best = nearest(word, known); !best.empty()) {
    return "did you mean '" + std::string(best) + "'?";
  }
  std::string list = "known: ";
  for (std::size_t k = 0; k < std::min(known.size(), kMostWords); ++k) {
    list += (k > 0 ? ", " : "") + std::string(known[k]);
  }
  return known.size() > kMostWords ? list + ", ... (" + std::to_string(known.size()) + " in all)" : list;
}

std::string either(std::span<const std::string_view> words) {
  std::string text;
  for (std::size_t k = 0; k < words.size(); ++k) {
    text += (k == 0 ? "" : k + 1 < words.size() ? ", " : " or ") + std::string(words[k]);
  }
  return text;
}

std::pair<std::string, std::string> first_difference(const std::string& one, const std::string& other) {
  std::istringstream lines(one);
  std::istringstream other_lines(other);
  std::string a;
  std::string b;
  do {
    if (!std::getline(lines, a)) a = "nothing more";
    if (!std::getline(other_lines, b)) b = "nothing more";
  } while (a == b && (lines || other_lines));
  const auto quote = [](const std::string& line) { return "'" + printable(line, 120) + "'"; };
  return {quote(a), quote(b)};
}

}  // namespace poesy
