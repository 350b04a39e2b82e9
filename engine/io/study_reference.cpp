#include <fmt/format.h>

#include "engine/base/units.h"
#include "engine/io/study_keys.h"

namespace poesy {
namespace {

/// Text inside a cell of a Markdown table, whose bars would end it.
std::string cell(std::string_view text) {
  std::string out;
  for (const char character : text) out += character == '|' ? std::string("\\|") : std::string(1, character);
  return out;
}

std::string code(std::string_view text) { return "`" + std::string(text) + "`"; }

/// "`a`, `b`".
std::string codes(const std::vector<std::string_view>& words) {
  std::string text;
  for (const std::string_view word : words) text += (text.empty() ? "" : ", ") + code(word);
  return text;
}

std::string units_of(Dimension dimension) {
  std::vector<std::string_view> list;
  for (const Unit& unit : units()) {
    if (unit.dimension == dimension) list.push_back(unit.name);
  }
  return codes(list);
}

std::string introduction() {
  return fmt::format(
      "# Study files\n\n"
      "Every key of a study file, as `poesy template --reference` prints it. Do not edit: it is made of the "
      "descriptions\n"
      "by which the program reads studies (`engine/io/study_keys_table.cpp`), and a test compares.\n\n"
      "A study is [TOML](https://toml.io). `poesy template MODEL KIND` writes a complete one, `poesy check "
      "STUDY.toml`\n"
      "prints it with every default filled in.\n\n"
      "- A key that is not listed is an error, and so is one that does not hold for the study's kind or choice of\n"
      "  poses, unless it says \"else ignored\".\n"
      "- A length, an angle or a time is a text of a number and a unit: `\"0.1 mm\"`. Lengths: {}. Angles: {}. Times: "
      "{}.\n"
      "  `µm` and `°` may be written for `um` and `deg`. A bare number is an error. A *quantity* has the dimension of "
      "what it is a value of.\n"
      "- Names in capitals stand for names of the mechanism's, which `poesy models MODEL` lists: PARAMETER, "
      "COORDINATE,\n"
      "  JOINT, FACTOR, SET.\n"
      "- A table `[poses]` with a key `workspace` of type table may be written as `workspace = {{ ... }}` there, as\n"
      "  `[poses.workspace]`, or with dots; a list of tables as `[[analysis.cases]]` for each of them.\n"
      "- *Required* means: wherever the key holds.\n",
      units_of(Dimension::length), units_of(Dimension::angle), units_of(Dimension::time));
}

std::string heading(const StudyTable& table) {
  if (table.paths.front().empty()) return "The file itself";
  std::string text;
  for (const std::string_view path : table.paths) {
    text += (text.empty() ? "" : ", ") + code("[" + std::string(path) + "]");
  }
  return text;
}

std::string default_text(const StudyKey& key) { return key.required ? "*required*" : std::string(key.usual); }

std::string type_text(const StudyKey& key) {
  return std::string(key.type) + (key.bounds.empty() ? "" : ", " + std::string(key.bounds));
}

std::string holds_text(const StudyKey& key) {
  if (key.only_for.empty()) return "all";
  return codes(key.only_for) + (key.may_stay ? "; else ignored" : "");
}

std::string row(const StudyKey& key, bool chosen) {
  const std::string holds = chosen ? fmt::format(" {} |", holds_text(key)) : "";
  return fmt::format("| `{}` | {} | {} |{} {} |\n", key.name, type_text(key), cell(default_text(key)), holds,
                     cell(key.meaning));
}

/// The words of each key that takes some.
std::string words_of(const StudyTable& table) {
  std::string text;
  for (const StudyKey& key : table.keys) {
    if (key.words.empty()) continue;
    text += fmt::format("\nWords of `{}`:\n\n", key.name);
    for (const StudyWord& word : key.words) text += fmt::format("- `{}`: {}\n", word.name, word.meaning);
  }
  return text;
}

std::string section(const StudyTable& table) {
  const bool chosen = !table.chooser.empty();
  const std::string column = chosen ? fmt::format(" `{}` |", table.chooser) : "";
  std::string text = fmt::format("\n## {}\n\n{}\n\n| key | type | default |{} meaning |\n|---|---|---|{}---|\n",
                                 heading(table), table.meaning, column, chosen ? "---|" : "");
  for (const StudyKey& key : table.keys) text += row(key, chosen);
  return text + words_of(table);
}

}  // namespace

std::string study_reference() {
  std::string text = introduction();
  for (const StudyTable& table : study_tables()) text += section(table);
  return text;
}

}  // namespace poesy
