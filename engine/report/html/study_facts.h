#pragma once

#include <string>
#include <string_view>
#include <vector>

namespace poesy {

/// What a resolved study (io/study_text.h) sets under a key of a section, as it stands there: "\"newton\"", "1000".
/// Empty where it sets nothing.
std::string study_setting(std::string_view study_text, std::string_view section, std::string_view key);

/// A setting as people read it: without quotes and braces, quantities in mm and deg.
std::string readable_setting(std::string_view setting);

/// A setting of a resolved study.
struct StudySetting {
  std::string name;  ///< "errors.linear"; of repeated sections with their number, "analysis.cases 2.name"
  std::string text;  ///< readable
};

/// All that a resolved study sets, in its order, but for its format and title.
std::vector<StudySetting> study_settings(std::string_view study_text);

/// Both together.
std::string readable_setting(std::string_view study_text, std::string_view section, std::string_view key);

}  // namespace poesy
