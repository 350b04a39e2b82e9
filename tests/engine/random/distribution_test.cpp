#include "engine/random/distribution.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <stdexcept>
#include <string>
#include <vector>

namespace poesy {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();
constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();

/// The message with which a constructor refuses a value. Empty if it accepts the value.
template <class Make>
std::string refusal(const Make& make) {
  try {
    make();
  } catch (const std::invalid_argument& error) {
    return error.what();
  }
  return {};
}

TEST(Distribution, KeepsItsParameters) {
  const Distribution normal = Distribution::normal(2.0);
  EXPECT_EQ(normal.shape(), Distribution::Shape::normal);
  EXPECT_EQ(normal.sigma(), 2.0);
  EXPECT_EQ(normal.half_width(), kInfinity);
  EXPECT_EQ(normal.standard_deviation(), 2.0);

  const Distribution truncated = Distribution::truncated_normal(2.0, 3.0);
  EXPECT_EQ(truncated.shape(), Distribution::Shape::truncated_normal);
  EXPECT_EQ(truncated.sigma(), 2.0);
  EXPECT_EQ(truncated.half_width(), 3.0);

  const Distribution uniform = Distribution::uniform(3.0);
  EXPECT_EQ(uniform.shape(), Distribution::Shape::uniform);
  EXPECT_EQ(uniform.sigma(), 0.0);
  EXPECT_EQ(uniform.half_width(), 3.0);
  EXPECT_DOUBLE_EQ(uniform.standard_deviation(), std::sqrt(3.0));

  const Distribution triangular = Distribution::triangular(3.0);
  EXPECT_EQ(triangular.shape(), Distribution::Shape::triangular);
  EXPECT_EQ(triangular.sigma(), 0.0);
  EXPECT_EQ(triangular.half_width(), 3.0);
  EXPECT_DOUBLE_EQ(triangular.standard_deviation(), std::sqrt(1.5));
}

TEST(Distribution, NamesOfShapesAreThoseOfStudyFiles) {
  EXPECT_EQ(name(Distribution::Shape::normal), "normal");
  EXPECT_EQ(name(Distribution::Shape::truncated_normal), "truncated-normal");
  EXPECT_EQ(name(Distribution::Shape::uniform), "uniform");
  EXPECT_EQ(name(Distribution::Shape::triangular), "triangular");
  EXPECT_EQ(name(Distribution::Shape::measured), "measured");
}

TEST(Distribution, RefusesImpossibleParametersByName) {
  const std::string sigma_rule = "sigma must be a finite number above zero";
  const std::string width_rule = "half_width must be a finite number above zero";
  for (const double bad : {0.0, -1.0, kNaN, kInfinity, -kInfinity}) {
    EXPECT_EQ(refusal([bad] { Distribution::normal(bad); }), sigma_rule) << bad;
    EXPECT_EQ(refusal([bad] { Distribution::truncated_normal(bad, 1.0); }), sigma_rule) << bad;
    EXPECT_EQ(refusal([bad] { Distribution::truncated_normal(1.0, bad); }), width_rule) << bad;
    EXPECT_EQ(refusal([bad] { Distribution::uniform(bad); }), width_rule) << bad;
    EXPECT_EQ(refusal([bad] { Distribution::triangular(bad); }), width_rule) << bad;
  }
  EXPECT_EQ(refusal([] { Distribution::truncated_normal(1e-6, 1e-9); }), "");
}

const std::vector<double> kMeasured{3.0, 1.0, 4.0, 1.5, 9.0, 2.5, 5.0, 3.5};

TEST(MeasuredDistribution, HasMeanAndDeviationOfTheSample) {
  const Distribution measured = Distribution::measured(kMeasured);
  EXPECT_DOUBLE_EQ(measured.mean(), 3.6875);
  EXPECT_NEAR(measured.standard_deviation(), std::sqrt(43.96875 / 7.0), 1e-14);
  EXPECT_EQ(measured.half_width(), measured.parts()->greatest());
  EXPECT_GT(measured.half_width(), 9.0);
  EXPECT_EQ(measured.sigma(), 0.0);
  EXPECT_EQ(Distribution::normal(1.0).mean(), 0.0);
}

TEST(MeasuredDistribution, TransformsAsItsQuantileFunctionDoes) {
  const Distribution measured = Distribution::measured(kMeasured);
  std::vector<double> values;
  for (int k = 0; k < 1001; ++k) values.push_back((k + 0.5) / 1001);
  std::vector<double> transformed = values;
  measured.transform(transformed);
  for (std::size_t k = 0; k < values.size(); ++k) EXPECT_EQ(transformed[k], measured.quantile(values[k]));
}

TEST(MeasuredDistribution, KnowsItsValues) {
  const Distribution measured = Distribution::measured(kMeasured);
  EXPECT_TRUE(std::ranges::equal(measured.parts()->values(), kMeasured));
  EXPECT_EQ(measured, Distribution::measured(kMeasured));
  std::vector<double> other = kMeasured;
  other[1] = 1.25;
  EXPECT_NE(measured, Distribution::measured(other));
  EXPECT_FALSE(Distribution::normal(1.0).parts());
}

TEST(MeasuredDistribution, RefusesWhatIsNoSample) {
  const auto refused = [](std::vector<double> values) { return refusal([&] { Distribution::measured(values); }); };
  EXPECT_EQ(refused({1.0, 2.0, 3.0, 4.0, 5.0, 6.0, 7.0}), "number of values must be at least 8, not 7");
  EXPECT_EQ(refused(std::vector<double>(20, 1.0)), "values must not all be equal");
  std::vector<double> bad = kMeasured;
  bad[3] = kNaN;
  EXPECT_EQ(refused(bad), "values must be finite numbers");
}

TEST(TransformScores, GivesTheValueAtTheSameShare) {
  const std::vector<double> scores{-9.5, -3.0, -0.25, 0.0, 0.5, 2.0, 9.5};
  for (const Distribution& distribution : {Distribution::truncated_normal(1.0, 2.0), Distribution::uniform(2.0),
                                           Distribution::triangular(1.0), Distribution::measured(kMeasured)}) {
    std::vector<double> values = scores;
    distribution.transform_scores(values);
    for (std::size_t k = 1; k + 1 < scores.size(); ++k) {
      const double share = 0.5 * std::erfc(-scores[k] / std::sqrt(2.0));
      EXPECT_NEAR(values[k], distribution.quantile(share), 1e-13) << name(distribution.shape());
    }
    EXPECT_NEAR(values.front(), distribution.quantile(0x1p-53), 1e-7);
    EXPECT_NEAR(values.back(), distribution.quantile(1.0 - 0x1p-53), 1e-7);
  }
  std::vector<double> values = scores;
  Distribution::normal(0.5).transform_scores(values);
  for (std::size_t k = 0; k < scores.size(); ++k) EXPECT_EQ(values[k], 0.5 * scores[k]);
}

TEST(NormalQuantile, MatchesTabulatedValues) {
  // Values from Abramowitz and Stegun, Table 26.5, and for the far tail from Wichura 1988 (AS 241).
  const Distribution normal = Distribution::normal(1.0);
  EXPECT_EQ(normal.quantile(0.5), 0.0);
  EXPECT_NEAR(normal.quantile(0.975), 1.9599639845400545, 1e-15);
  EXPECT_NEAR(normal.quantile(0.25), -0.6744897501960817, 1e-15);
  EXPECT_NEAR(normal.quantile(1e-3), -3.090232306167814, 1e-14);
  EXPECT_NEAR(normal.quantile(1e-20), -9.262340089798408, 1e-13);
}

TEST(UniformQuantile, IsLinear) {
  const Distribution uniform = Distribution::uniform(2.0);
  EXPECT_EQ(uniform.quantile(0.25), -1.0);
  EXPECT_EQ(uniform.quantile(0.5), 0.0);
  EXPECT_EQ(uniform.quantile(0.625), 0.5);
}

TEST(TriangularQuantile, IsARoot) {
  const Distribution triangular = Distribution::triangular(2.0);
  EXPECT_DOUBLE_EQ(triangular.quantile(0.125), -1.0);
  EXPECT_EQ(triangular.quantile(0.5), 0.0);
  EXPECT_DOUBLE_EQ(triangular.quantile(0.875), 1.0);
}

TEST(TruncatedNormalQuantile, IsUniformWhereTheCutIsNarrow) {
  const Distribution narrow = Distribution::truncated_normal(1.0, 1e-9);
  for (const double u : {1e-6, 0.1, 0.3, 0.5, 0.8}) {
    EXPECT_NEAR(narrow.quantile(u), 1e-9 * (2.0 * u - 1.0), 1e-24) << u;
  }
}

TEST(TruncatedNormalQuantile, IsNormalWhereTheCutIsFar) {
  const Distribution far = Distribution::truncated_normal(2.0, 100.0);
  const Distribution normal = Distribution::normal(2.0);
  for (const double u : {1e-12, 1e-3, 0.3, 0.7, 0.999}) {
    EXPECT_DOUBLE_EQ(far.quantile(u), normal.quantile(u)) << u;
  }
}

}  // namespace
}  // namespace poesy
