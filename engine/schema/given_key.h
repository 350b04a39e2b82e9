#pragma once

#include <string>

namespace poesy {

/// A value that a user gives for a key of a study, instead of the value in the file.
struct GivenKey {
  std::string key;    ///< full name of the key: "mechanism.geometry.R"
  std::string value;  ///< value as TOML, or a text without quotes: "260 mm", "0.5", "true"

  bool operator==(const GivenKey&) const = default;  ///< Returns true if key and value are equal.
};

}  // namespace poesy
