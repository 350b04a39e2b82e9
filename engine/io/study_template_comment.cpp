#include "engine/io/study_template_comment.h"

#include <fmt/format.h>

#include "engine/base/contract.h"
#include "engine/base/text.h"
#include "engine/io/study_keys.h"

namespace poesy {
namespace {

constexpr std::size_t kColumns = 120;

/// One paragraph as comment lines; lines after the first are two columns further in than `indent`.
std::string paragraph(std::string_view text, std::size_t indent) {
  const std::size_t margin = indent + 2;
  std::string out;
  for (const std::string& line : wrapped(text, kColumns - margin - 2, kColumns - margin)) {
    out += "#" + std::string(out.empty() ? margin - 1 : margin + 1, ' ') + line + "\n";
  }
  return out;
}

const StudyTable& described(std::string_view path) {
  const StudyTable* table = find_study_table(path);
  POESY_EXPECTS(table != nullptr);
  return *table;
}

/// The key, and one step further in its words.
std::string key_lines(const StudyTable& table, const StudyKey& key, std::size_t depth) {
  std::string text = paragraph(fmt::format("{}: {}", key.name, explanation(table, key)), 2 * depth);
  for (const StudyWord& word : key.words) {
    text += paragraph(fmt::format("{}: {}", word.name, word.meaning), 2 * depth + 2);
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
  const std::string one_line = fmt::format("{}  # {}\n", line, explanation(described(table), found));
  if (found.words.empty() && one_line.size() <= kColumns + 1) return one_line;
  return fmt::format("{}{}\n", explanation_lines(table, key), line);
}

std::string explanation_lines(std::string_view table, std::string_view key) {
  return key_lines(described(table), study_key(table, key), 0);
}

std::string keys_lines(std::string_view table, std::size_t depth) {
  std::string text;
  for (const StudyKey& key : described(table).keys) text += key_lines(described(table), key, depth);
  return text;
}

std::string_view table_meaning(std::string_view table) { return described(table).meaning; }

}  // namespace poesy
