#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <optional>
#include <utility>

#include "engine/drawing/zone_draws.h"
#include "engine/kinds/study_file.h"
#include "engine/study/plan.h"
#include "tests/support/fake_model.h"
#include "tests/support/input_error.h"
#include "tests/support/kinds.h"

// Tests errors.zones: features of a drawing that scatter within their zones. The mechanism has the errors delta_1,
// epsilon_1 and delta_2.
namespace poesy {
namespace {

/// A mechanism with one feature, an axis: its middle is the error delta_1, its tilt the error delta_2.
Catalog with_axis(const Zone& location) {
  Catalog catalog = test::fake_catalog();
  Feature axis{.name = "bore_1", .label = "bore", .limb = 1, .frame = 0, .kind = FeatureKind::axis, .size = {0.04}};
  axis.middle = {FactorIndex(0)};
  axis.tilt = {FactorIndex(2)};
  axis.location = location;
  catalog.front().description.features = {axis};
  return catalog;
}

const Catalog kZoneCatalog = with_axis({"position", 5e-5, "A|B"});

std::string study_text(const std::string& rest) {
  return "format = \"poesy-study\"\nversion = 1\nmechanism = { model = \"fake\" }\nposes = { count = 3 }\n" + rest;
}

Study read(const std::string& rest) {
  return study_of_text(study_text(rest), "study.toml", kZoneCatalog, StudyUse::run);
}

double sigma(const Study& study, std::size_t factor) { return study.errors.by_factor[factor].standard_deviation(); }

TEST(ZoneKeys, GiveTheStandardDeviationsOfTheZone) {
  const Study study = read("errors.zones = { distribution = \"normal\", sigmas = 3 }\n");
  EXPECT_NEAR(sigma(study, 0), 5.8925565099e-6, 1e-16);
  EXPECT_NEAR(sigma(study, 2), 11.7851130198e-6, 1e-16);
  EXPECT_EQ(sigma(study, 1), sigma(read("errors.linear = { distribution = \"normal\", sigma = \"1 mm\" }\n"), 1));
  const Study by_cpk = read("errors.zones = { distribution = \"normal\", cpk = 2 }\n");
  EXPECT_NEAR(sigma(by_cpk, 0), 0.5 * sigma(study, 0), 1e-18);
  const Study by_share = read("errors.zones = { distribution = \"normal\", within = 0.99 }\n");
  EXPECT_NEAR(sigma(by_share, 0), 3.0 / 3.0348542587702925 * sigma(study, 0), 1e-17);
}

TEST(ZoneKeys, AreAskedForWhereAFeatureVariesWithoutASize) {
  test::expect_input_error([] { read(""); }, {"study.toml", 1, 1},
                           {"key 'errors.zones' is missing", "'delta_1' of the feature 'bore_1' varies", "sigmas = 3"});
}

TEST(ZoneKeys, AreNotEnoughForAnErrorThatNoZoneLimits) {
  Catalog only_orientation = kZoneCatalog;
  Feature& bore = only_orientation.front().description.features.front();
  bore.location.reset();
  bore.orientation = Zone{"parallelism", 2e-5, "A"};
  const auto read_with = [&](const std::string& linear) {
    return study_of_text(study_text("[errors]\nzones = { distribution = \"normal\", sigmas = 3 }\n" + linear),
                         "study.toml", only_orientation, StudyUse::run);
  };
  test::expect_input_error([&] { read_with(""); }, {"study.toml", 5, 1},
                           {"'delta_1' of the feature 'bore_1' varies, but no zone", "errors.linear"});
  EXPECT_DOUBLE_EQ(sigma(read_with("linear = { distribution = \"normal\", sigma = \"2 mm\" }\n"), 0), 2e-3);
}

TEST(ZoneKeys, YieldToAnErrorsOwnDistribution) {
  const Study study = read(
      "[errors]\nlinear = { distribution = \"normal\", sigma = \"2 mm\" }\n"
      "override = { delta_2 = { distribution = \"normal\", sigma = \"3 mm\" } }\n"
      "zones = { distribution = \"normal\", sigmas = 3 }\n");
  EXPECT_NEAR(sigma(study, 0), 5.8925565099e-6, 1e-16);
  EXPECT_DOUBLE_EQ(sigma(study, 2), 3e-3);
}

TEST(ZoneKeys, AreReadBackFromTheirText) {
  for (const char* use : {"sigmas = 4", "cpk = 1.1", "within = \"99.73 %\""}) {
    const Study study = read(std::string("errors.zones = { distribution = \"normal\", ") + use + " }\n");
    const std::string text = resolved_text(study);
    EXPECT_EQ(text.find("[errors.override]"), std::string::npos) << text;
    const Study again = study_of_text(text, "again.toml", kZoneCatalog, StudyUse::run);
    EXPECT_EQ(again.errors.by_factor, study.errors.by_factor) << use;
    EXPECT_EQ(resolved_text(again), text);
  }
}

TEST(ZoneKeys, AreRefusedWithPlaceAndRemedy) {
  const auto refused = [](const std::string& marked, const std::vector<std::string>& words,
                          const Catalog& catalog = kZoneCatalog) {
    SCOPED_TRACE(marked);
    const test::Marked text(study_text(marked));
    test::expect_input_error([&] { study_of_text(text.text, "study.toml", catalog, StudyUse::run); },
                             {"study.toml", text.line, text.column}, words);
  };
  refused("errors.zones = ^{ distribution = \"normal\" }\n", {"errors.zones does not say", "sigmas = 3"});
  refused("errors.zones = ^{ distribution = \"normal\", sigmas = 3, cpk = 1 }\n", {"says twice"});
  refused("errors.zones = { distribution = ^\"triangular\", sigmas = 3 }\n",
          {"errors.zones.distribution is 'triangular'", "known: normal, uniform, boundary, inspected"});
  refused("errors.zones = ^{ distribution = \"inspected\" }\n", {"errors.zones does not say", "sigmas = 3"});
  for (const std::string shape : {"uniform", "boundary"}) {
    refused("errors.zones = ^{ distribution = \"" + shape + "\", cpk = 1 }\n",
            {"distribution = \"" + shape + "\", which fills the zone", "remove sigmas"});
  }
  refused("errors.zones = ^{ distribution = \"inspected\", sigmas = 1.4 }\n",
          {"half a zone of 'bore_1' in 1.4 standard deviations", "sigmas = 1.5"});
  refused("errors.zones = ^{ distribution = \"inspected\", within = 0.6 }\n", {"half a zone of 'bore_1'"});
  refused("errors.zones = ^{ sigmas = 3 }\n", {"'distribution' is missing", "distribution = \"normal\""});
  refused("errors.zones = { distribution = \"normal\", sigmas = ^0 }\n", {"errors.zones.sigmas is 0"});
  refused("errors.zones = { distribution = \"normal\", cpk = ^-1 }\n", {"errors.zones.cpk is -1"});
  refused("errors.zones = { distribution = \"normal\", within = ^1 }\n", {"errors.zones.within is 1"});
  refused("errors.zones = { distribution = \"normal\", within = ^\"120 %\" }\n", {"errors.zones.within"});
  refused("errors.zones = { distribution = \"normal\", ^sigma = 3 }\n", {"unknown key 'sigma'", "sigmas"});
  refused("errors.zones = ^3\n", {"errors.zones is the whole number 3"});
  refused("errors.zones = ^{ distribution = \"normal\", sigmas = 3 }\n", {"fake", "has no features"},
          test::fake_catalog());
}

/// The axis with a zone between two planes, so that it has one middle and one tilt error.
Catalog between_planes(std::optional<Zone> orientation = std::nullopt) {
  Catalog catalog = with_axis({"position", 5e-5, "A|B"});
  catalog.front().description.features.front().one_direction = true;
  catalog.front().description.features.front().orientation = std::move(orientation);
  return catalog;
}

const Catalog kBetweenPlanes = between_planes();
const std::string kMachines = "analysis = { kind = \"monte-carlo\", draws = \"per machine\" }\n";

Study read_shape(const std::string& rest) {
  return study_of_text(study_text(rest), "study.toml", kBetweenPlanes, StudyUse::run);
}

TEST(ZoneShapes, AreReadBackFromTheirText) {
  for (const char* shape :
       {"\"uniform\"", "\"boundary\"", "\"inspected\", sigmas = 2", "\"inspected\", within = 0.99"}) {
    const Study study = read_shape(std::string("errors.zones = { distribution = ") + shape + " }\n" + kMachines);
    const std::string text = resolved_text(study);
    EXPECT_EQ(text.find("[errors.override]"), std::string::npos) << text;
    const Study again = study_of_text(text, "again.toml", kBetweenPlanes, StudyUse::run);
    EXPECT_EQ(again.errors.zones, study.errors.zones) << shape;
    EXPECT_EQ(again.errors.by_factor, study.errors.by_factor) << shape;
    EXPECT_EQ(resolved_text(again), text);
  }
}

/// Half the zone is 25 um. The standard deviations of axes with both ends inside the zone have closed forms.
TEST(ZoneShapes, GiveNormalsOfTheirStandardDeviationToOneErrorAtATime) {
  const Study uniform = read_shape("errors.zones = { distribution = \"uniform\" }\n");
  EXPECT_EQ(uniform.errors.by_factor[0].shape(), Distribution::Shape::normal);
  EXPECT_NEAR(sigma(uniform, 0), 25e-6 / std::sqrt(6.0), 1e-15);
  EXPECT_NEAR(sigma(uniform, 2), 50e-6 / std::sqrt(6.0), 1e-15);
  const Study boundary = read_shape("errors.zones = { distribution = \"boundary\" }\n");
  EXPECT_NEAR(sigma(boundary, 0), 25e-6 / std::sqrt(2.0), 1e-15);
  EXPECT_NEAR(sigma(boundary, 2), 50e-6 / std::sqrt(2.0), 1e-15);
}

TEST(ZoneShapes, AreDrawnAsAWhole) {
  constexpr std::size_t kCount = 50;
  const Study study = read_shape("errors.zones = { distribution = \"uniform\" }\n" + kMachines);
  const Plan plan(study, PoseSet(3, {-0.2, 0.0, 0.0}));
  ASSERT_EQ(plan.zones().size(), 1u);
  EXPECT_FALSE(plan.is_drawn_alone(0));
  EXPECT_TRUE(plan.is_drawn_alone(1));
  EXPECT_FALSE(plan.is_drawn_alone(2));
  std::vector<double> errors(3 * kCount);
  for (std::size_t v = 0; v < 3; ++v) {
    plan.draw_uniforms(v, PoseIndex(0), SampleIndex(0), std::span(errors).subspan(v * kCount, kCount));
  }
  std::vector<double> expected = errors;
  const std::array rows{std::span(expected).subspan(0, kCount), std::span(expected).subspan(2 * kCount, kCount)};
  drawing::ZoneDraws(study.model().features.front(), *study.errors.zones).transform(rows);
  plan.distributions()[1].transform(std::span(expected).subspan(kCount, kCount));
  plan.transform(errors, kCount);
  EXPECT_EQ(errors, expected);
  const Study alone = read_shape("errors.zones = { distribution = \"uniform\" }\n");
  EXPECT_TRUE(Plan(alone, PoseSet(3, {-0.2, 0.0, 0.0})).zones().empty());
}

TEST(ZoneShapes, AreRefusedWithPlaceAndRemedy) {
  const auto refused = [](const std::string& marked, const std::vector<std::string>& words,
                          const Catalog& catalog = kBetweenPlanes) {
    SCOPED_TRACE(marked);
    const test::Marked text(study_text(marked));
    test::expect_input_error([&] { study_of_text(text.text, "study.toml", catalog, StudyUse::run); },
                             {"study.toml", text.line, text.column}, words);
  };
  const std::string uniform = "errors.zones = ^{ distribution = \"uniform\" }\n";
  refused(uniform + "analysis = { kind = \"monte-carlo\", factors = [\"delta_1\", \"epsilon_1\"] }\n",
          {"draws all errors of 'bore_1' together", "'delta_2' does not vary", "'delta_1' does", "name all of them"});
  refused(uniform + "errors.override = { delta_1 = { distribution = \"normal\", sigma = \"1 um\" } }\n" + kMachines,
          {"'delta_1' does not vary by its zone and 'delta_2' does"});
  refused(uniform + "errors.override = { delta_1 = { draws = \"per pose\" } }\n" + kMachines,
          {"only some of them are drawn per pose", "the same draws"});
  refused(uniform +
              "errors.correlated = [{ factors = [\"delta_1\", \"epsilon_1\"], correlation = [[1, 0.5], [0.5, 1]] }]\n" +
              kMachines,
          {"errors.correlated has 'delta_1'", "distribution = \"normal\""});
  refused("errors.zones.distribution = \"uniform\"\n^analysis.kind = \"sobol\"\n",
          {"delta_1, delta_2 are drawn together", "different groups", "bore = [\"bore_*\"]"});
  refused("errors.zones = ^{ distribution = \"boundary\" }\n", {"'bore_1' has an orientation", "\"inspected\""},
          between_planes(Zone{"parallelism", 1e-5, {}}));
  Catalog plane = kBetweenPlanes;
  plane.front().description.features.front().kind = FeatureKind::round;
  refused("errors.zones = ^{ distribution = \"boundary\" }\n", {"'bore_1' is a plane"}, plane);
}

}  // namespace
}  // namespace poesy
