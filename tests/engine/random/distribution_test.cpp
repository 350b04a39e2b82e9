#include "engine/random/distribution.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <stdexcept>
#include <string>

namespace poesy {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();
constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();

/// What a constructor says about a value it refuses; empty when it accepts it.
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

TEST(NormalQuantile, MatchesTabulatedValues) {
  // Abramowitz and Stegun, Table 26.5, and Wichura 1988 (AS 241) for the far tail.
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
