#include <gtest/gtest.h>

#include <array>
#include <boost/math/quadrature/gauss.hpp>
#include <cmath>
#include <limits>
#include <stdexcept>
#include <string>
#include <vector>

#include "engine/random/distribution.h"

namespace poesy {
namespace {

constexpr double kShift = 0.4;

std::vector<Distribution> centred() {
  return {Distribution::normal(1.0), Distribution::truncated_normal(1.0, 0.5), Distribution::truncated_normal(1.0, 3.0),
          Distribution::uniform(0.7), Distribution::triangular(0.7)};
}

/// Probabilities in (0, 1), among them the nearest ones to 0, 1/2 and 1.
std::vector<double> shares() {
  std::vector<double> list{0x1p-54,       1e-9,          0.25 - 0x1p-55, 0.25, 0.5 - 0x1p-54, 0.5,
                           0.5 + 0x1p-53, 0.5 + 0x1p-52, 0.75,           0.9,  1.0 - 0x1p-53};
  for (int k = 0; k < 1201; ++k) list.push_back((k + 0.5) / 1201.0);  // more than two blocks, and part of another
  return list;
}

/// The moment E x^power, as the integral of the quantile's power over (0, 1). Gauss-Legendre in panels that become
/// finer towards 0, 1/2 and 1.
double moment(const Distribution& distribution, int power) {
  using Gauss = boost::math::quadrature::gauss<double, 20>;
  const auto value = [&](double u) { return std::pow(distribution.quantile(u), power); };
  double sum = 0.0;
  for (int panel = 1; panel < 50; ++panel) {
    const double inner = 0.25 * std::ldexp(1.0, -panel);
    for (const double end : {0.0, 0.5}) {
      sum += Gauss::integrate(value, end + inner, end + 2.0 * inner);
      sum += Gauss::integrate(value, end + 0.5 - 2.0 * inner, end + 0.5 - inner);
    }
  }
  return sum;
}

TEST(ShiftedDistribution, HasTheMomentsOfBothHalves) {
  for (const Distribution& plain : centred()) {
    const Distribution shifted = plain.shifted(kShift);
    const double variance = std::pow(plain.standard_deviation(), 2);
    EXPECT_DOUBLE_EQ(shifted.standard_deviation(), std::sqrt(variance + kShift * kShift));
    EXPECT_EQ(shifted.mean(), 0.0);
    EXPECT_NEAR(moment(shifted, 1), 0.0, 1e-12) << name(plain.shape());
    EXPECT_NEAR(moment(shifted, 2), variance + kShift * kShift, 1e-10) << name(plain.shape());
    EXPECT_NEAR(moment(shifted, 3), 0.0, 1e-12) << name(plain.shape());
    // For a symmetric x and the shift d: E(x + d)^4 = E x^4 + 6 d^2 E x^2 + d^4.
    const double fourth = moment(plain, 4) + 6.0 * kShift * kShift * variance + std::pow(kShift, 4);
    EXPECT_NEAR(moment(shifted, 4), fourth, 1e-9 * (1.0 + fourth)) << name(plain.shape());
  }
}

TEST(ShiftedDistribution, IsTheOneWithoutShiftInEachHalf) {
  for (const Distribution& plain : centred()) {
    const Distribution shifted = plain.shifted(kShift);
    for (const double u : shares()) {
      if (u == 0.5) continue;
      EXPECT_EQ(shifted.quantile(u),
                u < 0.5 ? -kShift + plain.quantile(2.0 * u) : kShift + plain.quantile(2.0 * u - 1.0));
    }
  }
}

TEST(ShiftedDistribution, IsSymmetricAndStaysWithinItsLargest) {
  for (const Distribution& plain : centred()) {
    const Distribution shifted = plain.shifted(kShift);
    EXPECT_EQ(shifted.half_width(), plain.half_width());
    EXPECT_EQ(shifted.largest(), plain.half_width() + kShift);
    for (double u : shares()) {
      EXPECT_TRUE(std::isfinite(shifted.quantile(u))) << u;
      EXPECT_LE(std::abs(shifted.quantile(u)), shifted.largest()) << u;
      u = 1.0 - (1.0 - u);  // the nearest share whose complement is exact
      if (u > 0.0 && u < 0.5) {
        EXPECT_EQ(shifted.quantile(1.0 - u), -shifted.quantile(u)) << u;
      }
    }
  }
}

TEST(ShiftedDistribution, TransformsAsItsQuantileDoes) {
  for (const Distribution& plain : centred()) {
    const Distribution shifted = plain.shifted(kShift);
    std::vector<double> values = shares();
    shifted.transform(values);
    for (std::size_t k = 0; k < values.size(); ++k) EXPECT_EQ(values[k], shifted.quantile(shares()[k]));
    const std::array scores{-3.0, -0.25, 0.5, 2.0};
    std::array<double, 4> of_scores = scores;
    shifted.transform_scores(of_scores);
    for (std::size_t k = 0; k < scores.size(); ++k) {
      EXPECT_NEAR(of_scores[k], shifted.quantile(0.5 * std::erfc(-scores[k] / std::sqrt(2.0))), 1e-12);
    }
  }
}

TEST(ShiftedDistribution, OfNoShiftIsTheSameInEveryBit) {
  for (const Distribution& plain : centred()) {
    const Distribution same = plain.shifted(0.0);
    EXPECT_EQ(same, plain);
    EXPECT_EQ(same.standard_deviation(), plain.standard_deviation());
    EXPECT_NE(plain.shifted(kShift), plain);
    EXPECT_EQ(plain.shifted(kShift).sigma(), plain.sigma());
    std::vector<double> one = shares();
    std::vector<double> other = shares();
    plain.transform(one);
    same.transform(other);
    EXPECT_EQ(one, other);
  }
}

std::string refusal(const Distribution& distribution, double shift) {
  try {
    static_cast<void>(distribution.shifted(shift));
  } catch (const std::invalid_argument& error) {
    return error.what();
  }
  return {};
}

TEST(ShiftedDistribution, RefusesImpossibleShifts) {
  constexpr double kMost = std::numeric_limits<double>::max();
  for (const double bad : {-1e-3, std::nan(""), std::numeric_limits<double>::infinity()}) {
    EXPECT_EQ(refusal(Distribution::normal(1.0), bad), "shift must be a finite number, not below zero") << bad;
  }
  EXPECT_EQ(refusal(Distribution::normal(kMost), kMost), "shift must be a finite number, not below zero");
  const Distribution measured = Distribution::measured({1.0, 2.0, 3.0, 4.0, 5.0, 6.0, 7.0, 8.0});
  EXPECT_EQ(refusal(measured, 1.0), "shift is not for measured values");
  EXPECT_EQ(refusal(measured, 0.0), "");
}

}  // namespace
}  // namespace poesy
