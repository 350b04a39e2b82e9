#include "engine/stats/yield_gradient.h"

#include <gtest/gtest.h>

#include <array>
#include <boost/random/mersenne_twister.hpp>
#include <cmath>
#include <limits>
#include <numbers>

#include "engine/random/distribution.h"
#include "engine/random/stream.h"
#include "tests/engine/stats/stored_bytes.h"

namespace poesy {
namespace {

using test::expect_no_harm;
using test::read_all;
using test::written;

constexpr double kInfinity = std::numeric_limits<double>::infinity();

/// The reference case: y = a e, normal errors, |y| <= limit.
struct Sum {
  std::array<double, 3> a{1.0, 2.0, 0.5};
  std::array<double, 3> sigma{0.1, 0.05, 0.2};
  double limit = 0.3;

  std::vector<ErrorScale> errors() const {
    return {{sigma[0], kInfinity}, {sigma[1], kInfinity}, {sigma[2], kInfinity}};
  }
};

/// Draws of machines [3 x B] with their rejects.
struct Machines {
  std::vector<double> errors;
  std::vector<std::uint8_t> rejected;

  Machines(const Sum& sum, std::size_t count, std::uint64_t seed) : errors(3 * count), rejected(count) {
    boost::random::mt19937_64 engine(seed);
    for (double& error : errors) error = uniform_from_bits(engine());
    for (std::size_t p = 0; p < 3; ++p) {
      Distribution::normal(sum.sigma[p]).transform(std::span(errors).subspan(p * count, count));
    }
    for (std::size_t b = 0; b < count; ++b) {
      double y = 0.0;
      for (std::size_t p = 0; p < 3; ++p) y += sum.a[p] * errors[p * count + b];
      rejected[b] = static_cast<std::uint8_t>(std::abs(y) > sum.limit);
    }
  }
};

TEST(YieldGradient, HoldsTheReference) {
  constexpr std::size_t kMachines = 400000;
  const Sum sum;
  const Machines machines(sum, kMachines, 3);
  ScoreSums scores(sum.errors());
  scores.add(machines.errors, machines.rejected);
  EXPECT_NEAR(1.0 - static_cast<double>(scores.rejects()) / kMachines, .9167354833,
              3.291 * std::sqrt(.0764 / kMachines));
  const std::vector<Estimate> gradient = scores.gradient(0.999);
  const std::array expected{-1.02786887, -2.05573773, -.51393443};
  for (std::size_t p = 0; p < 3; ++p) {
    EXPECT_LT(gradient[p].interval.low, expected[p]);
    EXPECT_GT(gradient[p].interval.high, expected[p]);
    EXPECT_LT(gradient[p].interval.high - gradient[p].interval.low, 0.08 * std::abs(expected[p]));
  }
}

/// The gradient of the share of |e| <= limit from evenly spread machines of one error, and that share at another sigma.
struct OneError {
  double half_width;
  double limit;

