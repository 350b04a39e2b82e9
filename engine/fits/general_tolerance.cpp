#include "engine/fits/general_tolerance.h"

#include <array>
#include <cstddef>
#include <span>

namespace poesy {
namespace {

/// Tolerances of all classes (mm) for lengths up to and including `up_to` (mm); 0 if the class has no value.
template <std::size_t kClasses>
struct LengthStep {
  double up_to;
  std::array<double, kClasses> tolerance;
};

constexpr double kSmallest = 0.5;  // mm: the shortest length of ISO 2768-1

constexpr std::array<LengthStep<4>, 8> kLengths{{{3, {0.05, 0.1, 0.2, 0}},
                                                 {6, {0.05, 0.1, 0.3, 0.5}},
                                                 {30, {0.1, 0.2, 0.5, 1}},
                                                 {120, {0.15, 0.3, 0.8, 1.5}},
                                                 {400, {0.2, 0.5, 1.2, 2.5}},
                                                 {1000, {0.3, 0.8, 2, 4}},
                                                 {2000, {0.5, 1.2, 3, 6}},
                                                 {4000, {0, 2, 4, 8}}}};

constexpr std::array<LengthStep<3>, 6> kFlatness{{{10, {0.02, 0.05, 0.1}},
                                                  {30, {0.05, 0.1, 0.2}},
                                                  {100, {0.1, 0.2, 0.4}},
                                                  {300, {0.2, 0.4, 0.8}},
                                                  {1000, {0.3, 0.6, 1.2}},
                                                  {3000, {0.4, 0.8, 1.6}}}};

constexpr std::array<LengthStep<3>, 4> kPerpendicularity{
    {{100, {0.2, 0.4, 0.6}}, {300, {0.3, 0.6, 1}}, {1000, {0.4, 0.8, 1.5}}, {3000, {0.5, 1, 2}}}};

constexpr std::array<LengthStep<3>, 4> kSymmetry{
    {{100, {0.5, 0.6, 0.6}}, {300, {0.5, 0.6, 1}}, {1000, {0.5, 0.8, 1.5}}, {3000, {0.5, 1, 2}}}};

constexpr std::array<LengthStep<3>, 1> kRunout{{{3000, {0.1, 0.2, 0.5}}}};

/// The tolerance (m) in a table for a length (m) and a class; none if the table has no such entry.
template <std::size_t kClasses>
std::optional<double> value(std::span<const LengthStep<kClasses>> table, double length, std::size_t of) {
  const double size = length * 1e3 * (1.0 - 1e-12);  // a size converted to m may be above a step by rounding
  if (!(size > 0.0)) return std::nullopt;
  for (const LengthStep<kClasses>& step : table) {
    if (size > step.up_to) continue;
    return step.tolerance[of] > 0.0 ? std::optional(step.tolerance[of] / 1e3) : std::nullopt;
  }
  return std::nullopt;
}

std::span<const LengthStep<3>> table_of(GeneralZone zone) {
  switch (zone) {
    case GeneralZone::flatness:
      return kFlatness;
    case GeneralZone::perpendicularity:
      return kPerpendicularity;
    case GeneralZone::symmetry:
      return kSymmetry;
    case GeneralZone::runout:
      break;
  }
  return kRunout;
}

}  // namespace

std::optional<double> general_length_tolerance(double nominal_size, GeneralLengthClass of) {
  if (nominal_size * 1e3 * (1.0 + 1e-12) < kSmallest) return std::nullopt;
  return value(std::span<const LengthStep<4>>(kLengths), nominal_size, static_cast<std::size_t>(of));
}

std::optional<double> general_zone(GeneralZone zone, double length, GeneralZoneClass of) {
  return value(table_of(zone), length, static_cast<std::size_t>(of));
}

}  // namespace poesy
