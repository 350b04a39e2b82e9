#include <gtest/gtest.h>

#include <algorithm>
#include <boost/math/distributions/chi_squared.hpp>
#include <cmath>
#include <vector>

#include "engine/random/normal_quantile.h"
#include "engine/stats/buckets.h"
#include "engine/stats/quantile_sketch.h"

// Sketches of distributions with quantiles in closed form, also far from zero. Errors are in standard deviations. The
// values are quantiles at equal steps of probability, so there is no random noise. Two neighbouring values differ by
// less than 1 / (count x density) = 0.0015 standard deviations at the outermost level.

namespace poesy {
namespace {

constexpr int kCount = 200'000;
constexpr double kStep = 0.0015;

/// Half the width of a bucket, in standard deviations.
constexpr double kBound = 0.0025;

const std::vector<double>& levels() {
  static const std::vector<double> some{0.001, 0.05, 0.25, 0.5, 0.75, 0.95, 0.999};
  return some;
}

std::vector<double> normal_values(double mean, double sigma, int count = kCount) {
  std::vector<double> values;
  for (int k = 0; k < count; ++k) values.push_back(mean + sigma * normal_quantile(1.0, (k + 0.5) / count));
  return values;
}

QuantileSketch of(const std::vector<double>& values) {
  QuantileSketch sketch;
  for (std::size_t first = 0; first < values.size(); first += 1000) {
    sketch.add(std::span(values).subspan(first, std::min<std::size_t>(1000, values.size() - first)));
  }
  return sketch;
}

/// The largest possible error of an order statistic at the tested levels.
double largest_error(const QuantileSketch& sketch) {
  const std::vector<Bucket> buckets = sketch.buckets();
  double error = 0.0;
  for (const double q : levels()) {
    error = std::max(error, order_statistic_error(buckets, quantile_rank(q, sketch.count())));
  }
  return error;
}

TEST(SketchOfAnOffset, HasTheQuantilesOfTheScatter) {
  constexpr double kSigma = 1.88e-8;
  for (const double offset : {0.0, 1.0, 3.0, 10.0, 100.0, 1e6, -1.0, -100.0, -1e6}) {
    const QuantileSketch sketch = of(normal_values(offset * kSigma, kSigma));
    EXPECT_LE(largest_error(sketch), kBound * kSigma) << offset;
    for (const double q : levels()) {
      const double truth = kSigma * (offset + normal_quantile(1.0, q));
      EXPECT_NEAR(sketch.quantile(q), truth, (kBound + kStep) * kSigma) << offset << " sigma, q = " << q;
    }
  }
}

/// |N| for a standard normal N. Its density is largest at zero, its standard deviation is 0.6028.
TEST(SketchOfANorm, HasTheQuantilesOfAFoldedNormal) {
  constexpr double kDeviation = 0.60281;
  std::vector<double> values;
  for (int k = 0; k < kCount; ++k) values.push_back(normal_quantile(1.0, 0.5 + 0.5 * (k + 0.5) / kCount));
  const QuantileSketch sketch = of(values);
  EXPECT_LE(largest_error(sketch), kBound * kDeviation);
  for (const double q : levels()) {
    EXPECT_NEAR(sketch.quantile(q), normal_quantile(1.0, 0.5 + 0.5 * q), (kBound + kStep) * kDeviation) << q;
  }
}

/// The norm of three standard normal components, the square root of a chi-square variable. Its standard deviation is
/// 0.6734.
TEST(SketchOfANorm, HasTheQuantilesOfARootOfAChiSquare) {
  constexpr double kDeviation = 0.6734;
  const boost::math::chi_squared chi(3.0);
  std::vector<double> values;
  for (int k = 0; k < kCount; ++k) values.push_back(std::sqrt(quantile(chi, (k + 0.5) / kCount)));
  const QuantileSketch sketch = of(values);
  EXPECT_LE(largest_error(sketch), kBound * kDeviation);
  for (const double q : levels()) {
    EXPECT_NEAR(sketch.quantile(q), std::sqrt(quantile(chi, q)), (kBound + kStep) * kDeviation) << q;
  }
}

/// A few outliers take a page each; the other values keep their fine pages.
TEST(SketchOfAnOffset, IsNotRuledByOutliers) {
  for (const double outlier : {30.0, 300.0}) {
    std::vector<double> values = normal_values(100.0, 1.0);
    for (int k = 0; k < 10; ++k) values[static_cast<std::size_t>(k * 20'000)] = 100.0 + outlier * (k - 4.5);
    const QuantileSketch sketch = of(values);
    const double bound = outlier < 100.0 ? kBound : 0.04;
    for (const double q : levels()) {
      EXPECT_NEAR(sketch.quantile(q), 100.0 + normal_quantile(1.0, q), bound + 10.0 * kStep) << outlier << " " << q;
    }
  }
}

/// Half of the values are equal, like a response that sometimes does not vary.
TEST(SketchOfAnOffset, KnowsAtoms) {
  std::vector<double> values = normal_values(7.0, 1e-6, kCount / 2);
  values.insert(values.end(), kCount / 2, 7.0);
  const QuantileSketch sketch = of(values);
  for (const double q : {0.3, 0.5, 0.7}) EXPECT_NEAR(sketch.quantile(q), 7.0, kBound * 1e-6);
  EXPECT_NEAR(sketch.quantile(0.05), 7.0 + 1e-6 * normal_quantile(1.0, 0.1), 2.0 * kBound * 1e-6);
}

/// The stored size of a sketch is bounded for every offset.
TEST(SketchOfAnOffset, HasBoundedMemory) {
  for (const double offset : {0.0, 1.0, 1e6}) {
    const QuantileSketch sketch = of(normal_values(offset, 1.0));
    const Bytes bytes = bytes_of([&](ByteWriter& to) { write_state(sketch, to); });
    EXPECT_LT(bytes.size(), 3 * kPageBuckets * QuantileSketch::kMostPages) << offset;
  }
}

}  // namespace
}  // namespace poesy
