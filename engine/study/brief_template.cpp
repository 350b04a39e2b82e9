#include "engine/study/brief_template.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>
#include <cctype>
#include <iterator>
#include <span>
#include <string>
#include <utility>
#include <vector>

namespace poesy {
namespace {

constexpr std::size_t kWidth = 120;

/// Keys that a short template shows even if they state their default.
constexpr std::array<std::string_view, 9> kOftenChanged{"samples", "select", "count",  "linear", "relative",
                                                        "angular", "draws",  "limits", "yield"};
/// Keys that a short template always leaves out.
constexpr std::array<std::string_view, 3> kRarelyChanged{"title", "fidelity", "tolerance"};

/// The first key of a template, and the comment after it. Because this key needs no explanation, the comment describes
/// the whole template.
constexpr std::string_view kFirstKey = "format";
constexpr std::string_view kAllKeys =
    "the keys that are usually changed; every key with its explanation: poesy template --full";

bool is_in(std::span<const std::string_view> names, std::string_view name) {
  return std::ranges::find(names, name) != names.end();
}

/// The path in a table's header: "analysis.parts" in "[[analysis.parts]]".
std::string_view path_of(std::string_view header) {
  const std::size_t first = header.find_first_not_of('[');
  return header.substr(first, header.find(']') - first);
}

/// The first clause of an explanation: "Number of poses" from "Number of poses. Of a grid: ...".
std::string_view first_clause(std::string_view meaning) {
  std::size_t end = meaning.size();
  for (const std::string_view mark : {". ", "; ", ": "}) end = std::min(end, meaning.find(mark));
  const std::string_view clause = meaning.substr(0, end);
  return clause.ends_with('.') ? clause.substr(0, clause.size() - 1) : clause;
}

/// The line without the comment after its value. The search for "  # " is safe, because no value in a template has it.
std::string_view without_comment(std::string_view line) {
  const std::string_view code = line.substr(0, line.find("  # "));
  return code.substr(0, code.find_last_not_of(' ') + 1);
}

/// A line with its explanation, or without it if both together are too long.
std::string explained(std::string_view code, std::string_view explanation) {
  std::string text = fmt::format("{}  # {}", code, explanation);
  return text.size() <= kWidth ? std::move(text) : std::string(code);
}

bool states_default(const StudyKey& key, std::string_view line) {
  const std::string_view value = line.substr(line.find(" = ") + 3);
  return key.usual == fmt::format("`{}`", value);
}

/// The short template's line for a line of the full template that sets a key of this table; empty if the short template
/// leaves the key out.
std::string key_line(const StudyTable* table, std::string_view kind, std::string_view line) {
  const std::string_view code = without_comment(line);
  const StudyKey* key = table == nullptr ? nullptr : table->find(code.substr(0, code.find(' ')), kind);
  if (key == nullptr) return std::string(code);
  if (is_in(kRarelyChanged, key->name)) return {};
  if (!key->required && !is_in(kOftenChanged, key->name) && states_default(*key, code)) return {};
  return explained(code, key->name == kFirstKey ? kAllKeys : first_clause(key->meaning));
}

/// A table of the short template: its header and its lines.
struct Block {
  std::string_view header;  ///< "[poses]", "[[analysis.parts]]"; empty for the keys before the first table
  std::vector<std::string> lines = {};

  bool is_in_list() const { return header.starts_with("[["); }
};

std::vector<Block> blocks_of(std::string_view full, const StudyTables& tables, std::string_view kind) {
  std::vector<Block> blocks{{}};
  const StudyTable* table = find_table(tables, "");
  while (!full.empty()) {
    const std::string_view line = full.substr(0, full.find('\n'));
    full.remove_prefix(std::min(full.size(), line.size() + 1));
    if (line.empty() || line.front() == '#') continue;
    if (line.front() == '[') {
      blocks.push_back({line.substr(0, line.rfind(']') + 1)});
      table = find_table(tables, path_of(line));
      continue;
    }
    const bool is_key = std::isalpha(static_cast<unsigned char>(line.front())) != 0;
    std::string shown = is_key ? key_line(table, kind, line) : std::string(line);
    if (!shown.empty()) blocks.back().lines.push_back(std::move(shown));
  }
  std::erase_if(blocks, [](const Block& block) { return block.lines.empty(); });
  return blocks;
}

/// The lines of a table as an inline table on one line: "{ KEY = VALUE, ... },".
std::string on_one_line(const Block& block) {
  std::string text;
  for (const std::string& line : block.lines) {
    text += (text.empty() ? "  { " : ", ") + std::string(without_comment(line));
  }
  return text + " },";
}

/// Writes consecutive tables of a list, such as [[analysis.parts]], as one array "parts = [...]" in [analysis]. The
/// array is added to the last block of `shown`.
void take_list(std::vector<Block>& shown, std::span<const Block> list, const StudyTables& tables,
               std::string_view kind) {
  const std::string_view path = path_of(list.front().header);
  const std::size_t dot = path.rfind('.');
  const std::string_view name = path.substr(dot + 1);
  std::vector<std::string>& lines = shown.back().lines;
  const StudyKey* key = find_table(tables, path.substr(0, dot))->find(name, kind);
  lines.push_back(explained(fmt::format("{} = [", name), key != nullptr ? first_clause(key->meaning) : name));
  std::ranges::transform(list, std::back_inserter(lines), on_one_line);
  lines.emplace_back("]");
}

/// The tables of a study, with each list of tables such as [[analysis.parts]] written as an array in the table before
/// it.
std::vector<Block> with_lists(std::span<const Block> blocks, const StudyTables& tables, std::string_view kind) {
  std::vector<Block> shown;
  while (!blocks.empty()) {
    const auto other = [&](const Block& block) { return block.header != blocks.front().header; };
    const auto count = static_cast<std::size_t>(std::ranges::find_if(blocks, other) - blocks.begin());
    if (blocks.front().is_in_list()) {
      take_list(shown, blocks.first(count), tables, kind);
    } else {
      shown.push_back(blocks.front());
    }
    blocks = blocks.subspan(count);
  }
  return shown;
}

}  // namespace

std::string brief_template(std::string_view full, const StudyTables& tables, std::string_view kind) {
  std::string text(full.substr(0, full.find('\n') + 1));
  for (const Block& block : with_lists(blocks_of(full, tables, kind), tables, kind)) {
    if (!block.header.empty()) text += fmt::format("{}\n", block.header);
    text += fmt::format("{}\n", fmt::join(block.lines, "\n"));
  }
  return text;
}

}  // namespace poesy
