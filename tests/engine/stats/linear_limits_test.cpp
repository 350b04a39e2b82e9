#include "engine/stats/linear_limits.h"

#include <gtest/gtest.h>

#include <array>
#include <boost/random/mersenne_twister.hpp>
#include <cmath>
#include <limits>
#include <numbers>

#include "engine/random/distribution.h"
#include "engine/random/stream.h"

namespace poesy {
namespace {

double norm_of(const LinearLimit& limit, std::span<const double> errors) {
  double sum = 0.0;
  for (std::size_t k = 0; k < limit.rows; ++k) {
    double y = limit.offset[k];
    for (std::size_t p = 0; p < errors.size(); ++p) y += limit.slope[k * errors.size() + p] * errors[p];
    sum += y * y;
  }
  return std::sqrt(sum);
}

/// Random limits on vectors with one and with three components. They depend on four errors; the last error has no
/// effect.
std::vector<LinearLimit> example(boost::random::mt19937_64& engine) {
  const auto number = [&] { return 2.0 * uniform_from_bits(engine()) - 1.0; };
  std::vector<LinearLimit> limits;
  for (const std::size_t rows : {1U, 3U, 3U, 1U}) {
    LinearLimit limit{rows, 0.9, {}, {}};
    for (std::size_t k = 0; k < rows; ++k) {
      limit.offset.push_back(0.1 * number());
      limit.slope.insert(limit.slope.end(), {number(), number(), 0.3 * number(), 0.0});
    }
    limits.push_back(std::move(limit));
  }
  return limits;
}

/// A machine is good if each norm is within its limit. With the other errors fixed, this must hold exactly while one
/// error is between the ends of its range.
TEST(LinearLimits, TellInWhichRangeAMachineIsGood) {
  constexpr std::size_t kErrors = 4;
  constexpr std::size_t kMachines = 300;
  boost::random::mt19937_64 engine(1);
  const std::vector<LinearLimit> limits = example(engine);
  std::vector<double> errors(kErrors * kMachines);
  for (double& one : errors) one = 2.0 * uniform_from_bits(engine()) - 1.0;
  const std::array reach{2.0, 2.0, 2.0, 2.0};
  const LinearLimits::Machines found = LinearLimits(kErrors, limits).machines(errors, reach);
  std::size_t rejects = 0;
  std::size_t nowhere = 0;
  for (std::size_t b = 0; b < kMachines; ++b) {
    std::array<double, kErrors> one{};
    for (std::size_t p = 0; p < kErrors; ++p) one[p] = errors[p * kMachines + b];
    const auto is_good = [&] {
      return std::ranges::all_of(limits,
                                 [&](const LinearLimit& limit) { return norm_of(limit, one) <= limit.limit.to(); });
    };
    EXPECT_EQ(found.rejected[b] == 0, is_good());
    rejects += found.rejected[b];
    for (std::size_t p = 0; p < kErrors; ++p) {
      const double low = found.low[p * kMachines + b];
      const double high = found.high[p * kMachines + b];
      const double own = one[p];
      nowhere += low > high ? 1 : 0;
      for (int step = -40; step <= 40; ++step) {  // as far as `reach` allows
        one[p] = own + 0.05 * step;
        if (std::abs(one[p] - low) < 1e-9 || std::abs(one[p] - high) < 1e-9) continue;
        EXPECT_EQ(low < one[p] && one[p] < high, is_good()) << b << ' ' << p << ' ' << step;
      }
      one[p] = own;
    }
  }
  EXPECT_GT(rejects, kMachines / 10);
  EXPECT_LT(rejects, 9 * kMachines / 10);
  EXPECT_GT(nowhere, 0u);
}

/// The ranges for limits with two ends and with one end.
TEST(LinearLimits, TellTheRangeBetweenTwoEnds) {
  constexpr double kInfinity = std::numeric_limits<double>::infinity();
  const std::vector<LinearLimit> limits{{1, ValueLimit::between(-0.3, 1.1), {0.2}, {1.0, -0.5, 0.0}},
                                        {1, ValueLimit::between(-kInfinity, 0.9), {0.0}, {0.5, 0.8, 0.0}},
                                        {1, ValueLimit::between(-0.7, kInfinity), {0.1}, {-0.6, 0.4, 0.0}}};
  constexpr std::size_t kMachines = 200;
  boost::random::mt19937_64 engine(4);
  std::vector<double> errors(3 * kMachines);
  for (double& one : errors) one = 3.0 * uniform_from_bits(engine()) - 1.5;
  const LinearLimits::Machines found = LinearLimits(3, limits).machines(errors, std::array{3.0, 3.0, 3.0});
  for (std::size_t b = 0; b < kMachines; ++b) {
    std::array<double, 3> one{errors[b], errors[kMachines + b], errors[2 * kMachines + b]};
    const auto is_good = [&] {
      return std::ranges::all_of(limits, [&](const LinearLimit& limit) {
        const double y = limit.offset[0] + limit.slope[0] * one[0] + limit.slope[1] * one[1];
        return limit.limit.from() <= y && y <= limit.limit.to();
      });
    };
    EXPECT_EQ(found.rejected[b] == 0, is_good());
    for (std::size_t p = 0; p < 3; ++p) {
      const double low = found.low[p * kMachines + b];
      const double high = found.high[p * kMachines + b];
      const double own = one[p];
      for (int step = -40; step <= 40; ++step) {
        one[p] = own + 0.05 * step;
        EXPECT_EQ(low < one[p] && one[p] < high, is_good()) << b << ' ' << p << ' ' << step;
      }
      one[p] = own;
    }
  }
  EXPECT_GT(std::ranges::count(found.rejected, 1), 20);
  EXPECT_GT(std::ranges::count(found.rejected, 0), 20);
}

TEST(LinearLimit, KeepsItsNormWithFewerRows) {
  boost::random::mt19937_64 engine(2);
  LinearLimit limit = example(engine)[1];
  // Two more rows that are multiples of the first, as mismatch components of several limb pairs may be.
  for (const double factor : {0.5, -2.0}) {
    limit.offset.push_back(factor * limit.offset[0]);
    for (std::size_t p = 0; p < 4; ++p) limit.slope.push_back(factor * limit.slope[p]);
  }
  limit.rows = 5;
  const LinearLimit fewer = with_fewest_rows(limit);
  EXPECT_EQ(fewer.rows, 3u);
  EXPECT_EQ(fewer.limit, limit.limit);
  for (int n = 0; n < 20; ++n) {
    std::array<double, 4> errors{};
    for (double& one : errors) one = 2.0 * uniform_from_bits(engine()) - 1.0;
    EXPECT_NEAR(norm_of(fewer, errors), norm_of(limit, errors), 1e-13);
  }
}

TEST(ErrorRange, HoldsTheSharesBelow) {
  std::vector<double> quantiles = ErrorRange::grid();
  Distribution::triangular(2.0).transform(quantiles);
  const ErrorRange triangular(quantiles, 0.0);
  for (const double e : {-1.9, -1.0, 0.0, 0.7, 1.99}) {
    const double left = 1.0 - std::abs(e) / 2.0;
    const double share = e < 0.0 ? 0.5 * left * left : 1.0 - 0.5 * left * left;
    EXPECT_NEAR(triangular.below(e), share, 2e-4) << e;
    EXPECT_NEAR(triangular.below(1.1 * e, 1.1), triangular.below(e), 1e-12) << e;
  }
  EXPECT_EQ(triangular.below(-2.1), 0.0);
  EXPECT_EQ(triangular.below(2.1), 1.0);
  EXPECT_NEAR(triangular.length(), 4.0, 1e-6);
  quantiles = ErrorRange::grid();
  Distribution::measured({0, 0, 0, 0, 1, 1, 1, 1, 2}).transform(quantiles);
  const ErrorRange equal(quantiles, 6.0 / 9.0);  // four of the nine values are equal
  EXPECT_NEAR(equal.below(-1e-9), 0.0, 1e-12);
  EXPECT_NEAR(equal.below(1e-9), 4.0 / 9.0, 0.002);
}

}  // namespace
}  // namespace poesy
