#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <numbers>
#include <random>
#include <vector>

#include "engine/random/distribution.h"

namespace poesy {
namespace {

constexpr long double kRoot2 = std::numbers::sqrt2_v<long double>;

/// The probability of values below x <= 0, and the density at x. Both are computed from the definitions in long double.
struct Law {
  long double share;
  long double density;
};

long double normal_density(long double x) {
  return std::exp(-0.5L * x * x) * std::numbers::inv_sqrtpi_v<long double> / kRoot2;
}

Law lower_half(const Distribution& d, long double x) {
  const auto sigma = static_cast<long double>(d.sigma());
  const auto width = static_cast<long double>(d.half_width());
  switch (d.shape()) {
    case Distribution::Shape::normal:
      return {0.5L * std::erfc(-x / sigma / kRoot2), normal_density(x / sigma) / sigma};
    case Distribution::Shape::truncated_normal: {
      const long double inside = std::erf(width / sigma / kRoot2);
      // Two equal formulas; the one without cancellation for this cut is used.
      const long double below = width < sigma
                                    ? 0.5L * (inside - std::erf(-x / sigma / kRoot2))
                                    : 0.5L * (std::erfc(-x / sigma / kRoot2) - std::erfc(width / sigma / kRoot2));
      return {below / inside, normal_density(x / sigma) / sigma / inside};
    }
    case Distribution::Shape::uniform:
      return {0.5L * (width + x) / width, 0.5L / width};
    case Distribution::Shape::triangular:
      return {0.5L * (width + x) * (width + x) / (width * width), (width + x) / (width * width)};
    case Distribution::Shape::measured:
    case Distribution::Shape::given:
      break;
  }
  return {};
}

std::vector<Distribution> all_shapes() {
  return {Distribution::normal(1.0),
          Distribution::normal(3e-5),
          Distribution::truncated_normal(1.0, 1e-6),
          Distribution::truncated_normal(1.0, 0.1),
          Distribution::truncated_normal(1.0, 0.9),
          Distribution::truncated_normal(2.0, 4.0),
          Distribution::truncated_normal(1.0, 6.0),
          Distribution::truncated_normal(1.0, 50.0),
          Distribution::uniform(0.7),
          Distribution::triangular(0.7)};
}

/// Probabilities in (0, 1/2], dense near both ends.
std::vector<double> lower_shares() {
  std::vector<double> shares;
  for (int power = 2; power <= 54; ++power) {
    for (int step = 0; step < 64; ++step) shares.push_back(std::ldexp(1.0 + step / 64.0, -power));
  }
  for (int power = 3; power <= 54; ++power) shares.push_back(0.5 - std::ldexp(1.0, -power));
  shares.push_back(0.5);
  return shares;
}

TEST(Quantile, InvertsTheDistributionToRounding) {
  constexpr long double kUlp = std::numeric_limits<double>::epsilon();
  for (const Distribution& d : all_shapes()) {
    for (const double u : lower_shares()) {
      const double x = d.quantile(u);
      const Law law = lower_half(d, x);
      // Allows four rounding errors of u and of x. Those of x change the probability by the density at x.
      const long double tolerance = 4.0L * kUlp * (u + std::abs(x) * law.density);
      EXPECT_LE(std::abs(law.share - u), tolerance)
          << name(d.shape()) << " " << d.sigma() << " " << d.half_width() << " at " << u;
    }
  }
}

TEST(Quantile, NormalSharesComeBackToFourteenDigits) {
  const Distribution normal = Distribution::normal(1.0);
  for (const double u : lower_shares()) {
    const long double back = 0.5L * std::erfc(-static_cast<long double>(normal.quantile(u)) / kRoot2);
    EXPECT_LE(std::abs(back / u - 1.0L), 3e-14L) << u;
  }
}

/// The quantile x <= 0 of the standard normal for the probability `share`, by Halley's iteration in long double. start:
/// an approximation.
long double exact_normal_quantile(double share, double start) {
  long double x = start;
  for (int k = 0; k < 3; ++k) {
    const long double step = (0.5L * std::erfc(-x / kRoot2) - share) / normal_density(x);
    x -= step / (1.0L + 0.5L * x * step);
  }
  return x;
}

TEST(Quantile, NormalIsWithinAFewUnitsInTheLastPlace) {
  const Distribution normal = Distribution::normal(1.0);
  std::mt19937_64 engine(14);
  double sum = 0.0;
  constexpr int kDraws = 200000;
  for (int k = 0; k < kDraws; ++k) {
    // Probabilities that are alternately uniform, as in streams, and spread over all powers of two down to the smallest
    // draw.
    const double share = std::max(0x1p-54, 0.5 * std::generate_canonical<double, 53>(engine));
    const double u = k % 2 == 0 ? share : std::max(0x1p-54, std::ldexp(share, -(k / 2 % 53)));
    const double x = normal.quantile(u);
    const double unit = std::abs(x) - std::nextafter(std::abs(x), 0.0);
    const double error = static_cast<double>(std::abs(x - exact_normal_quantile(u, x))) / unit;
    EXPECT_LE(error, u < 0.075 ? 4.0 : 6.0) << u;
    sum += error;
  }
  EXPECT_LE(sum / kDraws, 0.7);
}

TEST(Quantile, NormalHasNoStepWhereItsFormulasMeet) {
  const Distribution normal = Distribution::normal(1.0);
  for (const double seam : {0x1p-54, 0.075}) {
    double u = seam * (1.0 - 0x1p-48);
    double last = normal.quantile(u);
    for (int k = 0; k < 64; ++k) {
      u = std::nextafter(u, 1.0);
      const double x = normal.quantile(u);
      // A change of u by one unit in the last place changes x by less than this tolerance; the rest is for rounding.
      EXPECT_NEAR(x, last, 6.0 * std::numeric_limits<double>::epsilon() * std::abs(x)) << seam << " " << k;
      last = x;
    }
  }
}

TEST(Quantile, TailsMirrorEachOtherExactly) {
  for (const Distribution& d : all_shapes()) {
    for (double u : lower_shares()) {
      u = 1.0 - (1.0 - u);  // the nearest share whose complement is exact
      if (u > 0.0) {
        EXPECT_EQ(d.quantile(1.0 - u), -d.quantile(u)) << name(d.shape()) << " at " << u;
      }
    }
  }
}

TEST(Quantile, RisesAndStaysWithinTheHalfWidth) {
  for (const Distribution& d : all_shapes()) {
    double last = -std::numeric_limits<double>::infinity();
    for (int k = 0; k < 4096; ++k) {
      const double x = d.quantile((k + 0.5) / 4096.0);
      EXPECT_GT(x, last) << name(d.shape()) << " at step " << k;
      EXPECT_LE(std::abs(x), d.half_width());
      last = x;
    }
    EXPECT_GE(d.quantile(0x1p-54), -d.half_width());
    EXPECT_LE(d.quantile(1.0 - 0x1p-53), d.half_width());
    EXPECT_TRUE(std::isfinite(d.quantile(0x1p-54)));
  }
}

TEST(Transform, EqualsTheQuantileOfEachValue) {
  for (const Distribution& d : all_shapes()) {
    std::vector<double> shares{0x1p-54, 0.01, 0.075, 0.3, 0.5, 0.77, 0.925, 1.0 - 0x1p-53};
    for (int k = 0; k < 1001; ++k) shares.push_back((k + 0.5) / 1001.0);  // more than a block, and part of another
    std::vector<double> values = shares;
    d.transform(values);
    for (std::size_t k = 0; k < shares.size(); ++k) EXPECT_EQ(values[k], d.quantile(shares[k]));
  }
}

TEST(Transform, TakesSharesBelowAllDraws) {
  for (const Distribution& d : all_shapes()) {
    std::vector<double> shares(700, 0.01);
    for (const std::size_t place : {std::size_t{3}, std::size_t{699}}) shares[place] = 1e-300;
    shares[4] = 0x1p-55;
    std::vector<double> values = shares;
    d.transform(values);
    for (std::size_t k = 0; k < shares.size(); ++k) EXPECT_EQ(values[k], d.quantile(shares[k]));
  }
}

TEST(StandardDeviation, OfATruncatedNormalIsThatOfItsDensity) {
  // The second moment divided by the mass, in units of the cut, by Simpson's rule with 4000 panels in long double.
  for (const double a : {1e-9, 1e-4, 0.1, 0.5, 0.999, 1.0, 1.001, 2.0, 3.0, 6.0, 12.0}) {
    long double mass = 0.0L;
    long double second = 0.0L;
    for (int k = 0; k <= 4000; ++k) {
      const long double x = k / 4000.0L;
      const long double weight = (k == 0 || k == 4000 ? 1.0L : (k % 2 == 1 ? 4.0L : 2.0L)) * normal_density(a * x);
      mass += weight;
      second += weight * x * x;
    }
    const double sigma = 0.3;
    const double expected = sigma * a * static_cast<double>(std::sqrt(second / mass));
    const Distribution d = Distribution::truncated_normal(sigma, sigma * a);
    EXPECT_NEAR(d.standard_deviation(), expected, 2e-15 * expected) << "half_width / sigma = " << a;
  }
}

}  // namespace
}  // namespace poesy
