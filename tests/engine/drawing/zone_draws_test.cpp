#include "engine/drawing/zone_draws.h"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <fstream>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "engine/drawing/share_inside.h"
#include "engine/drawing/zone_moments.h"
#include "engine/random/normal_quantile.h"
#include "engine/random/stream.h"

// Features whose errors are drawn together. The draws are compared with those of another program
// (tests/data/drawing.json) and with the definitions of the zones.
namespace poesy::drawing {
namespace {

using nlohmann::json;
using enum FeatureKind;

const json& known() {
  static const json all = json::parse(std::ifstream(POESY_TEST_DATA "/drawing.json"));
  return all["known"];
}

/// A feature whose errors are numbered from 0.
Feature feature_of(FeatureKind kind, double location, double orientation, bool one_direction = false) {
  Feature feature{.name = "f_1", .label = "f", .limb = 1, .frame = 0, .kind = kind, .one_direction = one_direction};
  if (location > 0.0) feature.location = Zone{"position", location, {}};
  if (orientation > 0.0) feature.orientation = Zone{"parallelism", orientation, {}};
  const bool is_plane = kind == rectangle || kind == round;
  const std::size_t directions = one_direction ? 1 : kind == point ? 3 : 2;
  const std::size_t middles = location <= 0.0 ? 0 : is_plane || kind == distance ? 1 : directions;
  const std::size_t tilts = kind == axis || is_plane ? directions : 0;
  for (std::size_t k = 0; k < middles; ++k) feature.middle.emplace_back(k);
  for (std::size_t k = 0; k < tilts; ++k) feature.tilt.emplace_back(middles + k);
  return feature;
}

std::vector<double> draw(const Feature& feature, const ZoneScatter& scatter, std::vector<double> u) {
  std::vector<std::span<double>> rows;
  for (double& one : u) rows.emplace_back(&one, 1);
  ZoneDraws(feature, scatter).transform(rows);
  return u;
}

void expect_draws(const json& draws, const Feature& feature, ScatterShape shape, std::size_t first = 0) {
  for (const json& one : draws) {
    const auto expected = one["errors"].get<std::vector<double>>();
    auto u = one["u"].get<std::vector<double>>();
    u.insert(u.begin(), first, 0.5);
    u.resize(feature.errors().size(), 0.5);
    const std::vector<double> found = draw(feature, {.shape = shape}, u);
    for (std::size_t e = 0; e < expected.size(); ++e) EXPECT_NEAR(found[e], expected[e], 1e-10) << one << " " << e;
  }
}

TEST(ZoneDraws, OfUniformFeaturesAreThoseOfTheOracle) {
  int found = 0;
  for (const json& one : known()) {
    const std::string name = one["name"];
    const bool is_axis = name.starts_with("uniform axis");
    if (!is_axis && !name.starts_with("uniform plane")) continue;
    ++found;
    const FeatureKind kind = is_axis ? axis : name.find("round") == std::string::npos ? rectangle : round;
    const double tau = one["tau"];
    const Feature feature = feature_of(kind, 2.0, 2.0 * tau);
    expect_draws(one["draws"], feature, ScatterShape::uniform);
    const FeatureSigmas sigmas = scatter_sigmas(feature, {.shape = ScatterShape::uniform});
    EXPECT_NEAR(sigmas.middle.value(), one[is_axis ? "sd_x" : "sd_z"].get<double>(), 1e-10) << name;
    EXPECT_NEAR(sigmas.tilt.value(), one[is_axis ? "sd_lean" : "sd_lift"].get<double>(), 1e-10) << name;
  }
  EXPECT_EQ(found, 6);
}

TEST(ZoneDraws, OfDiscsAndBallsAreThoseOfTheOracle) {
  const Feature leaning = feature_of(axis, 0.0, 1.0);
  for (const json& one : known()) {
    const std::string name = one["name"];
    if (name == "disc, draws") {
      expect_draws(one["uniform"], leaning, ScatterShape::uniform);
      EXPECT_NEAR(scatter_sigmas(leaning, {.shape = ScatterShape::uniform}).tilt.value(),
                  one["sd_uniform"].get<double>(), 1e-12);
      const Feature bore = feature_of(axis, 2.0, 0.0);
      for (const json& at : one["boundary"]) {
        const double u = at["u"][1];
        const std::vector<double> ends = draw(bore, {.shape = ScatterShape::boundary}, {0.3, u, 0.3, 0.25});
        EXPECT_NEAR(ends[0] - 0.5 * ends[2], at["errors"][0].get<double>(), 1e-15);
        EXPECT_NEAR(ends[1] - 0.5 * ends[3], at["errors"][1].get<double>(), 1e-15);
        EXPECT_NEAR(ends[0] + 0.5 * ends[2], 0.0, 1e-15);
        EXPECT_NEAR(ends[1] + 0.5 * ends[3], 1.0, 1e-15);
      }
    }
    if (name == "ball, draws") expect_draws(one["uniform"], feature_of(point, 2.0, 0.0), ScatterShape::uniform);
    if (!name.starts_with("shares inside")) continue;
    const double k = one["k"];
    EXPECT_NEAR(scatter_sigmas(leaning, {.shape = ScatterShape::inspected, .sigmas = k}).tilt.value() * k,
                one["cut_disc_standard_deviation_over_sigma"].get<double>(), 1e-11);
  }
}

struct Scattering {
  const char* name;
  Feature feature;
  ZoneScatter scatter;
};

std::vector<Scattering> scatterings() {
  std::vector<Scattering> list;
  const ZoneScatter uniform{.shape = ScatterShape::uniform};
  const ZoneScatter boundary{.shape = ScatterShape::boundary};
  const ZoneScatter inspected{.shape = ScatterShape::inspected, .sigmas = 1.5};
  const std::vector<std::pair<const char*, Feature>> features{
      {"Axis", feature_of(axis, 0.05, 0.0)},
      {"OrientedAxis", feature_of(axis, 0.05, 0.02)},
      {"AxisInSlot", feature_of(axis, 0.05, 0.0, true)},
      {"OrientedAxisInSlot", feature_of(axis, 0.05, 0.03, true)},
      {"Lean", feature_of(axis, 0.0, 0.02)},
      {"Rectangle", feature_of(rectangle, 0.03, 0.0)},
      {"OrientedRectangle", feature_of(rectangle, 0.03, 0.01)},
      {"RectangleLift", feature_of(rectangle, 0.0, 0.01)},
      {"Round", feature_of(round, 0.03, 0.0)},
      {"OrientedRound", feature_of(round, 0.03, 0.01)},
      {"RoundLift", feature_of(round, 0.0, 0.01)},
      {"Point", feature_of(point, 0.04, 0.0)},
      {"Distance", feature_of(distance, 0.02, 0.0)}};
  for (const auto& [name, feature] : features) {
    for (const ZoneScatter& scatter : {uniform, boundary, inspected}) {
      if (scatter == boundary && !can_touch(feature)) continue;
      if (are_drawn_together(feature, scatter)) list.push_back({name, feature, scatter});
    }
  }
  return list;
}

std::string name_of(const Scattering& one) {
  constexpr std::array kShapes{"Normal", "Uniform", "Boundary", "Inspected"};
  return std::string(one.name) + kShapes[static_cast<std::size_t>(one.scatter.shape)];
}

class Scattered : public testing::TestWithParam<Scattering> {};

constexpr std::size_t kDraws = 200'000;

/// [errors][kDraws] Random errors of the feature (m).
std::vector<std::vector<double>> draws_of(const Scattering& one) {
  std::vector<std::vector<double>> errors(one.feature.errors().size(), std::vector<double>(kDraws));
  std::vector<std::span<double>> rows;
  for (std::size_t e = 0; e < errors.size(); ++e) {
    fill_uniforms({7, Purpose::error_samples, FactorIndex(e), PoseIndex(0)}, SampleIndex(0), errors[e]);
    rows.emplace_back(errors[e]);
  }
  ZoneDraws(one.feature, one.scatter).transform(rows);
  return errors;
}

/// Expects that the mean of these numbers is `expected`, within 4.9 standard errors (alpha = 1e-6).
void expect_mean(const std::vector<double>& numbers, double expected, const std::string& what) {
  constexpr double kQuantile = 4.9;
  double sum = 0.0;
  double squares = 0.0;
  for (const double one : numbers) {
    sum += one - expected;
    squares += (one - expected) * (one - expected);
  }
  const auto n = static_cast<double>(numbers.size());
  const double error = std::sqrt(squares / n / n) + 1e-12 * std::abs(expected);
  EXPECT_LE(std::abs(sum / n), kQuantile * error) << what;
}

/// The means are zero, the variances are those of scatter_sigmas(), the covariances are zero, and all draws are inside
/// the zones.
TEST_P(Scattered, HaveTheirMoments) {
  const Scattering& one = GetParam();
  const std::vector<std::vector<double>> errors = draws_of(one);
  const FeatureSigmas sigmas = scatter_sigmas(one.feature, one.scatter);
  const std::size_t middles = one.feature.middle.size();
  for (std::size_t i = 0; i < errors.size(); ++i) {
    expect_mean(errors[i], 0.0, "mean " + std::to_string(i));
    for (std::size_t j = 0; j <= i; ++j) {
      std::vector<double> products;
      for (std::size_t b = 0; b < kDraws; ++b) products.push_back(errors[i][b] * errors[j][b]);
      const double sigma = (i < middles ? sigmas.middle : sigmas.tilt).value();
      expect_mean(products, i == j ? sigma * sigma : 0.0, "product " + std::to_string(i) + " " + std::to_string(j));
    }
  }
  std::size_t outside = 0;
  for (std::size_t b = 0; b < kDraws; ++b) {
    std::vector<double> sample;
    for (const auto& row : errors) sample.push_back((1.0 - 1e-12) * row[b]);
    if (!is_inside(one.feature, sample)) ++outside;
  }
  EXPECT_EQ(outside, 0u);
}

/// The draw of one sample does not depend on which samples are drawn with it.
TEST_P(Scattered, DependOnTheSample) {
  const Scattering& one = GetParam();
  const std::vector<std::vector<double>> errors = draws_of(one);
  for (const std::size_t b : {0u, 17u, 4711u}) {
    std::vector<double> u(errors.size());
    for (std::size_t e = 0; e < errors.size(); ++e) {
      fill_uniforms({7, Purpose::error_samples, FactorIndex(e), PoseIndex(0)}, SampleIndex(b), std::span(&u[e], 1));
    }
    const std::vector<double> found = draw(one.feature, one.scatter, u);
    for (std::size_t e = 0; e < errors.size(); ++e) EXPECT_EQ(found[e], errors[e][b]);
  }
}

const auto kName = [](const auto& one) { return name_of(one.param); };

INSTANTIATE_TEST_SUITE_P(Zones, Scattered, testing::ValuesIn(scatterings()), kName);

/// Uniform draws fill the zone evenly. Compares the share of axes in one part of the zone with rejection sampling.
TEST(ZoneDraws, FillTheZoneEvenly) {
  const std::vector<std::vector<double>> errors =
      draws_of({"Axis", feature_of(axis, 2.0, 1.0), {.shape = ScatterShape::uniform}});
  std::vector<double> is_below;  // 1 if the axis is in the part of the zone with a lean below 0.5 and x above 0.2
  for (std::size_t b = 0; b < kDraws; ++b) {
    is_below.push_back(std::hypot(errors[2][b], errors[3][b]) < 0.5 && errors[0][b] > 0.2 ? 1.0 : 0.0);
  }
  std::size_t inside = 0;
  std::size_t below = 0;
  std::vector<double> u(4);
  for (std::size_t b = 0; b < 10 * kDraws; ++b) {
    for (std::size_t e = 0; e < 4; ++e)
      fill_uniforms({9, Purpose::error_samples, FactorIndex(e), PoseIndex(0)}, SampleIndex(b), {&u[e], 1});
    for (double& one : u) one = 2.0 * one - 1.0;
    if (!is_inside(feature_of(axis, 2.0, 1.0), u)) continue;
    ++inside;
    if (std::hypot(u[2], u[3]) < 0.5 && u[0] > 0.2) ++below;
  }
  ASSERT_GT(inside, kDraws);
  const double share = static_cast<double>(below) / static_cast<double>(inside);
  double sum = 0.0;
  for (const double one : is_below) sum += one;
  const double found = sum / static_cast<double>(kDraws);
  const double variance =
      share * (1.0 - share) * (1.0 / static_cast<double>(kDraws) + 1.0 / static_cast<double>(inside));
  EXPECT_LE(std::abs(found - share), 4.9 * std::sqrt(variance));
}

/// Inspected features keep the first normal draw that is inside the zone. So the share of samples that keep their very
/// first draw is the share of normal draws inside.
TEST(ZoneDraws, KeepTheFirstAttemptThatIsInside) {
  const Feature bore = feature_of(axis, 0.05, 0.0);
  const ZoneScatter scatter{.shape = ScatterShape::inspected, .sigmas = 3.0};
  const std::vector<std::vector<double>> inspected = draws_of({"Axis", bore, scatter});
  const FeatureSigmas sigma = feature_sigmas(bore, 3.0);
  std::vector<double> is_first(kDraws, 0.0);
  for (std::size_t b = 0; b < kDraws; ++b) {
    double u = 0.0;
    fill_uniforms({7, Purpose::error_samples, FactorIndex(0), PoseIndex(0)}, SampleIndex(b), {&u, 1});
    is_first[b] = normal_quantile(*sigma.middle, u) == inspected[0][b] ? 1.0 : 0.0;
  }
  expect_mean(is_first, share_inside(bore, ZoneClass::location, 3.0), "first attempts");
}

TEST(ZoneDraws, LeaveSingleErrorsAndNormalsAlone) {
  const Feature rod = feature_of(distance, 0.02, 0.0);
  EXPECT_FALSE(are_drawn_together(rod, {.shape = ScatterShape::uniform}));
  EXPECT_TRUE(are_drawn_together(rod, {.shape = ScatterShape::boundary}));
  EXPECT_FALSE(are_drawn_together(feature_of(axis, 0.05, 0.0), {}));
  EXPECT_FALSE(are_drawn_together(feature_of(axis, 0.0, 0.0), {.shape = ScatterShape::uniform}));
  Feature loose = feature_of(axis, 0.05, 0.0);
  loose.clearance = Clearance{0.05, 0.001};
  EXPECT_FALSE(are_drawn_together(loose, {}));
  EXPECT_NEAR(scatter_sigmas(rod, {.shape = ScatterShape::uniform}).middle.value(), 0.02 / std::sqrt(3.0), 1e-17);
}

/// Each end of a pin touches its bore, or is anywhere in it, whatever the distribution of other features; the standard
/// deviations are those of the clearance.
TEST(ZoneDraws, OfPinsStayInTheirBores) {
  Feature pin = feature_of(axis, 0.05, 0.0);
  pin.location.reset();
  constexpr double kDiameter = 0.024;  // root mean square of the clearance
  for (const bool touches : {true, false}) {
    pin.clearance = Clearance{0.041, kDiameter * kDiameter, touches};
    for (const ScatterShape shape : {ScatterShape::uniform, ScatterShape::inspected, ScatterShape::boundary}) {
      ASSERT_TRUE(are_drawn_together(pin, {.shape = shape}));
      constexpr std::size_t kPins = 20000;
      std::vector<std::vector<double>> drawn(4, std::vector<double>(kPins));
      for (std::size_t e = 0; e < drawn.size(); ++e) {
        fill_uniforms({11, Purpose::error_samples, FactorIndex(e), PoseIndex(0)}, SampleIndex(0), drawn[e]);
      }
      const std::vector<std::span<double>> rows(drawn.begin(), drawn.end());
      ZoneDraws(pin, {.shape = shape}).transform(rows);
      std::vector<double> squared_lean(kPins);
      for (std::size_t b = 0; b < kPins; ++b) {
        for (const double half : {-0.5, 0.5}) {
          const double away = std::hypot(drawn[0][b] + half * drawn[2][b], drawn[1][b] + half * drawn[3][b]);
          ASSERT_LE(away, 0.5 * kDiameter * (1.0 + 1e-12));
          ASSERT_GE(away, touches ? 0.5 * kDiameter * (1.0 - 1e-12) : 0.0);
        }
        squared_lean[b] = std::pow(drawn[2][b], 2);
      }
      const double lean = scatter_sigmas(pin, {.shape = shape}).tilt.value();
      expect_mean(squared_lean, lean * lean, "squared lean");
    }
  }
}

}  // namespace
}  // namespace poesy::drawing
