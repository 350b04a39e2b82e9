#include "engine/drawing/worst_case.h"

#include <gtest/gtest.h>

#include <cmath>
#include <fstream>
#include <nlohmann/json.hpp>
#include <numbers>
#include <random>

#include "engine/drawing/zone_moments.h"
#include "engine/drawing/zone_scatter.h"

// Compares worst cases with the closed-form values of another program (tests/data/drawing.json) and with random points
// of the zones.
namespace poesy::drawing {
namespace {

using nlohmann::json;

Feature feature(FeatureKind kind, std::optional<double> location, std::optional<double> orientation) {
  Feature made{.name = "a_1", .label = "a", .limb = 1, .frame = 0, .kind = kind};
  const std::size_t middles = kind == FeatureKind::axis ? 2 : kind == FeatureKind::point ? 3 : 1;
  const std::size_t tilts = kind == FeatureKind::point || kind == FeatureKind::distance ? 0 : 2;
  for (std::size_t k = 0; k < middles; ++k) made.middle.emplace_back(k);
  for (std::size_t k = 0; k < tilts; ++k) made.tilt.emplace_back(middles + k);
  if (location) made.location = Zone{"position", *location, {}};
  if (orientation) made.orientation = Zone{"parallelism", *orientation, {}};
  return made;
}

OfErrors joined(const json& middle, const json& tilt) {
  OfErrors list = middle.is_array() ? middle.get<OfErrors>() : OfErrors{middle.get<double>()};
  for (const double one : tilt) list.push_back(one);
  return list;
}

TEST(WorstCase, IsTheSupportFunctionOfTheOracle) {
  const json all = json::parse(std::ifstream(POESY_TEST_DATA "/drawing.json"));
  std::size_t compared = 0;
  for (const json& one : all["known"]) {
    const std::string name = one["name"];
    if (!name.starts_with("worst case")) continue;
    const FeatureKind kind = name.find("axis") != std::string::npos    ? FeatureKind::axis
                             : name.find("round") != std::string::npos ? FeatureKind::round
                                                                       : FeatureKind::rectangle;
    std::optional<double> orientation;
    if (!one["orientation"].is_null()) orientation = one["orientation"];
    const OfErrors slopes = kind == FeatureKind::axis ? joined(one["slope_x_y"], one["slope_lean"])
                                                      : joined(one["slope_z"], one["slope_lift"]);
    const Extreme found = extreme(feature(kind, one["location"].get<double>(), orientation), slopes);
    EXPECT_NEAR(found.value, one["worst"].get<double>(), 1e-14) << name;
    ++compared;
  }
  EXPECT_EQ(compared, 8u);
}

/// Whether the errors e keep the feature within its zones.
bool is_inside(const Feature& made, const OfErrors& e) {
  constexpr double kSlack = 1e-9;
  const double t = made.location ? made.location->size : 1e9;
  const double o = made.orientation ? made.orientation->size : 1e9;
  switch (made.kind) {
    case FeatureKind::axis:
      return std::hypot(e[0] + e[2] / 2, e[1] + e[3] / 2) <= t / 2 + kSlack &&
             std::hypot(e[0] - e[2] / 2, e[1] - e[3] / 2) <= t / 2 + kSlack && std::hypot(e[2], e[3]) <= o + kSlack;
    case FeatureKind::rectangle:
      return std::abs(e[0]) + std::abs(e[1]) + std::abs(e[2]) <= t / 2 + kSlack &&
             std::abs(e[1]) + std::abs(e[2]) <= o / 2 + kSlack;
    case FeatureKind::round:
      return std::abs(e[0]) + std::hypot(e[1], e[2]) <= t / 2 + kSlack && std::hypot(e[1], e[2]) <= o / 2 + kSlack;
    case FeatureKind::point:
      return std::hypot(e[0], e[1], e[2]) <= t / 2 + kSlack;
    case FeatureKind::distance:
      return std::abs(e[0]) <= t + kSlack;
  }
  return false;
}

/// The errors of the worst case are inside the zones, and no random point inside has a larger effect.
TEST(WorstCase, IsTheLargestOfAllPointsOfTheZone) {
  std::mt19937 random(7);
  std::uniform_real_distribution<double> uniform(-1.0, 1.0);
  for (const FeatureKind kind :
       {FeatureKind::axis, FeatureKind::rectangle, FeatureKind::round, FeatureKind::point, FeatureKind::distance}) {
    for (int n = 0; n < 60; ++n) {
      const bool tilts = kind != FeatureKind::point && kind != FeatureKind::distance;
      const Feature made =
          feature(kind, 2.0, tilts && n % 3 > 0 ? std::optional(n % 3 == 1 ? 0.5 : 1.5) : std::nullopt);
      const std::size_t errors = made.middle.size() + made.tilt.size();
      OfErrors slopes(errors);
      for (double& slope : slopes) slope = uniform(random);
      if (n % 7 == 0) slopes.back() = 0.0;
      const Extreme found = extreme(made, slopes);
      ASSERT_EQ(found.errors.size(), errors);
      EXPECT_TRUE(is_inside(made, found.errors))
          << static_cast<int>(kind) << testing::PrintToString(slopes) << testing::PrintToString(found.errors)
          << (made.orientation ? made.orientation->size : -1.0);
      for (int k = 0; k < 3000; ++k) {
        OfErrors e(errors);
        for (std::size_t i = 0; i < errors; ++i) e[i] = found.errors[i] + 0.3 * uniform(random);
        if (!is_inside(made, e)) continue;
        double value = 0.0;
        for (std::size_t i = 0; i < errors; ++i) value += slopes[i] * e[i];
        EXPECT_LE(value, found.value + 1e-8);
      }
    }
  }
}

TEST(WorstCase, OfADistanceAndAnOrientationAlone) {
  EXPECT_NEAR(extreme(feature(FeatureKind::distance, 0.02, {}), {-3.0}).value, 0.06, 1e-16);
  EXPECT_NEAR(extreme(feature(FeatureKind::axis, {}, 0.5), {9.0, 9.0, 3.0, 4.0}).value, 2.5, 1e-15);
  EXPECT_NEAR(extreme(feature(FeatureKind::rectangle, {}, 0.5), {9.0, 3.0, -4.0}).value, 1.0, 1e-15);
  EXPECT_NEAR(extreme(feature(FeatureKind::round, {}, 0.5), {9.0, 3.0, -4.0}).value, 1.25, 1e-15);
}

ZoneSquares squares_of(const Feature& feature, const OfErrors& squares) {
  const ZoneScatter scatter{.sigmas = 3.0};
  return zone_squares(feature, scatter, scatter_sigmas(feature, scatter), squares);
}

/// The worst division gives the whole zone of location to either the middle or the tilt of the axis. If only the middle
/// has an effect, the mean square is twice that of the even division.
TEST(WorstCase, DividesAZoneAtWorstByOneUseAlone) {
  const Feature axis = feature(FeatureKind::axis, 1.0, {});
  EXPECT_NEAR(squares_of(axis, {1.0, 1.0, 0.0, 0.0}).worst, 2.0 / 36.0, 1e-16);
  EXPECT_NEAR(squares_of(axis, {1.0, 1.0, 0.0, 0.0}).even, 1.0 / 36.0, 1e-16);
  EXPECT_NEAR(squares_of(axis, {0.0, 0.0, 1.0, 1.0}).worst, 8.0 / 36.0, 1e-16);
  const Feature oriented = feature(FeatureKind::axis, 1.0, 0.4);
  EXPECT_NEAR(squares_of(oriented, {1.0, 1.0, 0.0, 0.0}).worst, 2.0 * 0.84 / 36.0, 1e-16);
  EXPECT_NEAR(squares_of(oriented, {0.0, 0.0, 1.0, 1.0}).worst, 2.0 * 0.16 / 9.0, 1e-16);
}

/// The largest length is the maximum over all directions. For two balls it is the sum of their radii.
TEST(WorstCase, OfALengthTurnsAllFeaturesOneWay) {
  const std::vector<Feature> features{feature(FeatureKind::point, 2.0, {}), feature(FeatureKind::point, 1.0, {})};
  const std::vector<OfErrors> unit{{1.0, 0.0, 0.0}, {0.0, 1.0, 0.0}, {0.0, 0.0, 1.0}};
  const LargestLength found = largest_length(features, {unit, unit});
  EXPECT_NEAR(found.length, 1.5, 1e-14);
  EXPECT_NEAR(found.by_feature[0], 1.0, 1e-12);
}

}  // namespace
}  // namespace poesy::drawing
