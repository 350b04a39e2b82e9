#include "engine/stats/mapped_gradient.h"

#include <gtest/gtest.h>

#include <array>
#include <boost/random/mersenne_twister.hpp>
#include <cmath>
#include <numbers>

#include "engine/random/weighted_points.h"
#include "tests/engine/stats/coverage.h"
#include "tests/engine/stats/yield_cases.h"

namespace poesy {
namespace {

std::vector<std::optional<MappedError>> mapped(const std::vector<Distribution>& errors) {
  std::vector<std::optional<MappedError>> list;
  for (const Distribution& error : errors) {
    list.emplace_back();
    if (error.sigma() > 0.0) continue;  // normal errors are not mapped
    std::vector<double> quantiles = ErrorRange::grid();
    error.transform(quantiles);
    const WeightedPoints points = weighted_points(error);
    list.back().emplace(
        MappedError{ErrorRange(std::move(quantiles), error.mean()), PolynomialScore(points.points, points.weights, 2)});
  }
  return list;
}

/// The mapped gradient of machines with y = sum of errors + bend (sum of the first two errors)^2. The linear map does
/// not know the bend.
MappedGradient gradient_of(const test::YieldCase& yield, double bend, std::size_t machines,
                           boost::random::mt19937_64& engine) {
  const std::size_t errors = yield.errors.size();
  std::vector<double> values(errors * machines);
  for (double& value : values) value = uniform_from_bits(engine());
  for (std::size_t p = 0; p < errors; ++p) {
    yield.errors[p].transform(std::span(values).subspan(p * machines, machines));
  }
  std::vector<std::uint8_t> rejected(machines);
  for (std::size_t b = 0; b < machines; ++b) {
    double sum = 0.0;
    for (std::size_t p = 0; p < errors; ++p) sum += values[p * machines + b];
    const double two = values[b] + values[machines + b];
    rejected[b] = static_cast<std::uint8_t>(std::abs(sum + bend * two * two) > yield.limit);
  }
  MappedGradient gradient(LinearLimits(errors, {{1, yield.limit, {0.0}, std::vector(errors, 1.0)}}),
                          mapped(yield.errors));
  gradient.add(values, rejected);
  return gradient;
}

double width(const Estimate& estimate) { return estimate.interval.high - estimate.interval.low; }

/// Expects that each 99.9 % interval contains the true gradient, and that it is at most twice as wide as the interval
/// for normal errors with the same sigma, from as many machines and their exact score.
void expect_gradient(const test::YieldCase& yield, std::uint64_t seed) {
  constexpr std::size_t kMachines = 5000;
  boost::random::mt19937_64 engine(seed);
  const MappedGradient found = gradient_of(yield, 0.0, kMachines, engine);
  EXPECT_EQ(found.misjudged(), 0u);
  std::vector<double> sigma;
  for (const Distribution& error : yield.errors) sigma.push_back(error.standard_deviation());
  const std::vector<Estimate> normal = test::normal_case(sigma, yield.limit).estimate(kMachines, 0.999, engine);
  for (std::size_t p = 0; p < yield.errors.size(); ++p) {
    if (yield.errors[p].sigma() > 0.0) continue;
    const Estimate one = found.gradient(p, 0.999);
    EXPECT_LT(one.interval.low, yield.gradient[p]) << p;
    EXPECT_GT(one.interval.high, yield.gradient[p]) << p;
    EXPECT_LT(width(one), 2.0 * width(normal[p])) << p;
  }
}

TEST(MappedGradient, HoldsTheClosedFormsOfEveryShape) {
  expect_gradient(test::uniform_case(std::array{0.1, 0.08, 0.15}, 0.32), 1);
  expect_gradient(test::uniform_case(std::array{0.1, 0.1}, 0.2), 2);
  expect_gradient(test::uniform_case(std::array{0.1, 0.1, 0.1, 0.1, 0.01}, 0.1), 3);
  expect_gradient(test::triangular_case(std::array{0.1, 0.08, 0.15}, 0.32), 4);
  const std::vector<double> skewed{-0.3, -0.29, -0.25, -0.2, -0.15, -0.1, 0.0, 0.2, 0.6, 0.9};
  expect_gradient(test::measured_case(skewed, 0.3, 0.8), 5);
}

/// One uniform error with the half-width w causes all rejects. |e| <= l w holds with the probability l, so dY/dt = -l /
/// t, and with 1.1 times the size the yield is l / 1.1. For l = 0.9973 a gradient by polynomials of degree 6 would be
/// wrong by a factor of 12.
TEST(MappedGradient, OfTheOnlyErrorIsExact) {
  for (const double l : {0.5, 0.9, 0.9973}) {
    boost::random::mt19937_64 engine(6);
    const test::YieldCase only{{Distribution::uniform(1.0), Distribution::uniform(1e-9)}, l, {0.0, 0.0}};
    const MappedGradient found = gradient_of(only, 0.0, 2000, engine);
    const double t = 1.0 / std::numbers::sqrt3;
    EXPECT_NEAR(found.gradient(0, 0.95).value, -l / t, 0.01 * l / t) << l;
    EXPECT_NEAR(found.change(0, 0.95).value, -l * (1.0 - 1.0 / 1.1), 0.002) << l;
  }
}

/// The change of the yield for a 10 % larger error, compared with the closed form.
TEST(MappedGradient, TellsTheStepAndNotTheSlope) {
  const std::vector<double> half_widths{0.2, 0.15, 0.1};
  std::vector<double> sigma;
  for (const double one : half_widths) sigma.push_back(one / std::numbers::sqrt3);
  const test::YieldCase yield = test::uniform_case(sigma, 0.3);
  boost::random::mt19937_64 engine(7);
  const MappedGradient found = gradient_of(yield, 0.0, 20000, engine);
  for (std::size_t p = 0; p < 3; ++p) {
    std::vector<double> grown = half_widths;
    grown[p] *= 1.1;
    const double expected = test::share_of_uniforms(grown, 0.3) - test::share_of_uniforms(half_widths, 0.3);
    const Estimate change = found.change(p, 0.999);
    EXPECT_LT(change.interval.low, expected) << p;
    EXPECT_GT(change.interval.high, expected) << p;
    EXPECT_LT(width(change), 0.3 * std::abs(expected)) << p;
  }
}

/// Coverage of the 95 % intervals if y is not linear in the errors. The true gradient is a central difference (sizes
/// +-2 %) of the yields of kMany machines. One-sided test with alpha = 1e-3: z must exceed -3.09. The three gradients
/// of a repetition are correlated, so only a third of the intervals is counted.
TEST(MappedGradient, CoversWhatTheMapDoesNotKnow) {
  constexpr double kBend = 0.15;
  constexpr double kLimit = 0.25;
  constexpr std::size_t kMany = 2'000'000;
  const test::YieldCase yield = test::uniform_case(std::array{0.1, 0.08, 0.05}, kLimit);
  boost::random::mt19937_64 engine(8);
  std::vector<double> u(3 * kMany);
  for (double& one : u) one = 2.0 * uniform_from_bits(engine()) - 1.0;
  const auto share = [&](std::size_t grown, double by) {
    std::array<double, 3> width{};
    for (std::size_t p = 0; p < 3; ++p) width[p] = yield.errors[p].half_width() * (p == grown ? by : 1.0);
    std::size_t good = 0;
    for (std::size_t b = 0; b < kMany; ++b) {
      const double two = width[0] * u[b] + width[1] * u[kMany + b];
      good += std::abs(two + width[2] * u[2 * kMany + b] + kBend * two * two) <= kLimit ? 1 : 0;
    }
    return static_cast<double>(good) / kMany;
  };
  std::array<double, 3> truth{};
  for (std::size_t p = 0; p < 3; ++p) {
    truth[p] = (share(p, 1.02) - share(p, 0.98)) / (0.04 * yield.errors[p].standard_deviation());
  }
  test::Coverage coverage;
  std::size_t misjudged = 0;
  constexpr int kRepetitions = 1000;
  for (int n = 0; n < kRepetitions; ++n) {
    const MappedGradient found = gradient_of(yield, kBend, 500, engine);
    misjudged += found.misjudged();
    for (std::size_t p = 0; p < 3; ++p) coverage.add(found.gradient(p, 0.95).interval, truth[p]);
  }
  EXPECT_GT(misjudged, 2u * kRepetitions);
  EXPECT_GT(coverage.z() / std::numbers::sqrt3, -3.09) << coverage.share();
}

}  // namespace
}  // namespace poesy
