#include "engine/schema/keys.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cctype>
#include <limits>

#include "engine/base/contract.h"
#include "engine/base/text.h"

namespace poesy {
namespace {

/// The name of a list without an element's number: "groups" for "groups[0]".
std::string_view without_number(std::string_view name) { return name.substr(0, name.find('[')); }

bool stands_for_names(std::string_view name) {
  return name.size() > 1 && std::ranges::all_of(name, [](unsigned char letter) { return std::isupper(letter) != 0; });
}

bool is_name_of_model(const StudyKey& key) { return stands_for_names(key.name); }

/// Returns true if a path matches the path of a described table, name by name. A placeholder (a name in capitals)
/// matches every name.
bool fits(std::string_view described, std::string_view path) {
  const auto first_name = [](std::string_view rest) { return rest.substr(0, rest.find('.')); };
  const std::string_view pattern = first_name(described);
  const std::string_view name = first_name(path);
  const bool fits_name = pattern.ends_with("[]")
                             ? without_number(pattern) == without_number(name) && name.ends_with(']')
                             : pattern == without_number(name) || stands_for_names(pattern);
  if (!fits_name) return false;
  const bool ends = pattern.size() == described.size();
  if (ends || name.size() == path.size()) return ends && name.size() == path.size();
  return fits(described.substr(pattern.size() + 1), path.substr(name.size() + 1));
}

/// The condition under which a key applies: "required where select is interior, boundary or grid".
std::string condition(const StudyTable& table, const StudyKey& key) {
  if (key.only_for.empty()) return key.required ? "required" : "";
  return fmt::format("{}where {} is {}", key.required ? "required " : "", table.chooser, either(key.only_for));
}

std::string as_sentence(std::string_view clause) {
  std::string text(clause);
  text.front() = static_cast<char>(std::toupper(static_cast<unsigned char>(text.front())));
  return text + ".";
}

constexpr std::size_t kColumns = 120;

/// A paragraph as comment lines of TOML, indented by `indent` columns. Lines after the first are indented by two more
/// columns.
std::string paragraph(std::string_view text, std::size_t indent) {
  const std::size_t margin = indent + 2;
  std::string out;
  for (const std::string& line : wrapped(text, kColumns - margin - 2, kColumns - margin)) {
    out += "#" + std::string(out.empty() ? margin - 1 : margin + 1, ' ') + line + "\n";
  }
  return out;
}

/// The explanation of a key as comment lines, indented by 2 x depth columns. The words that the key accepts follow,
/// indented by two more columns.
std::string key_lines(const StudyTable& table, const StudyKey& key, std::size_t depth) {
  std::string text = paragraph(fmt::format("{}: {}", key.name, explanation(table, key)), 2 * depth);
  for (const StudyWord& word : key.words) {
    text += paragraph(fmt::format("{}: {}", word.name, word.meaning), 2 * depth + 2);
  }
  return text;
}

/// The value that a template shows for a key: the default if it is a value (in backquotes), otherwise the example.
std::string shown_value(const StudyKey& key) {
  if (!key.usual.starts_with('`')) return key.example;
  return key.usual.substr(1, key.usual.find('`', 1) - 1);
}

/// A text for a cell of a Markdown table, with vertical bars escaped.
std::string cell(std::string_view text) {
  std::string out;
  for (const char character : text) out += character == '|' ? std::string("\\|") : std::string(1, character);
  return out;
}

std::string heading(const StudyTable& table) {
  if (table.paths.front().empty()) return "The file itself";
  if (const std::string_view path = table.paths.front(); path.ends_with("[]")) {
    return fmt::format("`[[{}]]`", path.substr(0, path.size() - 2));
  }
  return fmt::format("`[{}]`", fmt::join(table.paths, "]`, `["));
}

/// Markdown text that lists the words of the chooser (StudyTable::chooser) with which the key applies.
std::string holds_text(const StudyKey& key) {
  if (key.only_for.empty()) return "all";
  return fmt::format("`{}`{}", fmt::join(key.only_for, "`, `"), key.may_stay ? "; else ignored" : "");
}

std::string row(const StudyKey& key, bool chosen) {
  return fmt::format("| `{}` | {}{}{} | {} |{} {} |\n", key.name, key.type, key.bounds.empty() ? "" : ", ", key.bounds,
                     (key.required ? "*required*" : "") + cell(key.usual),
                     chosen ? fmt::format(" {} |", holds_text(key)) : "", cell(key.meaning));
}

/// The words that each key accepts, as Markdown.
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

const StudyKey* StudyTable::find(std::string_view key, std::string_view word) const {
  const auto first = std::ranges::find(keys, key, &StudyKey::name);
  const auto chosen = std::find_if(first, keys.end(), [&](const StudyKey& candidate) {
    return candidate.name == key && holds_for(candidate.only_for, word);
  });
  if (chosen != keys.end()) return &*chosen;
  return first == keys.end() ? nullptr : &*first;
}

std::vector<std::string_view> StudyTable::names() const {
  std::vector<std::string_view> list;
  for (const StudyKey& key : keys) {
    if (std::ranges::find(list, key.name) == list.end()) list.push_back(key.name);
  }
  return list;
}

bool StudyTable::has_names_of_model() const { return std::ranges::any_of(keys, is_name_of_model); }

std::string StudyTable::owner_of(std::string_view word) const {
  return fmt::format("{} \"{}\"", owner.empty() ? fmt::format("{} =", chooser) : owner, word);
}

std::string StudyTable::remedy(std::string_view key) const {
  auto found = std::ranges::find(keys, key, &StudyKey::name);
  if (found == keys.end()) found = std::ranges::find_if(keys, is_name_of_model);
  POESY_EXPECTS(found != keys.end());
  std::string text = found->missing;
  if (const std::size_t at = text.find("{}"); at != std::string::npos) {
    text.replace(at, 2, std::string(key) + " = " + found->example);
  }
  return text;
}

const StudyTable* find_table(const StudyTables& tables, std::string_view path) {
  for (const StudyTable& table : tables) {
    if (std::ranges::any_of(table.paths, [&](std::string_view described) { return fits(described, path); })) {
      return &table;
    }
  }
  return nullptr;
}

bool holds_for(std::span<const std::string_view> only_for, std::string_view word) {
  return only_for.empty() || std::ranges::find(only_for, word) != only_for.end();
}

std::string explanation(const StudyTable& table, const StudyKey& key) {
  std::string text(key.meaning);
  if (!key.bounds.empty()) text += " " + as_sentence(key.bounds);
  std::string usual = key.usual;
  std::erase(usual, '`');
  if (key.required) return text + " " + as_sentence(condition(table, key) + usual);
  if (!(key.only_for.empty() || key.may_stay)) text += " " + as_sentence(condition(table, key));
  if (usual.empty()) return text;
  return text + " Default: " + usual + ".";
}

std::string tables_reference(const StudyTables& tables) {
  std::string text;
  for (const StudyTable& table : tables) text += section(table);
  return text;
}

std::string comment(std::string_view text) {
  std::string out = "# ";
  for (const char character : text) {
    out += character;
    if (character == '\n') out += "# ";
  }
  return out + "\n";
}

const StudyTable& TemplateLines::table(std::string_view path) const {
  const StudyTable* found = find_table(*tables_, path);
  POESY_EXPECTS(found != nullptr);
  return *found;
}

const StudyKey& TemplateLines::key(std::string_view path, std::string_view name) const {
  const StudyKey* found = table(path).find(name, word_);
  POESY_EXPECTS(found != nullptr);
  return *found;
}

std::string TemplateLines::explained(std::string_view path, std::string_view name, std::string_view line) const {
  const std::string one_line = fmt::format("{}  # {}\n", line, explanation(table(path), key(path, name)));
  if (key(path, name).words.empty() && one_line.size() <= kColumns + 1) return one_line;
  return fmt::format("{}{}\n", explanation_lines(path, name), line);
}

std::string TemplateLines::usual(std::string_view path, std::string_view name, std::string_view sign) const {
  return explained(path, name, fmt::format("{}{} = {}", sign, name, shown_value(key(path, name))));
}

std::string TemplateLines::explanation_lines(std::string_view path, std::string_view name) const {
  return key_lines(table(path), key(path, name), 0);
}

std::string TemplateLines::inline_table(std::string_view path) const {
  std::vector<std::string> shown;
  for (const StudyKey& key : table(path).keys) {
    if (const std::string value = shown_value(key); !value.empty())
      shown.push_back(fmt::format("{} = {}", key.name, value));
  }
  return fmt::format("{{ {} }}", fmt::join(shown, ", "));
}

std::string_view TemplateLines::example(std::string_view path, std::string_view name) const {
  return key(path, name).example;
}

std::string TemplateLines::keys_lines(std::string_view path, std::size_t depth) const {
  std::string text;
  for (const StudyKey& key : table(path).keys) text += key_lines(table(path), key, depth);
  return text;
}

std::string_view TemplateLines::meaning(std::string_view path) const { return table(path).meaning; }

std::string in_quotes(std::string_view text) {
  std::string out = "\"";
  for (const char character : text) {
    const auto code = static_cast<unsigned char>(character);
    if (code < 0x20 || code == 0x7F) {
      out += fmt::format("\\u{:04X}", code);
    } else {
      if (character == '"' || character == '\\') out += '\\';
      out += character;
    }
  }
  return out + '"';
}

std::string exact_value(double si, Dimension dimension) {
  return dimension == Dimension::number ? shortest(si) : in_quotes(to_text({si, dimension}));
}

std::string readable_value(double si, Dimension dimension) {
  const std::string exact = exact_value(si, dimension);
  if (dimension == Dimension::number) return exact;
  const std::string text = readable_text({si, dimension});
  const bool as_exact = parse_quantity(text).si == si;
  return as_exact && text.size() + 2 <= exact.size() + 1 ? in_quotes(text) : exact;
}

std::string list_text(std::span<const std::string> values) { return fmt::format("[{}]", fmt::join(values, ", ")); }

NumberBounds above_zero(std::string_view example) {
  return {0.0, std::numeric_limits<double>::infinity(), false, "greater than 0",
          fmt::format("it must be greater than zero, e.g. {}", example)};
}

NumberBounds above_one(std::string_view example) {
  return {1.0, std::numeric_limits<double>::infinity(), false, "greater than 1",
          fmt::format("it must be greater than 1, e.g. {}", example)};
}

NumberBounds between_0_and_1(std::string_view example) {
  return {0.0, 1.0, false, "between 0 and 1", fmt::format("it must lie between 0 and 1, e.g. {}", example), true};
}

double read_number(const StudyValue& value, const NumberBounds& bounds) {
  const double number = bounds.percent && value.is_text() ? value.percent() : value.number();
  const bool inside = bounds.ends_included ? bounds.least <= number && number <= bounds.most
                                           : bounds.least < number && number < bounds.most;
  if (!inside) value.fail("is " + shortest(number), bounds.remedy);
  return number;
}

std::string detail::without_plus(std::string text) {
  if (const std::size_t at = text.find("e+"); at != std::string::npos) {
    text.erase(at + 1, std::max(text.find_first_not_of("+0", at + 1), at + 2) - at - 1);
  }
  return text;
}

}  // namespace poesy
