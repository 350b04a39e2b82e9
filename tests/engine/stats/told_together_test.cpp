#include "engine/stats/told_together.h"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <cstdint>
#include <functional>
#include <limits>
#include <random>
#include <span>
#include <utility>
#include <vector>

#include "engine/base/nan.h"
#include "engine/random/weighted_points.h"
#include "engine/stats/yield_gradient.h"

namespace poesy {
namespace {

constexpr Interval kNoBounds{-1.0, 1.0};
constexpr double kFreedom = 1e6;  // so Student's quantiles are those of the normal: 1.96 at 95 %, 2.241 at 97.5 %

/// told_together() of estimates whose spread is not known where the quantity is zero.
std::vector<bool> told(std::span<const Estimate> estimates, const Interval& bounds, double freedom, double conf_level) {
  return told_together(estimates, bounds, freedom, std::vector(estimates.size(), 0.0), conf_level);
}

Estimate symmetric(double value, double half) { return {value, {value - half, value + half}}; }

TEST(ToldTogether, IsHolm) {
  // Of three effects, the most certain one is tested at 1 - 0.05/3 (z = 2.394), the next at 97.5 % (2.241), the last at
  // 95 % (1.960).
  const auto told_of = [](double a, double b, double c) {
    std::vector<Estimate> estimates;
    for (const double z : {a, b, c}) estimates.push_back(symmetric(0.01 * z, 0.01 * 1.95996));
    return told(estimates, kNoBounds, kFreedom, 0.95);
  };
  EXPECT_EQ(told_of(2.40, 2.25, 1.97), (std::vector{true, true, true}));
  EXPECT_EQ(told_of(1.97, -2.40, 2.25), (std::vector{true, true, true}));
  EXPECT_EQ(told_of(2.40, 2.25, 1.95), (std::vector{true, true, false}));
  EXPECT_EQ(told_of(2.40, 2.23, 1.97), (std::vector{true, false, false}));  // stops at the first that fails
  EXPECT_EQ(told_of(2.38, 2.38, 2.38), (std::vector{false, false, false}));
}

TEST(ToldTogether, IsTheIntervalOfOne) {
  EXPECT_TRUE(told(std::array{symmetric(0.1, 0.099)}, kNoBounds, 30.0, 0.95)[0]);
  EXPECT_FALSE(told(std::array{symmetric(0.1, 0.101)}, kNoBounds, 30.0, 0.95)[0]);
  EXPECT_FALSE(told(std::array{Estimate{0.1, {kNaN, kNaN}}}, kNoBounds, 30.0, 0.95)[0]);
  EXPECT_FALSE(told(std::array{symmetric(0.1, 0.01)}, kNoBounds, 0.0, 0.95)[0]);
  EXPECT_FALSE(told(std::array{Estimate{0.0, {0.0, 0.0}}}, kNoBounds, 30.0, 0.95)[0]);
}

TEST(ToldTogether, DoesNotCountWhatIsNotTested) {
  std::vector<Estimate> estimates(50, {kNaN, {kNaN, kNaN}});
  estimates[7] = symmetric(0.0197, 0.0196);
  EXPECT_TRUE(told(estimates, kNoBounds, kFreedom, 0.95)[7]);
}

/// The verdict agrees with the skewed interval of the same data at the level of Holm's first step.
TEST(ToldTogether, FollowsSkewedIntervalsAtAnotherLevel) {
  std::mt19937_64 random(3);
  std::uniform_real_distribution<double> uniform(0.0, 1.0);
  constexpr std::size_t kOthers = 20;
  int certain = 0;
  for (int n = 0; n < 2000; ++n) {
    PowerSums powers;
    const double mean = 0.6 * uniform(random) - 0.35;
    for (int k = 0; k < 40; ++k) powers.add(mean - std::log(uniform(random)) - 1.0);  // skewed
    const auto at = [&](double level) { return skewed_mean(powers, 40, {0.0, 0.0}, 39.0, level); };
    std::vector<Estimate> estimates(kOthers, symmetric(0.0, 1.0));
    estimates[0] = at(0.95);
    const Interval strict = at(1.0 - 0.05 / kOthers).interval;
    const bool found = told(estimates, {-1e9, 1e9}, 39.0, 0.95)[0];
    certain += found ? 1 : 0;
    if (found) {
      EXPECT_TRUE(strict.low > -1e-12 || strict.high < 1e-12) << n;
    }
    // If the end of the interval that faces zero is on the side of the short tail, both verdicts are equal.
    const bool short_tail =
        estimates[0].interval.high - estimates[0].value < estimates[0].value - estimates[0].interval.low;
    if (estimates[0].value > 0.0 ? short_tail : !short_tail) {
      EXPECT_EQ(found, estimates[0].value > 0.0 ? strict.low >= 0.0 : strict.high <= 0.0) << n;
    }
  }
  EXPECT_GT(certain, 50);
}

TEST(ToldTogether, TakesTheOtherSideWhereAnEndIsAtABound) {
  // The lower end was moved to the bound. If only this end were used, the interval would look too narrow and the effect
  // certain.
  std::vector<Estimate> estimates(64, symmetric(0.0, 1.0));
  estimates[0] = {-0.0079, {-0.008, -0.0001}};
  EXPECT_FALSE(told(estimates, {-0.008, 0.992}, kFreedom, 0.95)[0]);
}

/// Each table has 64 effects that are truly zero. At most 5 % of the tables may call one of them certain (alpha = 1e-6
/// for 4000 tables).
TEST(ToldTogether, KeepsTheLevelOfAllTogether) {
  std::mt19937_64 random(11);
  std::normal_distribution<double> normal;
  constexpr int kTables = 4000;
  int wrong = 0;
  int single = 0;
  for (int n = 0; n < kTables; ++n) {
    std::vector<Estimate> estimates;
    for (int p = 0; p < 64; ++p) estimates.push_back(symmetric(1e-3 * normal(random), 1e-3 * 1.95996));
    for (int p = 0; p < 3; ++p) estimates.push_back(symmetric(-0.05, 1e-3 * 1.95996));  // three large effects
    const std::vector<bool> found = told(estimates, kNoBounds, kFreedom, 0.95);
    EXPECT_TRUE(found[64] && found[65] && found[66]);
    wrong += std::find(found.begin(), found.begin() + 64, true) != found.begin() + 64 ? 1 : 0;
    single += std::any_of(estimates.begin(), estimates.begin() + 64,
                          [](const Estimate& one) { return one.interval.low > 0.0 || one.interval.high < 0.0; });
  }
  const double noise = 4.9 * std::sqrt(0.05 * 0.95 / kTables);
  EXPECT_LE(wrong, kTables * (0.05 + noise));
  EXPECT_GE(wrong, kTables * (0.04 - noise));  // the level is nearly used up
  EXPECT_GT(single, kTables * 0.9);            // by the single intervals
}

/// The estimates of 50 errors without effect on the yield of 1000 machines. score: the score of each error. draw: draws
/// an error. rejects: number of rejects among the machines.
ScoreSums without_effect(const ErrorScore& score, const std::function<double()>& draw, std::size_t rejects) {
  constexpr std::size_t kErrors = 50;
  constexpr std::size_t kMachines = 1000;
  std::vector<double> errors(kErrors * kMachines);
  std::vector<std::uint8_t> rejected(kMachines);
  for (std::size_t n = 0; n < rejects; ++n) {
    rejected[n] = 1;
    for (std::size_t p = 0; p < kErrors; ++p) errors[kMachines * p + n] = draw();
  }
  ScoreSums sums({std::vector<ErrorScore>(kErrors, score)});
  sums.add(errors, rejected);
  return sums;
}

/// At most 5 % of tables of errors without effect may call one of them certain (alpha = 1e-6 for 400 tables). The
/// intervals alone call one certain in many more tables with few rejects, because by chance the scores of all rejects
/// may be near the smallest score.
TEST(ToldTogether, KeepsTheLevelWithFewRejects) {
  constexpr int kTables = 400;
  std::mt19937_64 random(5);
  std::normal_distribution<double> normal;
  std::uniform_real_distribution<double> uniform(-1.0, 1.0);
  const auto within_two = [&] {
    double z = normal(random);
    while (std::abs(z) > 2.0) z = normal(random);
    return z;
  };
  const Distribution flat = Distribution::uniform(1.0);
  const auto points = weighted_points(flat);
  const std::vector<std::pair<ErrorScore, std::function<double()>>> errors{
      {NormalScore{1.0, std::numeric_limits<double>::infinity()}, [&] { return normal(random); }},
      {NormalScore{1.0, 2.0}, within_two},
      {PolynomialScore(points.points, points.weights), [&] { return uniform(random); }}};
  int by_intervals = 0;
  for (const auto& [score, draw] : errors) {
    for (const std::size_t rejects : {12, 20, 50, 110}) {
      int wrong = 0;
      for (int n = 0; n < kTables; ++n) {
        const ScoreSums sums = without_effect(score, draw, rejects);
        const std::vector<Estimate> changes = sums.change(0.95);
        const auto freedom = static_cast<double>(rejects) - 1.0;
        const std::vector<bool> found =
            told_together(changes, kNoBounds, freedom, sums.change_sd_without_effect(), 0.95);
        wrong += std::ranges::find(found, true) != found.end() ? 1 : 0;
        const std::vector<bool> alone = told(changes, kNoBounds, freedom, 0.95);
        by_intervals += std::ranges::find(alone, true) != alone.end() ? 1 : 0;
      }
      EXPECT_LE(wrong, kTables * (0.05 + 4.9 * std::sqrt(0.05 * 0.95 / kTables))) << score.index() << " " << rejects;
    }
  }
  EXPECT_GT(by_intervals, 12 * kTables * 0.15);
}

}  // namespace
}  // namespace poesy
