#include "engine/study/brief_template.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cctype>
#include <span>
#include <utility>

namespace poesy {
namespace {

constexpr std::size_t kWidth = 120;

/// Keys that are shown although they state their default.
constexpr std::array<std::string_view, 9> kOftenChanged{"samples", "select", "count",  "linear", "relative",
                                                        "angular", "draws",  "limits", "yield"};
/// Keys that are left out although their default is not a value.
constexpr std::array<std::string_view, 3> kRarelyChanged{"title", "fidelity", "tolerance"};

constexpr std::string_view kHead = "# What is usually changed; every key with its explanation: poesy template --full\n";

bool is_in(std::span<const std::string_view> names, std::string_view name) {
  return std::ranges::find(names, name) != names.end();
}

/// The path of a table's header: "analysis.parts" of "[[analysis.parts]]".
std::string_view path_of(std::string_view header) {
  const std::size_t first = header.find_first_not_of('[');
  return header.substr(first, header.find(']') - first);
}

/// "Number of poses" of "Number of poses. Of a grid: ...".
std::string_view first_clause(std::string_view meaning) {
  std::size_t end = meaning.size();
  for (const std::string_view mark : {". ", "; ", ": "}) end = std::min(end, meaning.find(mark));
  const std::string_view clause = meaning.substr(0, end);
  return clause.ends_with('.') ? clause.substr(0, clause.size() - 1) : clause;
}

/// The line without a comment behind its value. In templates no text holds " # ".
std::string_view without_comment(std::string_view line) {
  const std::string_view code = line.substr(0, line.find("  # "));
  return code.substr(0, code.find_last_not_of(' ') + 1);
}

bool states_default(const StudyKey& key, std::string_view line) {
  const std::string_view value = line.substr(line.find(" = ") + 3);
  return key.usual == fmt::format("`{}`", value);
}

/// A line with a key of this table; empty if it is left out.
std::string key_line(const StudyTable* table, std::string_view kind, std::string_view line) {
  const std::string_view code = without_comment(line);
  const StudyKey* key = table == nullptr ? nullptr : table->find(code.substr(0, code.find(' ')), kind);
  if (key == nullptr) return std::string(code) + "\n";
  if (is_in(kRarelyChanged, key->name)) return {};
  if (!key->required && !is_in(kOftenChanged, key->name) && states_default(*key, code)) return {};
  const std::string text = fmt::format("{}  # {}", code, first_clause(key->meaning));
  return (text.size() <= kWidth ? text : std::string(code)) + "\n";
}

}  // namespace

std::string brief_template(std::string_view full, const StudyTables& tables, std::string_view kind) {
  std::string text(full.substr(0, full.find('\n') + 1));
  text += kHead;
  std::string header;
  const StudyTable* table = find_table(tables, "");
  while (!full.empty()) {
    const std::string_view line = full.substr(0, full.find('\n'));
    full.remove_prefix(std::min(full.size(), line.size() + 1));
    if (line.empty() || line.front() == '#') continue;
    if (line.front() == '[') {
      header = fmt::format("\n{}\n", line);
      table = find_table(tables, path_of(line));
      continue;
    }
    const bool is_key = std::isalpha(static_cast<unsigned char>(line.front())) != 0;
    const std::string shown = is_key ? key_line(table, kind, line) : std::string(line) + "\n";
    if (!shown.empty()) text += std::exchange(header, {}) + shown;
  }
  return text;
}

}  // namespace poesy
