#pragma once

#include <array>
#include <cstddef>
#include <string>
#include <string_view>

/// The names of the errors of features: "rail_lean_x_1".
namespace poesy {

/// How an error displaces a feature. `too_long` is the only error of a distance; its name has no direction.
enum class FeatureDirection { too_long, x, y, z, lean_x, lean_y, lift_x, lift_y };

/// The directions in names of errors, in the order of FeatureDirection.
inline constexpr std::array<std::string_view, 8> kFeatureDirections{"",       "x",      "y",      "z",
                                                                    "lean_x", "lean_y", "lift_x", "lift_y"};

/// The name of a direction in names of errors.
inline std::string_view name(FeatureDirection direction) {
  return kFeatureDirections[static_cast<std::size_t>(direction)];
}

/// The name of an error of a feature. label: name of the feature on the drawing. limb: number of the limb, from 1.
inline std::string feature_error_name(std::string_view label, std::string_view direction, std::size_t limb) {
  return std::string(label) + (direction.empty() ? "" : "_") + std::string(direction) + "_" + std::to_string(limb);
}

}  // namespace poesy
