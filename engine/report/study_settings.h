#pragma once

#include <string>
#include <string_view>
#include <vector>

/// What a result says of its study: the resolved text (study/study_file.h), read setting by setting.
namespace poesy {

/// A setting of a resolved study.
struct StudySetting {
  std::string section;  ///< "errors"; of repeated sections with their number, "analysis.cases 2"; empty at the top
  std::string key;      ///< "linear"
  std::string value;    ///< as it is written: "\"newton\"", "1000"
};

/// All that a resolved study sets, in its order.
std::vector<StudySetting> study_settings(std::string_view study_text);

/// The value of a key of a section, as it is written. Empty where the study does not set it.
std::string study_setting(std::string_view study_text, std::string_view section, std::string_view key);

/// A value as people read it: without quotes and braces, quantities in mm and deg.
std::string readable_setting(std::string_view value);

/// Both together.
std::string readable_setting(std::string_view study_text, std::string_view section, std::string_view key);

}  // namespace poesy
