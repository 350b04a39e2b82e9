#include "engine/io/study_template_comment.h"

#include <fmt/format.h>

#include <algorithm>

#include "engine/base/contract.h"
#include "engine/io/study_keys.h"

namespace poesy {
namespace {

constexpr std::size_t kColumns = 120;

/// One paragraph as comment lines, broken between words; lines after the first stand further in than `indent`.
std::string wrapped(std::string_view text, std::size_t indent) {
  std::string out;
  std::string line = "#" + std::string(indent + 1, ' ');
  const std::string next = line + "  ";
  bool fresh = true;
  while (!text.empty()) {
    const std::size_t end = std::min(text.find(' '), text.size());
    if (!fresh && line.size() + 1 + end > kColumns) {
      out += line + "\n";
      line = next;
      fresh = true;
    }
    line += (fresh ? "" : " ") + std::string(text.substr(0, end));
    fresh = false;
    text.remove_prefix(std::min(end + 1, text.size()));
  }
  return out + line + "\n";
}

/// The key, and one step further in its words.
std::string key_lines(const StudyKey& key, std::size_t depth) {
  std::string text = wrapped(fmt::format("{}: {}", key.name, explanation(key)), 2 * depth);
  for (const StudyWord& word : key.words) {
    text += wrapped(fmt::format("{}: {}", word.name, word.meaning), 2 * depth + 2);
  }
  return text;
}

}  // namespace

std::string comment(std::string_view text) {
  std::string out = "# ";
  for (const char character : text) {
    out += character;
    if (character == '\n') out += "# ";
  }
  return out + "\n";
}

std::string explained(std::string_view table, std::string_view key, std::string_view line) {
  const StudyKey& found = study_key(table, key);
  const std::string one_line = fmt::format("{}  # {}\n", line, explanation(found));
  if (found.words.empty() && one_line.size() <= kColumns + 1) return one_line;
  return fmt::format("{}{}\n", key_lines(found, 0), line);
}

std::string explanation_lines(std::string_view table, std::string_view key) {
  return key_lines(study_key(table, key), 0);
}

std::string keys_lines(std::string_view table, std::size_t depth) {
  const StudyTable* found = find_study_table(table);
  POESY_EXPECTS(found != nullptr);
  std::string text;
  for (const StudyKey& key : found->keys) text += key_lines(key, depth);
  return text;
}

std::string_view table_meaning(std::string_view table) {
  const StudyTable* found = find_study_table(table);
  POESY_EXPECTS(found != nullptr);
  return found->meaning;
}

}  // namespace poesy
