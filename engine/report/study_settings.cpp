#include "engine/report/study_settings.h"

#include <map>

#include "engine/base/units.h"

namespace poesy {
namespace {

/// Takes the first line off a text.
std::string_view take_line(std::string_view& text) {
  const std::size_t end = text.find('\n');
  const std::string_view line = text.substr(0, end);
  text.remove_prefix(end == std::string_view::npos ? text.size() : end + 1);
  return line;
}

std::string readable_quoted(std::string_view quoted) {
  try {
    return readable_text(parse_quantity(quoted), 6);
  } catch (const QuantityError&) {
    return std::string(quoted);
  }
}

}  // namespace

std::vector<StudySetting> study_settings(std::string_view study_text) {
  std::vector<StudySetting> list;
  std::map<std::string, std::size_t> repeated;
  std::string section;
  while (!study_text.empty()) {
    const std::string_view line = take_line(study_text);
    const std::size_t equals = line.find(" = ");
    if (line.starts_with("[[") && line.ends_with("]]")) {
      const std::string name(line.substr(2, line.size() - 4));
      section = name + " " + std::to_string(++repeated[name]);
    } else if (line.starts_with('[') && line.ends_with(']')) {
      section = line.substr(1, line.size() - 2);
    } else if (equals != std::string_view::npos) {
      list.push_back({section, std::string(line.substr(0, equals)), std::string(line.substr(equals + 3))});
    }
  }
  return list;
}

std::string study_setting(std::string_view study_text, std::string_view section, std::string_view key) {
  for (const StudySetting& setting : study_settings(study_text)) {
    if (setting.section == section && setting.key == key) return setting.value;
  }
  return {};
}

std::string readable_setting(std::string_view value) {
  std::string text;
  while (!value.empty()) {
    const char first = value.front();
    const std::size_t end = first == '"' ? value.find('"', 1) : std::string_view::npos;
    if (end != std::string_view::npos) {
      text += readable_quoted(value.substr(1, end - 1));
      value.remove_prefix(end + 1);
      continue;
    }
    if (first != '{' && first != '}') text += first;
    value.remove_prefix(1);
  }
  const std::size_t begin = text.find_first_not_of(' ');
  return begin == std::string::npos ? std::string() : text.substr(begin, text.find_last_not_of(' ') - begin + 1);
}

std::string readable_setting(std::string_view study_text, std::string_view section, std::string_view key) {
  return readable_setting(study_setting(study_text, section, key));
}

}  // namespace poesy
