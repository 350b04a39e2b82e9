#include "engine/schema/toml_text.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cctype>
#include <compare>
#include <cstddef>
#include <tuple>
#include <vector>

#include "engine/base/error.h"
#include "engine/base/text.h"
#include "engine/schema/open_quote.h"

namespace poesy {
namespace {

/// The longest line of a file in bytes. It limits how deeply dotted keys can nest tables, because the TOML library
/// frees nested tables by recursion.
constexpr std::size_t kLongestLine = 16384;

/// The lines of a text, as views of it.
std::vector<std::string_view> lines_of(std::string_view text, const std::string& path) {
  std::vector<std::string_view> lines;
  for (std::size_t begin = 0; begin < text.size();) {
    const std::size_t end = std::min(text.find('\n', begin), text.size());
    lines.push_back(text.substr(begin, end - begin));
    if (lines.back().size() > kLongestLine) {
      throw InputError({path, lines.size(), 1}, "the line is longer than " + std::to_string(kLongestLine) + " bytes",
                       "break it into several lines");
    }
    begin = end + 1;
  }
  return lines;
}

/// Throws InputError if a quote that is not closed explains why the text is not TOML. noticed: the place where the TOML
/// library noticed the mistake, which is often the end of the line or of the text.
void refuse_open_quote(const std::string& text, const std::string& path, const toml::source_position& noticed) {
  const auto open = open_quote(text);
  if (!open) return;
  const std::string mark(open->quote);
  if (std::tie(open->line, open->column) < std::tuple<std::size_t, std::size_t>(noticed.line, noticed.column)) {
    throw InputError({path, open->line, open->column},
                     "the text that begins here with " + mark + " is not closed" +
                         (open->is_of_one_line() ? " on its line" : " up to the end of the file"),
                     "write " + mark + " at its end");
  }
  if (open->line != noticed.line) return;
  throw InputError({path, noticed.line, noticed.column},
                   "this is not TOML: the line has a quote too many, or one is missing before this place",
                   "close each text with the quote that opens it");
}

/// The part of the file's line from this place on; empty if the file has no such place. The column is counted in
/// characters.
std::string_view rest_of_line(const std::vector<std::string_view>& lines, const toml::source_position& from) {
  if (from.line == 0 || from.line > lines.size()) return {};
  std::string_view rest = lines[from.line - 1];
  for (std::size_t column = 1; column < from.column && !rest.empty(); ++column) {
    rest.remove_prefix(std::max<std::size_t>(character_length(rest), 1));
  }
  return rest;
}

/// The value at this place of a line if it is a word without quotes, as in `select = boundary` or `[gap, x]`; otherwise
/// empty. rest: the part of the line from a place inside the word on.
std::string_view bare_word(std::string_view line, std::string_view rest) {
  const auto is_of_word = [](char c) {
    return std::isalnum(static_cast<unsigned char>(c)) != 0 || c == '_' || c == '-';
  };
  std::size_t begin = line.size() - rest.size();
  std::size_t end = begin;
  while (begin > 0 && is_of_word(line[begin - 1])) --begin;
  while (end < line.size() && is_of_word(line[end])) ++end;
  const std::string_view word = line.substr(begin, end - begin);
  if (word.empty() || std::isalpha(static_cast<unsigned char>(word.front())) == 0) return {};
  const std::string_view before = trimmed(line.substr(0, begin));
  const std::string_view after = trimmed(line.substr(end));
  constexpr std::string_view kBefore = "=[,";
  constexpr std::string_view kAfter = ",]}#\r";
  const bool begins = !before.empty() && kBefore.find(before.back()) != std::string_view::npos;
  const bool ends = after.empty() || kAfter.find(after.front()) != std::string_view::npos;
  return begins && ends ? word : std::string_view();
}

/// Returns true for the words that are values of TOML without quotes.
bool is_value(std::string_view word) {
  constexpr std::array<std::string_view, 4> kValues{"true", "false", "inf", "nan"};
  return std::ranges::find(kValues, word) != kValues.end();
}

/// Throws InputError if the TOML library noticed a mistake at a typographic quote, or in a text without quotes.
void refuse_missing_quotes(const std::vector<std::string_view>& lines, const std::string& path,
                           const toml::source_position& noticed) {
  constexpr std::array<std::string_view, 7> kTypographic{"\u201c", "\u201d", "\u201e", "\u2018",
                                                         "\u2019", "\u00ab", "\u00bb"};
  const std::string_view rest = rest_of_line(lines, noticed);
  if (rest.empty()) return;
  const Place place{path, noticed.line, noticed.column};
  const auto begins = [&](std::string_view mark) { return rest.starts_with(mark); };
  if (const auto mark = std::ranges::find_if(kTypographic, begins); mark != kTypographic.end()) {
    throw InputError(place, fmt::format("this is not TOML: {} is a typographic quote", *mark),
                     "write the plain quote \" before and after a text");
  }
  const std::string_view word = bare_word(lines[noticed.line - 1], rest);
  if (word.empty() || is_value(word)) return;
  const std::string lower = lower_case(word);
  const bool is_boolean = lower == "true" || lower == "false";
  throw InputError(place, fmt::format("this is not TOML: {} is a text without quotes", printable(word)),
                   is_boolean ? "write " + lower : fmt::format("write \"{}\"", printable(word)));
}

toml::table parsed(const std::string& text, const std::vector<std::string_view>& lines, const std::string& path,
                   std::string_view remedy) {
  try {
    return toml::parse(text);
  } catch (const toml::parse_error& error) {
    refuse_missing_quotes(lines, path, error.source().begin);
    refuse_open_quote(text, path, error.source().begin);
    std::string_view reason = error.description();
    if (reason.find("utf-8") != std::string_view::npos || text.starts_with("\xFF\xFE")) {
      throw InputError({path, error.source().begin.line, error.source().begin.column},
                       "this is not TOML, because the text is not in UTF-8", "save the file in UTF-8");
    }
    constexpr std::string_view kPrefix = "Error while ";
    if (reason.starts_with(kPrefix)) reason.remove_prefix(kPrefix.size());
    throw InputError({path, error.source().begin.line, error.source().begin.column},
                     "this is not TOML: " + printable(reason, 120), remedy);
  }
}

/// A number as the file writes it; empty if the number is not found. lines: lines of the file. begin: place of the
/// number, with the column counted in characters.
std::string_view written_number(const std::vector<std::string_view>& lines, const toml::source_position& begin) {
  const std::string_view rest = rest_of_line(lines, begin);
  return rest.substr(0, rest.find_first_not_of("0123456789+-._eE"));
}

/// Returns true if a number has a nonzero digit before its exponent.
bool has_digits(std::string_view number) {
  return number.substr(0, number.find_first_of("eE")).find_first_of("123456789") != std::string_view::npos;
}

/// Throws InputError for a nonzero number that is so small that the TOML library reads it as 0.
void check_zero(const toml::node& node, std::string_view key, const std::vector<std::string_view>& lines,
                const std::string& path) {
  const toml::source_position& begin = node.source().begin;
  const std::string_view written = written_number(lines, begin);
  if (!has_digits(written)) return;
  throw InputError({path, begin.line, begin.column},
                   printable(key) + " is " + printable(written) + ", which is too small to be told from 0",
                   "write 0, or a number from 1e-307 on");
}

/// A TOML value with its key. Elements of a list have the key of the list.
struct KeyedNode {
  const toml::node* node;
  std::string_view key;
};

/// Checks all numbers of a file with check_zero(), without recursion, because tables may be nested deeply.
void check_numbers(const toml::table& table, const std::vector<std::string_view>& lines, const std::string& path) {
  std::vector<KeyedNode> open{{&table, ""}};
  while (!open.empty()) {
    const KeyedNode at = open.back();
    open.pop_back();
    if (const toml::table* inner = at.node->as_table()) {
      for (const auto& [key, value] : *inner) open.push_back({&value, key.str()});
    } else if (const toml::array* list = at.node->as_array()) {
      for (const toml::node& element : *list) open.push_back({&element, at.key});
    } else if (at.node->is_floating_point() && at.node->as_floating_point()->get() == 0.0) {
      check_zero(*at.node, at.key, lines, path);
    }
  }
}

}  // namespace

toml::table parse_toml(const std::string& text, const std::string& path, std::string_view remedy) {
  const std::vector<std::string_view> lines = lines_of(text, path);
  toml::table table = parsed(text, lines, path, remedy);
  check_numbers(table, lines, path);
  return table;
}

}  // namespace poesy
