#pragma once

#include <string>
#include <string_view>
#include <vector>

namespace poesy {

/// A setting of a resolved study.
struct StudySetting {
  std::string section;  ///< "errors"; of repeated sections with their number, "analysis.cases 2"; empty at the top
  std::string key;      ///< "linear"
  std::string value;    ///< in TOML, on one line: "\"newton\"", "1000", "[\"1 m\", \"2 m\"]"
};

/// All that a resolved study sets, in its order. Empty for text that is not TOML, as a damaged result may have.
std::vector<StudySetting> study_settings(std::string_view study_text);

/// The value of a key of a section, in TOML. Empty where the study does not set it.
std::string study_setting(std::string_view study_text, std::string_view section, std::string_view key);

}  // namespace poesy
