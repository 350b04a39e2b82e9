#include "engine/drawing/share_inside.h"

#include <gtest/gtest.h>

#include <cmath>
#include <fstream>
#include <nlohmann/json.hpp>
#include <random>
#include <string>

#include "engine/drawing/zone_scatter.h"

// Compares share_inside() with the numbers of another program (tests/data/drawing.json) and with random draws.
namespace poesy::drawing {
namespace {

using nlohmann::json;

Feature feature_of(FeatureKind kind, double location, double orientation) {
  Feature feature{.name = "f_1", .label = "f", .limb = 1, .frame = 0, .kind = kind};
  if (location > 0.0) feature.location = Zone{"position", location, {}};
  if (orientation > 0.0) feature.orientation = Zone{"parallelism", orientation, {}};
  return feature;
}

TEST(ShareInside, IsThatOfTheOracle) {
  const json all = json::parse(std::ifstream(POESY_TEST_DATA "/drawing.json"));
  int found = 0;
  for (const json& one : all["known"]) {
    if (!one["name"].get<std::string>().starts_with("shares inside")) continue;
    ++found;
    const double k = one["k"];
    const auto location = [&](FeatureKind kind, double t_o = 0.0) {
      return share_inside(feature_of(kind, 1.0, t_o), ZoneClass::location, k);
    };
    EXPECT_NEAR(location(FeatureKind::distance), one["interval"].get<double>(), 1e-13);
    EXPECT_NEAR(location(FeatureKind::point), one["ball"].get<double>(), 1e-13);
    EXPECT_NEAR(location(FeatureKind::axis), one["axis_both_ends"].get<double>(), 1e-11);
    EXPECT_NEAR(location(FeatureKind::axis, 0.4), one["axis_both_ends_orientation_04"].get<double>(), 1e-9);
    EXPECT_NEAR(location(FeatureKind::rectangle), one["plane_four_corners"].get<double>(), 1e-9);
    const Feature turned = feature_of(FeatureKind::axis, 0.0, 1.0);
    EXPECT_NEAR(share_inside(turned, ZoneClass::orientation, k), one["disc"].get<double>(), 1e-13);
  }
  EXPECT_EQ(found, 2);
}

/// The share of random features that are inside the zone, by the definition of the zone.
double drawn(const Feature& feature, ZoneClass of, double sigmas) {
  constexpr int kDraws = 400000;
  std::mt19937_64 bits(5);
  std::normal_distribution<double> normal;
  const FeatureSigmas sigma = feature_sigmas(feature, sigmas);
  const double zone = of == ZoneClass::orientation ? feature.orientation->size : feature.location->size;
  const bool two = !feature.one_direction;
  int inside = 0;
  for (int n = 0; n < kDraws; ++n) {
    const double x = sigma.middle.value_or(0.0) * normal(bits);
    const double y = two ? sigma.middle.value_or(0.0) * normal(bits) : 0.0;
    const double lean_x = sigma.tilt.value_or(0.0) * normal(bits);
    const double lean_y = two ? sigma.tilt.value_or(0.0) * normal(bits) : 0.0;
    const double lift =
        feature.kind == FeatureKind::round ? std::hypot(lean_x, lean_y) : std::abs(lean_x) + std::abs(lean_y);
    bool is_inside = false;
    if (feature.kind == FeatureKind::axis) {
      is_inside = of == ZoneClass::orientation ? std::hypot(lean_x, lean_y) <= zone
                                               : std::hypot(x - 0.5 * lean_x, y - 0.5 * lean_y) <= 0.5 * zone &&
                                                     std::hypot(x + 0.5 * lean_x, y + 0.5 * lean_y) <= 0.5 * zone;
    } else {
      is_inside = of == ZoneClass::orientation ? lift <= 0.5 * zone : std::abs(x) + lift <= 0.5 * zone;
    }
    inside += is_inside ? 1 : 0;
  }
  return static_cast<double>(inside) / kDraws;
}

TEST(ShareInside, IsThatOfDrawsByTheZonesDefinition) {
  for (const FeatureKind kind : {FeatureKind::axis, FeatureKind::rectangle, FeatureKind::round}) {
    for (const double orientation : {0.0, 0.2, 0.5, 0.9}) {
      for (const bool one_direction : {false, true}) {
        if (one_direction && kind != FeatureKind::axis) continue;
        Feature feature = feature_of(kind, 1.0, orientation);
        feature.one_direction = one_direction;
        for (const ZoneClass of : {ZoneClass::location, ZoneClass::orientation}) {
          // There is no zone of orientation (0.0), or it has no effect beside the zone of location (0.9).
          if (of == ZoneClass::orientation && (orientation == 0.0 || orientation == 0.9)) continue;
          const double share = share_inside(feature, of, 1.7);
          // Five standard errors of 400 000 draws: alpha = 6e-7.
          EXPECT_NEAR(drawn(feature, of, 1.7), share, 5.0 * std::sqrt(share * (1.0 - share) / 400000.0));
        }
      }
    }
  }
}

TEST(ShareInside, OfADistanceKnowsItsShift) {
  // In units of the tolerance: the mean is 0.25, sigma is 0.75 / 3, and the limits are -1 and 1.
  const double expected = 0.5 * (std::erf(3.0 / std::sqrt(2.0)) + std::erf(5.0 / std::sqrt(2.0)));
  EXPECT_NEAR(share_inside(feature_of(FeatureKind::distance, 1.0, 0.0), ZoneClass::size, 3.0, 0.25), expected, 1e-15);
}

}  // namespace
}  // namespace poesy::drawing
