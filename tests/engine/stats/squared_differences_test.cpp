#include "engine/stats/squared_differences.h"

#include <gtest/gtest.h>

#include <cmath>
#include <vector>

#include "engine/base/bytes.h"

namespace poesy {
namespace {

RatioSums sums_of(const std::vector<double>& x, const std::vector<double>& w) {
  RatioSums sums;
  sums.add(x, w, std::vector<std::uint8_t>(x.size(), 1));
  return sums;
}

TEST(RatioSums, GivesTheRatioOfTheMeans) {
  const RatioSums sums = sums_of({1.0, 2.0, 6.0}, {2.0, 8.0, 10.0});
  EXPECT_EQ(sums.count(), 3u);
  EXPECT_DOUBLE_EQ(sums.value(), 0.45);
  EXPECT_DOUBLE_EQ(sums.mean_x(), 3.0);
  EXPECT_DOUBLE_EQ(sums.mean_w(), 20.0 / 3.0);
}

// At the ends of Fieller's interval, Student's t-test of whether x - ratio w has the mean zero is exactly at its
// critical value.
TEST(RatioSums, IntervalEndsWhereStudentsTestRefusesTheRatio) {
  const std::vector<double> x{1.0, 2.0, 6.0, 3.5, 4.0};
  const std::vector<double> w{4.0, 5.0, 9.0, 7.5, 8.0};
  const Interval interval = sums_of(x, w).estimate(0.9).interval;
  for (const double ratio : {interval.low, interval.high}) {
    Moments rest;
    for (std::size_t k = 0; k < x.size(); ++k) rest.add(x[k] - ratio * w[k]);
    const Interval of_rest = mean_interval(rest, 0.9);
    EXPECT_NEAR(std::min(std::abs(of_rest.low), std::abs(of_rest.high)), 0.0, 1e-12);
  }
}

TEST(RatioSums, OfNothingIsExactlyZero) {
  const Estimate estimate = sums_of({0.0, 0.0, 0.0}, {1.0, 2.0, 5.0}).estimate(0.95);
  EXPECT_EQ(estimate.value, 0.0);
  EXPECT_EQ(estimate.interval.low, 0.0);
  EXPECT_EQ(estimate.interval.high, 0.0);
}

TEST(RatioSums, OfAllIsExactlyOne) {
  const Estimate estimate = sums_of({1.1, 2.3, 5.7}, {1.1, 2.3, 5.7}).estimate(0.95);
  EXPECT_EQ(estimate.value, 1.0);
  EXPECT_EQ(estimate.interval.low, 1.0);
  EXPECT_EQ(estimate.interval.high, 1.0);
}

TEST(RatioSums, KnowsNothingWithoutAVariance) {
  EXPECT_TRUE(std::isnan(RatioSums().value()));
  EXPECT_TRUE(std::isnan(sums_of({0.0, 0.0}, {0.0, 0.0}).estimate(0.95).interval.low));
  EXPECT_TRUE(std::isnan(sums_of({1.0}, {2.0}).estimate(0.95).interval.low));
  EXPECT_TRUE(std::isnan(sums_of({1.0, 1.0}, {0.0, 2.0}).estimate(0.95).interval.low)) << "w may be zero";
}

TEST(RatioSums, DoesNotLookAtPairsThatDoNotCount) {
  RatioSums sums;
  std::vector<double> x(20, 1.0);
  std::vector<double> w(20, 4.0);
  std::vector<std::uint8_t> counts(20, 1);
  for (const std::size_t b : {0u, 9u, 19u}) {
    x[b] = std::nan("");
    w[b] = HUGE_VAL;
    counts[b] = 0;
  }
  sums.add(x, w, counts);
  EXPECT_EQ(sums.count(), 17u);
  EXPECT_EQ(sums.value(), 0.25);
}

TEST(RatioSums, DoesNotDependOnTheUnit) {
  const RatioSums plain = sums_of({1.0, 2.0, 6.0, 3.0}, {4.0, 5.0, 9.0, 6.0});
  const double unit = 0x1p-200;
  const RatioSums tiny =
      sums_of({unit, 2.0 * unit, 6.0 * unit, 3.0 * unit}, {4.0 * unit, 5.0 * unit, 9.0 * unit, 6.0 * unit});
  EXPECT_EQ(plain.estimate(0.95).interval.low, tiny.estimate(0.95).interval.low);
  EXPECT_EQ(plain.estimate(0.95).interval.high, tiny.estimate(0.95).interval.high);
}

TEST(RatioSums, MergesAsIfAllHadBeenAddedOneByOne) {
  RatioSums one_by_one;
  for (const auto& [x, w] : {std::pair(1.0, 2.0), {3.0, 5.0}, {0.5, 1.0}, {2.0, 2.5}}) one_by_one.add(x, w);
  RatioSums merged = sums_of({1.0, 3.0}, {2.0, 5.0});
  merged.merge(sums_of({0.5, 2.0}, {1.0, 2.5}));
  EXPECT_EQ(merged.count(), one_by_one.count());
  EXPECT_DOUBLE_EQ(merged.value(), one_by_one.value());
  EXPECT_DOUBLE_EQ(merged.estimate(0.9).interval.low, one_by_one.estimate(0.9).interval.low);
}

TEST(RatioSums, IsReadAsItWasWritten) {
  const RatioSums sums = sums_of({1.0, 2.0, 6.0, 3.0}, {4.0, 5.0, 9.0, 6.0});
  ByteWriter to;
  write_state(sums, to);
  const Bytes bytes = to.take();
  ByteReader from(bytes);
  const RatioSums read = read_state<RatioSums>(from);
  EXPECT_EQ(read.count(), sums.count());
  EXPECT_EQ(read.estimate(0.95).interval.high, sums.estimate(0.95).interval.high);
}

TEST(RatioSums, RefusesSumsThatNoPairsGive) {
  for (const double w : {-1.0, std::nan(""), HUGE_VAL}) {
    ByteWriter to;
    to.number(2);
    to.reals(std::vector{1.0, w, 1.0, 1.0, 1.0});
    const Bytes bytes = to.take();
    ByteReader from(bytes);
    EXPECT_THROW(read_state<RatioSums>(from), BytesError) << w;
  }
}

}  // namespace
}  // namespace poesy
