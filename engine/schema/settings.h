#pragma once

#include <string>
#include <string_view>
#include <vector>

namespace poesy {

/// One key of a resolved study (with every default filled in) and its value, for display.
struct StudySetting {
  /// Section of the key: "errors". A section of a list ends with its number, from 1: "analysis.cases 2". Empty for keys
  /// before the first section.
  std::string section;
  std::string key;    ///< name of the key: "linear"
  std::string value;  ///< TOML on one line: "\"newton\"", "1000", "[\"1 m\", \"2 m\"]"
};

/// All settings of a resolved study, in the order of its text. Empty if the text is not TOML, as in a damaged result.
std::vector<StudySetting> study_settings(std::string_view study_text);

/// The value of a key of a section, as TOML. Empty if the study does not set the key.
std::string study_setting(std::string_view study_text, std::string_view section, std::string_view key);

}  // namespace poesy
