#include "engine/drawing/zone_scatter.h"

#include <gtest/gtest.h>

#include <fstream>
#include <nlohmann/json.hpp>

// Compares zone scatter with the closed-form values of another program (tests/data/drawing.json).
namespace poesy::drawing {
namespace {

using nlohmann::json;

const json& known() {
  static const json all = json::parse(std::ifstream(POESY_TEST_DATA "/drawing.json"));
  return all["known"];
}

FeatureKind kind_of(const std::string& name) {
  if (name == "axis") return FeatureKind::axis;
  return name == "round" ? FeatureKind::round : FeatureKind::rectangle;
}

Feature feature(FeatureKind kind, std::optional<double> location, std::optional<double> orientation) {
  Feature made{.name = "a_1", .label = "a", .limb = 1, .frame = 0, .kind = kind};
  if (location) made.location = Zone{"position", *location, {}};
  if (orientation) made.orientation = Zone{"parallelism", *orientation, {}};
  return made;
}

TEST(ZoneScatter, GivesTheClosedStandardDeviations) {
  std::size_t compared = 0;
  for (const json& one : known()) {
    if (!one["name"].get<std::string>().starts_with("standard deviations")) continue;
    std::optional<double> orientation;
    if (!one["orientation_mm"].is_null()) orientation = one["orientation_mm"];
    const Feature made = feature(kind_of(one["kind"]), one["location_mm"].get<double>(), orientation);
    const FeatureSigmas found = feature_sigmas(made, one["k"]);
    EXPECT_NEAR(found.middle.value(), one["sd_location_mm"].get<double>(), 1e-15) << one["name"];
    EXPECT_NEAR(found.tilt.value(), one["sd_orientation_mm"].get<double>(), 1e-15) << one["name"];
    ++compared;
  }
  EXPECT_EQ(compared, 16u);
}

TEST(ZoneScatter, ReadsAShareByTheShapeOfTheZone) {
  std::size_t compared = 0;
  for (const json& one : known()) {
    if (!one["name"].get<std::string>().starts_with("sigmas for a share")) continue;
    const ZoneScatter scatter{.within = one["share"].get<double>()};
    EXPECT_NEAR(sigmas_of(feature(FeatureKind::distance, 1.0, {}), scatter), one["interval"].get<double>(), 1e-12);
    EXPECT_NEAR(sigmas_of(feature(FeatureKind::rectangle, 1.0, {}), scatter), one["interval"].get<double>(), 1e-12);
    EXPECT_NEAR(sigmas_of(feature(FeatureKind::axis, 1.0, {}), scatter), one["disc"].get<double>(), 1e-12);
    EXPECT_NEAR(sigmas_of(feature(FeatureKind::point, 1.0, {}), scatter), one["ball"].get<double>(), 1e-12);
    ++compared;
  }
  EXPECT_EQ(compared, 2u);
}

TEST(ZoneScatter, OfOneZoneAlone) {
  EXPECT_NEAR(feature_sigmas(feature(FeatureKind::distance, 0.02, {}), 3.0).middle.value(), 0.02 / 3.0, 1e-17);
  EXPECT_NEAR(feature_sigmas(feature(FeatureKind::point, 0.03, {}), 3.0).middle.value(), 0.005, 1e-17);
  const FeatureSigmas leans = feature_sigmas(feature(FeatureKind::axis, {}, 0.03), 3.0);
  EXPECT_FALSE(leans.middle);
  EXPECT_NEAR(leans.tilt.value(), 0.01, 1e-17);
  EXPECT_NEAR(feature_sigmas(feature(FeatureKind::rectangle, {}, 0.03), 3.0).tilt.value(), 0.005 / std::sqrt(2.0),
              1e-17);
  EXPECT_NEAR(feature_sigmas(feature(FeatureKind::round, {}, 0.03), 3.0).tilt.value(), 0.005, 1e-17);
  EXPECT_FALSE(feature_sigmas(feature(FeatureKind::axis, {}, {}), 3.0).tilt);
}

TEST(ZoneScatter, OfAClearanceIsThatOfAnEndInADisc) {
  const json all = json::parse(std::ifstream(POESY_TEST_DATA "/drawing.json"));
  for (const json& one : all["fits"]) {
    const double rms = one["rms_um"];
    Feature pin = feature(FeatureKind::axis, {}, {});
    pin.clearance = Clearance{one["most_um"], rms * rms, true};
    const auto of_end = [&] {
      const FeatureSigmas found = feature_sigmas(pin, 0.0);
      return std::hypot(*found.middle, 0.5 * *found.tilt);
    };
    EXPECT_NEAR(of_end(), one["end_sd_boundary_um"].get<double>(), 1e-12);
    pin.clearance->touches = false;
    EXPECT_NEAR(of_end(), one["end_sd_uniform_um"].get<double>(), 1e-12);
  }
}

/// A coordinate of the end of an axis, or of the corner of a plane, has the standard deviation (half the zone) /
/// sigmas. This holds for every ratio of the zone of orientation to the zone of location.
TEST(ZoneScatter, KeepsWhatAnExtremePointMayDo) {
  for (const double share : {0.1, 0.4, 0.69, 0.9}) {
    const FeatureSigmas axis = feature_sigmas(feature(FeatureKind::axis, 1.0, share), 3.0);
    EXPECT_NEAR(std::hypot(*axis.middle, *axis.tilt / 2.0), 1.0 / 6.0, 1e-15);
    const FeatureSigmas plane = feature_sigmas(feature(FeatureKind::rectangle, 1.0, share), 3.0);
    EXPECT_NEAR(std::sqrt(std::pow(*plane.middle, 2) + 2.0 * std::pow(*plane.tilt, 2)), 1.0 / 6.0, 1e-15);
    const FeatureSigmas round = feature_sigmas(feature(FeatureKind::round, 1.0, share), 3.0);
    EXPECT_NEAR(std::hypot(*round.middle, *round.tilt), 1.0 / 6.0, 1e-15);
  }
}

}  // namespace
}  // namespace poesy::drawing
