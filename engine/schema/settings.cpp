#include "engine/schema/settings.h"

#include <algorithm>
#include <cstddef>
#include <string>

#include "engine/base/error.h"
#include "engine/base/units.h"
#include "engine/schema/keys.h"
#include "engine/schema/toml_text.h"

namespace poesy {
namespace {

/// The largest depth to which nested tables are shown. Studies have four levels; texts from damaged files may have
/// thousands.
constexpr int kDeepest = 16;

struct Entry {
  std::string_view key;
  const toml::node* value;
};

/// The keys and values of a table in the order of the file.
std::vector<Entry> entries_of(const toml::table& table) {
  std::vector<Entry> entries;
  for (const auto& [key, value] : table) entries.push_back({key.str(), &value});
  std::ranges::sort(entries, [](const Entry& a, const Entry& b) {
    const toml::source_position& first = a.value->source().begin;
    const toml::source_position& second = b.value->source().begin;
    return first.line != second.line ? first.line < second.line : first.column < second.column;
  });
  return entries;
}

/// A value as TOML on one line, with "..." in place of tables that are nested too deeply.
std::string value_text(const toml::node& value, int depth) {
  if (depth == kDeepest) return "...";
  std::string text;
  const auto add = [&](const std::string& part) { text += (text.empty() ? "" : ", ") + part; };
  if (const toml::table* table = value.as_table()) {
    for (const Entry& entry : entries_of(*table)) {
      add(std::string(entry.key) + " = " + value_text(*entry.value, depth + 1));
    }
    return "{ " + text + " }";
  }
  if (const toml::array* list = value.as_array()) {
    for (const toml::node& element : *list) add(value_text(element, depth + 1));
    return "[" + text + "]";
  }
  if (const auto* string = value.as_string()) return in_quotes(string->get());
  if (const auto* integer = value.as_integer()) return std::to_string(integer->get());
  if (const auto* number = value.as_floating_point()) return shortest(number->get());
  if (const auto* boolean = value.as_boolean()) return boolean->get() ? "true" : "false";
  return "...";  // a date, which studies do not have
}

/// Returns true if a value is a list of sections, [[name]].
bool is_sections(const toml::node& value) {
  const toml::array* list = value.as_array();
  return list != nullptr && list->is_array_of_tables() && !list->front().as_table()->is_inline();
}

/// Adds the settings of a section and of its inner sections to `settings`. path: full name of the section.
void add_settings(const toml::table& section, const std::string& path, int depth, std::vector<StudySetting>& settings) {
  if (depth == kDeepest) return;
  for (const Entry& entry : entries_of(section)) {
    const std::string name = (path.empty() ? "" : path + ".") + std::string(entry.key);
    const toml::table* table = entry.value->as_table();
    if (is_sections(*entry.value)) {
      std::size_t number = 0;
      for (const toml::node& one : *entry.value->as_array()) {
        add_settings(*one.as_table(), name + " " + std::to_string(++number), depth + 1, settings);
      }
    } else if (table != nullptr && !table->is_inline()) {
      add_settings(*table, name, depth + 1, settings);
    } else {
      settings.push_back({path, std::string(entry.key), value_text(*entry.value, 0)});
    }
  }
}

}  // namespace

std::vector<StudySetting> study_settings(std::string_view study_text) {
  std::vector<StudySetting> settings;
  try {
    add_settings(parse_toml(std::string(study_text), "", ""), "", 0, settings);
  } catch (const InputError&) {
    settings.clear();
  }
  return settings;
}

std::string study_setting(std::string_view study_text, std::string_view section, std::string_view key) {
  for (const StudySetting& setting : study_settings(study_text)) {
    if (setting.section == section && setting.key == key) return setting.value;
  }
  return {};
}

}  // namespace poesy