  double yield(double sigma) const {
    const double ends = std::isinf(half_width) ? 1.0 : std::erf(half_width / sigma / std::numbers::sqrt2);
    return std::erf(limit / sigma / std::numbers::sqrt2) / ends;
  }
  double exact(double sigma) const {
    const double step = 1e-4 * sigma;
    return (8.0 * (yield(sigma + step) - yield(sigma - step)) - yield(sigma + 2.0 * step) + yield(sigma - 2.0 * step)) /
           (12.0 * step);
  }
  double from_scores(double sigma) const {
    constexpr std::size_t kMachines = 100000;
    std::vector<double> errors(kMachines);
    for (std::size_t k = 0; k < kMachines; ++k) errors[k] = (static_cast<double>(k) + 0.5) / kMachines;
    const auto distribution =
        std::isinf(half_width) ? Distribution::normal(sigma) : Distribution::truncated_normal(sigma, half_width);
    distribution.transform(errors);
    std::vector<std::uint8_t> rejected;
    for (const double error : errors) rejected.push_back(static_cast<std::uint8_t>(std::abs(error) > limit));
    ScoreSums scores(std::array{ErrorScale{sigma, half_width}});
    scores.add(errors, rejected);
    return scores.gradient(0.95).front().value;
  }
};

TEST(YieldGradient, OfNormalAndTruncatedErrorsIsExact) {
  for (const double half_width : {kInfinity, 6.0, 2.5, 1.0}) {
    for (const double limit : {0.3, 0.9}) {
      const OneError error{half_width, limit};
      EXPECT_NEAR(error.from_scores(1.0), error.exact(1.0), 1e-4) << half_width << ' ' << limit;
      EXPECT_NEAR(error.from_scores(0.4), error.exact(0.4), 3e-4) << half_width << ' ' << limit;
    }
  }
}

TEST(YieldGradient, OfErrorsWithoutAScoreIsNotKnown) {
  ScoreSums scores(std::array{ErrorScale{0.0, 1.0}, ErrorScale{1.0, kInfinity}});
  scores.add(std::array{0.5, 0.9, -0.9, 2.0, 3.0, 0.1}, std::array<std::uint8_t, 3>{1, 1, 0});
  const std::vector<Estimate> gradient = scores.gradient(0.95);
  EXPECT_TRUE(std::isnan(gradient[0].value));
  EXPECT_TRUE(std::isnan(gradient[0].interval.low));
  EXPECT_DOUBLE_EQ(gradient[1].value, -(3.0 + 8.0) / 3.0);
  EXPECT_LT(gradient[1].interval.low, gradient[1].value);
}

TEST(YieldGradient, NeedsTwoRejectsForAnInterval) {
  ScoreSums scores(std::array{ErrorScale{1.0, kInfinity}});
  EXPECT_TRUE(std::isnan(scores.gradient(0.95).front().value));
  scores.add(std::array{0.5, 3.0}, std::array<std::uint8_t, 2>{0, 1});
  EXPECT_DOUBLE_EQ(scores.gradient(0.95).front().value, -4.0);
  EXPECT_TRUE(std::isnan(scores.gradient(0.95).front().interval.low));
  EXPECT_TRUE(std::isnan(scores.gradient(0.95).front().interval.high));
}

/// The same machines in blocks of this size, added or merged.
ScoreSums in_blocks(std::size_t size, bool merged) {
  constexpr std::size_t kMachines = 1003;
  const Sum sum;
  const Machines machines(sum, kMachines, 4);
  ScoreSums scores(sum.errors());
  for (std::size_t first = 0; first < kMachines; first += size) {
    const std::size_t count = std::min(size, kMachines - first);
    std::vector<double> errors;
    for (std::size_t p = 0; p < 3; ++p) {
      const auto row = machines.errors.begin() + static_cast<std::ptrdiff_t>(p * kMachines + first);
      errors.insert(errors.end(), row, row + static_cast<std::ptrdiff_t>(count));
    }
    ScoreSums block(sum.errors());
    (merged ? block : scores).add(errors, std::span(machines.rejected).subspan(first, count));
    scores.merge(block);
  }
  return scores;
}

TEST(ScoreSums, DoNotDependOnBlocks) {
  const ScoreSums whole = in_blocks(1003, false);
  for (const std::size_t size : {1U, 8U, 100U}) {
    const ScoreSums blocks = in_blocks(size, true);
    EXPECT_EQ(blocks.machines(), whole.machines());
    EXPECT_EQ(blocks.rejects(), whole.rejects());
    for (std::size_t p = 0; p < 3; ++p) {
      const Estimate expected = whole.gradient(0.95)[p];
      EXPECT_NEAR(blocks.gradient(0.95)[p].value, expected.value, 1e-13 * std::abs(expected.value));
      EXPECT_NEAR(blocks.gradient(0.95)[p].interval.low, expected.interval.low,
                  1e-12 * std::abs(expected.interval.low));
    }
    EXPECT_EQ(written(in_blocks(size, true)), written(blocks));
  }
}

TEST(StoredScoreSums, GoOnWithTheSameBits) {
  const auto read = [](ByteReader& from) { return ScoreSums::read(from, Sum{}.errors()); };
  ScoreSums scores = in_blocks(100, true);
  ScoreSums stored = read_all(written(scores), read);
  for (ScoreSums* sums : {&scores, &stored}) sums->merge(in_blocks(8, true));
  EXPECT_EQ(written(stored), written(scores));
  expect_no_harm(written(scores), read);
}

TEST(StoredScoreSums, OfNoMachinesAreRefused) {
  const auto refused = [](std::uint64_t machines, std::uint64_t rejects, double sum, double square, double cube) {
    ByteWriter to;
    to.number(machines);
    to.number(rejects);
    to.reals(std::array{sum, square, cube});
    const Bytes bytes = to.take();
    ByteReader from(bytes);
    try {
      ScoreSums::read(from, std::array{ErrorScale{1.0, kInfinity}});
    } catch (const BytesError&) {
      return true;
    }
    return false;
  };
  EXPECT_FALSE(refused(10, 2, 3.0, 5.0, 9.0));
  EXPECT_TRUE(refused(1, 2, 3.0, 5.0, 9.0));
  EXPECT_TRUE(refused(10, 0, 3.0, 5.0, 9.0));
  EXPECT_TRUE(refused(10, 2, 4.0, 5.0, 9.0));
  EXPECT_TRUE(refused(10, 2, 1.0, -5.0, 9.0));
  EXPECT_TRUE(refused(10, 2, kInfinity, kInfinity, 9.0));
  EXPECT_TRUE(refused(10, 2, 3.0, 5.0, kInfinity));
}

}  // namespace
}  // namespace poesy
