#pragma once

#include <numbers>
#include <ostream>
#include <random>
#include <string>
#include <vector>

#include "models/lie/se3.h"

namespace poesy::lie {

/// A rotation angle (rad) for which all properties are tested.
struct Regime {
  std::string name;
  double angle;
};

inline void PrintTo(const Regime& regime, std::ostream* out) { *out << regime.name; }

inline std::vector<Regime> regimes() {
  const double pi = std::numbers::pi;
  return {{"identity", 0.0},        {"tiny", 1e-8},         {"small", 1e-3},         {"below_series", 0.4999},
          {"above_series", 0.5001}, {"ordinary", 1.3},      {"right_angle", pi / 2}, {"switch_of_log", 2 * pi / 3},
          {"obtuse", 2.9},          {"near_pi", pi - 1e-4}, {"nearer_pi", pi - 1e-8}};
}

inline Vector3<double> random_axis(std::mt19937_64& engine) {
  std::normal_distribution<double> normal;
  // Drawn one after the other, because the compiler chooses the evaluation order of arguments.
  const double z = normal(engine), y = normal(engine), x = normal(engine);
  return Vector3<double>(x, y, z).normalized();
}

/// A screw of this rotation angle about a random axis, with a translation part of order one.
inline Screw<double> random_screw(double angle, std::mt19937_64& engine) {
  Screw<double> screw;
  screw << angle * random_axis(engine), random_axis(engine);
  return screw;
}

}  // namespace poesy::lie
