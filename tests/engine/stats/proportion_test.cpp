#include "engine/stats/proportion.h"

#include <gtest/gtest.h>

#include <cmath>

namespace poesy {
namespace {

double binomial(std::uint64_t k, std::uint64_t n, double p) {
  const auto x = static_cast<double>(k);
  const auto m = static_cast<double>(n);
  const double choices = std::lgamma(m + 1.0) - std::lgamma(x + 1.0) - std::lgamma(m - x + 1.0);
  return std::exp(choices + x * std::log(p) + (m - x) * std::log1p(-p));
}

TEST(Proportion, HasTheReferenceLimits) {
  EXPECT_NEAR(proportion_at_most(200, 100000, 0.95), 0.00224846, 5e-9);
  EXPECT_NEAR(proportion_at_most(0, 1000, 0.95), 0.00299125, 5e-9);
  const Estimate half = proportion(10, 20, 0.95);  // from tables of Clopper and Pearson
  EXPECT_EQ(half.value, 0.5);
  EXPECT_NEAR(half.interval.low, 0.2719578, 5e-8);
  EXPECT_NEAR(half.interval.high, 0.7280422, 5e-8);
}

TEST(Proportion, LeavesOutItsTails) {
  constexpr std::uint64_t kTrials = 30;
  for (std::uint64_t k = 1; k < kTrials; ++k) {
    const Interval limits = proportion(k, kTrials, 0.9).interval;
    double up_to = 0.0;  // P(X <= k) at the upper limit
    double from = 0.0;   // P(X >= k) at the lower limit
    for (std::uint64_t j = 0; j <= k; ++j) up_to += binomial(j, kTrials, limits.high);
    for (std::uint64_t j = k; j <= kTrials; ++j) from += binomial(j, kTrials, limits.low);
    EXPECT_NEAR(up_to, 0.05, 1e-10) << k;
    EXPECT_NEAR(from, 0.05, 1e-10) << k;
  }
}

TEST(Proportion, CoversEveryShare) {
  constexpr std::uint64_t kTrials = 40;
  for (double p = 0.005; p < 1.0; p += 0.01) {
    double coverage = 0.0;
    for (std::uint64_t k = 0; k <= kTrials; ++k) {
      const Interval limits = proportion(k, kTrials, 0.95).interval;
      if (limits.low <= p && p <= limits.high) coverage += binomial(k, kTrials, p);
    }
    EXPECT_GE(coverage, 0.95) << p;
  }
}

TEST(Proportion, IsTheSameForBothWays) {
  for (const std::uint64_t k : {0U, 1U, 17U, 999U, 1000U}) {
    EXPECT_NEAR(proportion_at_least(k, 1000, 0.99), 1.0 - proportion_at_most(1000 - k, 1000, 0.99), 1e-14) << k;
  }
}

TEST(Proportion, OfAllOrNothingHasOneLimit) {
  EXPECT_EQ(proportion(0, 50, 0.95).interval.low, 0.0);
  EXPECT_EQ(proportion(50, 50, 0.95).interval.high, 1.0);
  EXPECT_NEAR(proportion_at_most(0, 50, 0.95), 1.0 - std::pow(0.05, 1.0 / 50.0), 1e-15);
}

TEST(Proportion, OfNoTrialsIsNotKnown) {
  const Estimate share = proportion(0, 0, 0.95);
  EXPECT_TRUE(std::isnan(share.value));
  EXPECT_EQ(share.interval.low, 0.0);
  EXPECT_EQ(share.interval.high, 1.0);
}

/// The probability that of n pairs of trials `gained` change to good, `lost` change to bad and the rest do not change.
double trinomial(std::uint64_t gained, std::uint64_t lost, std::uint64_t n, double p_gained, double p_lost) {
  const double p_of_rest = p_lost / (1.0 - p_gained);
  return binomial(gained, n, p_gained) * binomial(lost, n - gained, p_of_rest);
}

TEST(PairedChange, CoversEveryChange) {
  constexpr std::uint64_t kPairs = 60;
  double sum = 0.0;
  int cases = 0;
  for (const double p_gained : {0.01, 0.05, 0.15, 0.3, 0.5}) {
    for (const double p_lost : {0.002, 0.02, 0.1, 0.3, 0.45}) {
      double coverage = 0.0;  // exact, by enumeration
      for (std::uint64_t gained = 0; gained <= kPairs; ++gained) {
        for (std::uint64_t lost = 0; lost <= kPairs - gained; ++lost) {
          const Interval limits = paired_change(gained, lost, kPairs, 0.95).interval;
          const double change = p_gained - p_lost;
          if (limits.low <= change && change <= limits.high)
            coverage += trinomial(gained, lost, kPairs, p_gained, p_lost);
        }
      }
      EXPECT_GE(coverage, 0.93) << p_gained << ' ' << p_lost;
      sum += coverage;
      ++cases;
    }
  }
  EXPECT_NEAR(sum / cases, 0.957, 0.012);  // on average not too narrow and not much too wide
}

TEST(PairedChange, IsNarrowWhereTrialsEndAlike) {
  const Estimate same = paired_change(0, 0, 1000, 0.95);
  EXPECT_EQ(same.value, 0.0);
  EXPECT_LT(same.interval.high, 0.003);
  const Estimate change = paired_change(30, 10, 1000, 0.95);
  EXPECT_EQ(change.value, 0.02);
  // For two independent shares near one half the half-width would be 1.96 sqrt(0.5 / 1000) = 0.044.
  EXPECT_LT(change.interval.high - change.interval.low, 0.03);
  EXPECT_GT(change.interval.low, 0.0);
}

TEST(PairedChange, ChangesItsSignWithTheOrder) {
  const Estimate there = paired_change(7, 2, 50, 0.9);
  const Estimate back = paired_change(2, 7, 50, 0.9);
  EXPECT_EQ(there.value, -back.value);
  EXPECT_EQ(there.interval.low, -back.interval.high);
  EXPECT_EQ(there.interval.high, -back.interval.low);
}

TEST(PairedChange, OfNoTrialsIsNotKnown) {
  const Estimate change = paired_change(0, 0, 0, 0.95);
  EXPECT_TRUE(std::isnan(change.value));
  EXPECT_EQ(change.interval.low, -1.0);
  EXPECT_EQ(change.interval.high, 1.0);
}

TEST(TrialsWithoutFailure, AreTheFewestThatShowTheShare) {
  EXPECT_EQ(trials_without_failure(0.9973, 0.95), 1109U);
  for (const double share : {0.5, 0.9, 0.99, 0.9973, 0.999999}) {
    for (const double confidence : {0.5, 0.9, 0.95, 0.999}) {
      const std::uint64_t n = trials_without_failure(share, confidence);
      EXPECT_GE(proportion_at_least(n, n, confidence), share * (1.0 - 1e-13)) << share << ' ' << confidence;
      if (n > 1) {
        EXPECT_LT(proportion_at_least(n - 1, n - 1, confidence), share) << share << ' ' << confidence;
      }
    }
  }
}

}  // namespace
}  // namespace poesy
