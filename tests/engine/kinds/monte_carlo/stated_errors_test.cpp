// Machines whose errors have a mean or are drawn anew at each pose. Yields and gradients are compared with closed
// forms.

#include <gtest/gtest.h>

#include <array>
#include <boost/math/quadrature/gauss.hpp>
#include <cmath>
#include <functional>
#include <vector>

#include "engine/kinds/monte_carlo/kind.h"
#include "engine/kinds/monte_carlo/result.h"
#include "engine/run/run_options.h"
#include "tests/support/function_model.h"
#include "tests/support/kinds.h"

namespace poesy::monte_carlo {
namespace {

constexpr std::array<double, 3> kSlopes{1.0, 2.0, 0.5};
constexpr double kLimit = 0.3;
constexpr double kErrors = 4.4;  // standard errors; alpha 1e-5, so below 1e-3 for all comparisons here

/// y = a . e with a = kSlopes, the same at each pose.
test::FunctionModel linear_model() {
  return {3, {"y"}, [](std::span<const double> errors, double, std::span<double> responses) {
            responses[0] = 0.0;
            for (std::size_t p = 0; p < 3; ++p) responses[0] += kSlopes[p] * errors[p];
          }};
}

struct MachineCase {
  test::FunctionModel model = linear_model();
  CatalogEntry entry{model.description(), nullptr};
  Study study = test::function_study(entry, kStudy, Distribution::normal(0.1), 40'500);

  explicit MachineCase(std::size_t poses) {
    study.poses.count = poses;
    study.poses.workspace = {{0.1, 0.9}};
    study.analysis.draws = Draws::per_machine;
    study.analysis.limits = {{0, kLimit}};
    asked_of<Options>(study.analysis).judge = Judge::yield;
    study.seed = 5;
    set_sigmas({0.1, 0.05, 0.2});
  }

  void set_sigmas(const std::array<double, 3>& sigma) {
    for (std::size_t p = 0; p < 3; ++p) study.errors.by_factor[p] = Distribution::normal(sigma[p]);
  }

  Result run(std::size_t threads = 2) const {
    RunOptions options;
    options.threads = threads;
    return run_monte_carlo(Plan(study, select_poses(study.poses, model).poses), model, study.analysis, options).value();
  }
};

double normal_below(double z) { return 0.5 * std::erfc(-z / std::sqrt(2.0)); }

/// The probability that a variable N(mean, sigma^2) is within the limit.
double share_within(double mean, double sigma) {
  return normal_below((kLimit - mean) / sigma) - normal_below((-kLimit - mean) / sigma);
}

/// The derivative of f at x by central differences of fourth order.
double slope(const std::function<double(double)>& f, double x) {
  const double step = 1e-4 * x;
  return (8.0 * (f(x + step) - f(x - step)) - (f(x + 2.0 * step) - f(x - 2.0 * step))) / (12.0 * step);
}

void expect_yield(const YieldResult& found, double expected) {
  const auto n = static_cast<double>(found.machines);
  EXPECT_NEAR(found.value, expected, kErrors * std::sqrt(expected * (1.0 - expected) / n));
  EXPECT_LT(found.ci_low, found.value);
  EXPECT_GT(found.ci_high, found.value);
}

/// Expects the gradient by error p. widest: largest half-width of the interval, relative to the expected gradient.
void expect_gradient(const YieldResult& found, std::size_t p, double expected, double widest) {
  const double half = 0.5 * (found.gradient_ci_high(p) - found.gradient_ci_low(p));
  EXPECT_NEAR(found.gradient(p), expected, half * kErrors / 1.96) << p;
  EXPECT_LT(half, widest * std::abs(expected)) << p;
}

TEST(StatedMean, MovesTheYieldOfNormalMachines) {
  MachineCase one(2);
  constexpr std::array kMean{0.12, -0.02, 0.08};
  const std::array kSigma{0.1, 0.05, 0.2};
  double mean = 0.0;
  for (std::size_t p = 0; p < 3; ++p) {
    one.study.errors.by_factor[p] = Distribution::normal(kSigma[p]).about(kMean[p]);
    mean += kSlopes[p] * kMean[p];
  }
  const Result found = one.run();
  const auto yield_at = [&](std::size_t p, double sigma) {
    std::array<double, 3> sizes = kSigma;
    sizes[p] = sigma;
    return share_within(mean, std::hypot(kSlopes[0] * sizes[0], kSlopes[1] * sizes[1], kSlopes[2] * sizes[2]));
  };
  expect_yield(*found.machines->yield, yield_at(0, kSigma[0]));
  for (std::size_t p = 0; p < 3; ++p) {
    expect_gradient(*found.machines->yield, p, slope([&](double sigma) { return yield_at(p, sigma); }, kSigma[p]), 0.2);
    EXPECT_NEAR(found.effects.effects.s1(0, p), 1.0 / 3.0, 0.02);
    EXPECT_NEAR(found.machines->yield->mean_square_share(0, p), 1.0 / 3.0, 0.02);
  }
  const double sigma = 0.1 * std::sqrt(3.0);
  EXPECT_NEAR(found.mean(0, 0), mean, kErrors * sigma / std::sqrt(40'500.0));
  EXPECT_NEAR(found.machines->yield->linear_share(0), 1.0, 1e-9);
}

/// Twelve measured values with this mean and this standard deviation.
std::vector<double> parts(double mean, double sigma) {
  std::vector<double> values;
  const double unit = std::sqrt(13.0);  // standard deviation (n - 1) of twelve consecutive numbers
  for (int k = 0; k < 12; ++k) values.push_back(mean + sigma * (k - 5.5) / unit);
  return values;
}

/// The means of the measured errors partly cancel each other in the response. The shares refer only to the scatter of
/// the response; its mean is stated separately.
TEST(MeasuredErrors, ShareTheScatterWithoutTheirMeans) {
  MachineCase one(1);
  constexpr std::array kMean{0.3, -0.1, -0.05};
  const std::array kSigma{0.1, 0.05, 0.1};
  double mean = 0.0;
  double variance = 0.0;
  for (std::size_t p = 0; p < 3; ++p) {
    one.study.errors.by_factor[p] = Distribution::measured(parts(kMean[p], kSigma[p]));
    mean += kSlopes[p] * kMean[p];
    variance += std::pow(kSlopes[p] * kSigma[p], 2);
  }
  const Result found = one.run();
  const YieldResult& yield = *found.machines->yield;
  for (std::size_t p = 0; p < 3; ++p) {
    EXPECT_NEAR(yield.mean_square_share(0, p), std::pow(kSlopes[p] * kSigma[p], 2) / variance, 1e-6) << p;
  }
  EXPECT_NEAR(yield.offset(0), std::abs(mean), 1e-6);
  EXPECT_NEAR(yield.offset_share(0), mean * mean / (mean * mean + variance), 1e-6);
  const double standard_error = std::sqrt(variance / 40'500.0);
  EXPECT_NEAR(found.mean(0, 0), mean, kErrors * standard_error);
  const double square = std::pow(found.rms(0, 0), 2);
  EXPECT_NEAR(yield.offset_share(0), std::pow(found.mean(0, 0), 2) / square, 0.02);
}

TEST(StatedMean, MovesCorrelatedErrors) {
  MachineCase one(1);
  constexpr std::array kMean{0.1, 0.03, -0.1};
  const std::array kSigma{0.1, 0.05, 0.2};
  constexpr double kCorrelation = 0.6;
  double mean = 0.0;
  for (std::size_t p = 0; p < 3; ++p) {
    one.study.errors.by_factor[p] = Distribution::normal(kSigma[p]).about(kMean[p]);
    mean += kSlopes[p] * kMean[p];
  }
  one.study.errors.correlated = {{{FactorIndex(0), FactorIndex(1)}, {1.0, kCorrelation, kCorrelation, 1.0}}};
  const Result found = one.run();
  const auto yield_at = [&](std::size_t p, double sigma) {
    std::array<double, 3> sizes = kSigma;
    sizes[p] = sigma;
    double variance = 2.0 * kCorrelation * kSlopes[0] * kSlopes[1] * sizes[0] * sizes[1];
    for (std::size_t q = 0; q < 3; ++q) variance += std::pow(kSlopes[q] * sizes[q], 2);
    return share_within(mean, std::sqrt(variance));
  };
  expect_yield(*found.machines->yield, yield_at(0, kSigma[0]));
  for (std::size_t p = 0; p < 3; ++p) {
    expect_gradient(*found.machines->yield, p, slope([&](double sigma) { return yield_at(p, sigma); }, kSigma[p]), 0.3);
  }
}

/// The probability that mean + u1 + u2 + u3 is within the limit, for uniform terms u_p with the half-widths w_p.
/// Computed as the volume of a box on one side of a plane, by inclusion and exclusion of the corners.
double uniform_share(const std::array<double, 3>& w, double mean) {
  const auto below = [&](double y) {
    double sum = 0.0;
    for (unsigned corner = 0; corner < 8; ++corner) {
      double at = y - mean;
      double sign = 1.0;
      for (std::size_t p = 0; p < 3; ++p) {
        const bool is_upper = (corner >> p & 1U) != 0;
        at += is_upper ? -w[p] : w[p];
        sign *= is_upper ? -1.0 : 1.0;
      }
      sum += sign * std::pow(std::max(0.0, at), 3);
    }
    return sum / (6.0 * 8.0 * w[0] * w[1] * w[2]);
  };
  return below(kLimit) - below(-kLimit);
}

TEST(StatedMean, MovesTheYieldOfUniformMachines) {
  MachineCase one(2);
  constexpr std::array kMean{0.1, 0.05, -0.04};
  const std::array kHalf{0.18, 0.08, 0.3};
  double mean = 0.0;
  for (std::size_t p = 0; p < 3; ++p) {
    one.study.errors.by_factor[p] = Distribution::uniform(kHalf[p]).about(kMean[p]);
    mean += kSlopes[p] * kMean[p];
  }
  const Result found = one.run();
  const auto yield_at = [&](std::size_t p, double half) {
    std::array<double, 3> w = kHalf;
    w[p] = half;
    for (std::size_t q = 0; q < 3; ++q) w[q] *= kSlopes[q];
    return uniform_share(w, mean);
  };
  expect_yield(*found.machines->yield, yield_at(0, kHalf[0]));
  for (std::size_t p = 0; p < 3; ++p) {  // the gradient is by the standard deviation
    const double expected = slope([&](double half) { return yield_at(p, half); }, kHalf[p]) * std::sqrt(3.0);
    expect_gradient(*found.machines->yield, p, expected, 0.1);
  }
}

/// The yield if e1 is drawn once for a machine, but e2 and e3 anew at each pose: E[P(good at a pose | e1)^poses].
double repeated_yield(const std::array<double, 3>& sigma, std::size_t poses) {
  const double anew = std::hypot(kSlopes[1] * sigma[1], kSlopes[2] * sigma[2]);
  const auto of_fixed = [&](double z) {
    return std::exp(-0.5 * z * z) / std::sqrt(2.0 * std::numbers::pi) *
           std::pow(share_within(kSlopes[0] * sigma[0] * z, anew), static_cast<double>(poses));
  };
  double sum = 0.0;
  for (int k = -32; k < 32; ++k)
    sum += boost::math::quadrature::gauss<double, 20>::integrate(of_fixed, 0.25 * k, 0.25 * (k + 1));
  return sum;
}

TEST(DrawnPerPose, GivesTheYieldAndItsGradient) {
  constexpr std::size_t kPoses = 6;
  MachineCase one(kPoses);
  const std::array kSigma{0.1, 0.04, 0.1};
  one.set_sigmas(kSigma);
  one.study.errors.per_pose = {FactorIndex(1), FactorIndex(2)};
  const Result found = one.run();
  const YieldResult& yield = *found.machines->yield;
  expect_yield(yield, repeated_yield(kSigma, kPoses));
  for (std::size_t p = 0; p < 3; ++p) {
    const auto yield_at = [&](double sigma) {
      std::array<double, 3> sizes = kSigma;
      sizes[p] = sigma;
      return repeated_yield(sizes, kPoses);
    };
    const double expected = slope(yield_at, kSigma[p]);
    expect_gradient(yield, p, expected, 0.1);
    const double change = yield_at(1.1 * kSigma[p]) - yield_at(kSigma[p]);
    EXPECT_NEAR(yield.change(p), change, 0.2 * std::abs(change)) << p;
  }
}

TEST(DrawnPerPose, HasTheSharesOfItsScatter) {
  MachineCase one(4);
  one.study.errors.per_pose = {FactorIndex(1)};
  const Result found = one.run();
  for (std::size_t p = 0; p < 3; ++p) {
    EXPECT_NEAR(found.effects.effects.s1(0, p), 1.0 / 3.0, 0.02) << p;
    EXPECT_NEAR(found.machines->yield->mean_square_share(0, p), 1.0 / 3.0, 0.02) << p;
    const bool has_curve = !std::isnan(found.effects.effects.mean(0, p, 0));
    EXPECT_EQ(has_curve, p != 1) << p;
    EXPECT_EQ(std::isnan(found.machines->effects_on_largest.s1(0, p)), p == 1) << p;
  }
  EXPECT_NEAR(found.machines->yield->linear_share(0), 1.0, 1e-9);
}

TEST(DrawnPerPose, KeepsBlocksOfCorrelatedErrors) {
  constexpr std::size_t kPoses = 3;
  MachineCase one(kPoses);
  const std::array kSigma{0.1, 0.04, 0.16};
  constexpr double kCorrelation = -0.5;
  one.set_sigmas(kSigma);
  one.study.errors.per_pose = {FactorIndex(1), FactorIndex(2)};
  one.study.errors.correlated = {{{FactorIndex(1), FactorIndex(2)}, {1.0, kCorrelation, kCorrelation, 1.0}}};
  const Result found = one.run();
  const auto yield_at = [&](std::size_t p, double sigma) {
    std::array<double, 3> s = kSigma;
    s[p] = sigma;
    const double a = kSlopes[1] * s[1];
    const double b = kSlopes[2] * s[2];
    const double anew = std::sqrt(a * a + b * b + 2.0 * kCorrelation * a * b);
    return repeated_yield({s[0], anew / kSlopes[1], 1e-12}, kPoses);
  };
  expect_yield(*found.machines->yield, yield_at(1, kSigma[1]));
  for (std::size_t p = 0; p < 3; ++p) {
    expect_gradient(*found.machines->yield, p, slope([&](double sigma) { return yield_at(p, sigma); }, kSigma[p]),
                    0.35);
  }
}

TEST(DrawnPerPose, ChangesNothingWithOnePose) {
  MachineCase one(1);
  const Result fixed = one.run();
  one.study.errors.per_pose = {FactorIndex(0), FactorIndex(1), FactorIndex(2)};
  const Result anew = one.run();
  EXPECT_EQ(anew.machines->yield->rejects, fixed.machines->yield->rejects);
  EXPECT_EQ(anew.mean, fixed.mean);
  EXPECT_EQ(anew.machines->yield->gradient, fixed.machines->yield->gradient);
  EXPECT_EQ(anew.machines->yield->gradient_ci_low, fixed.machines->yield->gradient_ci_low);
}

TEST(DrawnPerPose, HasTheSameBitsForAnyThreads) {
  MachineCase one(5);
  one.study.analysis.samples = 5'300;
  one.study.errors.per_pose = {FactorIndex(2)};
  const Result a = one.run(1);
  const Result b = one.run(2);
  EXPECT_EQ(a.machines->yield->gradient, b.machines->yield->gradient);
  EXPECT_EQ(a.machines->yield->mean_square_share, b.machines->yield->mean_square_share);
  EXPECT_EQ(a.effects.effects.s1, b.effects.effects.s1);
}

}  // namespace
}  // namespace poesy::monte_carlo
