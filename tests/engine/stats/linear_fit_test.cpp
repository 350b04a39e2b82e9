#include "engine/stats/linear_fit.h"

#include <gtest/gtest.h>

#include <boost/random/mersenne_twister.hpp>
#include <cmath>

#include "engine/random/normal_quantile.h"
#include "engine/random/stream.h"
#include "tests/engine/stats/stored_bytes.h"

namespace poesy {
namespace {

constexpr std::size_t kErrors = 3;
constexpr std::size_t kRows = 2;
constexpr std::array kOffset{4.0, -1e-6};
constexpr std::array kSlope{1.0, -2.0, 0.5, 0.0, 3e-3, 1e-3};

/// Random machines with standard normal errors x [errors x machines] and responses y [rows x machines]: y = offset +
/// slope x + rest (x_0^2 - 1).
struct Machines {
  std::vector<double> x;
  std::vector<double> y;
  std::vector<std::uint8_t> counts;

  Machines(std::size_t count, double rest, std::uint64_t seed)
      : x(kErrors * count), y(kRows * count), counts(count, 1) {
    boost::random::mt19937_64 engine(seed);
    for (double& one : x) one = normal_quantile(1.0, uniform_from_bits(engine()));
    for (std::size_t k = 0; k < kRows; ++k) {
      for (std::size_t b = 0; b < count; ++b) {
        y[k * count + b] = kOffset[k] + rest * (x[b] * x[b] - 1.0);
        for (std::size_t p = 0; p < kErrors; ++p) y[k * count + b] += kSlope[k * kErrors + p] * x[p * count + b];
      }
    }
  }
};

LinearFitSums sums_of(const Machines& machines) {
  LinearFitSums sums(kErrors, kRows);
  sums.add(machines.x, machines.y, machines.counts);
  return sums;
}

TEST(LinearFit, FindsWhatIsLinearExactly) {
  const LinearFit fit = sums_of(Machines(50, 0.0, 1)).fit().value();
  for (std::size_t k = 0; k < kRows; ++k) {
    EXPECT_NEAR(fit.offset[k], kOffset[k], 1e-13);
    EXPECT_LT(fit.rest[k], 1e-14 * (k == 0 ? 5.25 : 1e-5));  // relative to the variance
  }
  for (std::size_t k = 0; k < kSlope.size(); ++k) EXPECT_NEAR(fit.slope[k], kSlope[k], 1e-13);
}

TEST(LinearFit, LeavesOutMachinesThatDoNotCount) {
  Machines machines(60, 0.0, 2);
  for (std::size_t b = 10; b < 20; ++b) {
    machines.counts[b] = 0;
    machines.y[b] = std::nan("");
    machines.y[60 + b] = std::nan("");
  }
  const LinearFitSums sums = sums_of(machines);
  EXPECT_EQ(sums.machines(), 50u);
  EXPECT_NEAR(sums.fit().value().slope[1], kSlope[1], 1e-13);
}

/// The rest 0.1 (z^2 - 1) has the variance 0.02 and the fourth central moment 60e-4, so the estimate of the variance
/// has the standard error sqrt(56) 0.01 / sqrt(n). The variance of a slope by an error that is independent of the rest
/// is 0.02 / n.
TEST(LinearFit, TellsTheRest) {
  constexpr std::size_t kMachines = 40'000;
  const LinearFit fit = sums_of(Machines(kMachines, 0.1, 3)).fit().value();
  EXPECT_NEAR(fit.rest[0], 0.02, 3.9 * std::sqrt(56.0) * 0.01 / std::sqrt(1.0 * kMachines));
  EXPECT_NEAR(fit.slope_variance[1] * kMachines, fit.rest[0], 0.05 * fit.rest[0]);
  EXPECT_NEAR(fit.slope[1], kSlope[1], 3.9 * std::sqrt(0.02 / kMachines));
  EXPECT_NEAR(fit.slope[0], kSlope[0], 3.9 * std::sqrt(5.0 * 0.02 / kMachines));
}

TEST(LinearFit, NeedsTwiceAsManyMachinesAsUnknowns) {
  EXPECT_FALSE(sums_of(Machines(7, 0.0, 4)).fit());
  EXPECT_TRUE(sums_of(Machines(8, 0.0, 4)).fit());
}

TEST(LinearFitSums, MergeWhateverTheirShifts) {
  const Machines machines(1003, 0.1, 5);
  const LinearFit whole = sums_of(machines).fit().value();
  LinearFitSums parts(kErrors, kRows);
  for (std::size_t first = 0; first < 1003; first += 100) {
    const std::size_t count = std::min<std::size_t>(100, 1003 - first);
    std::vector<double> x;
    std::vector<double> y;
    for (std::size_t p = 0; p < kErrors; ++p)
      x.insert(x.end(), &machines.x[p * 1003 + first], &machines.x[p * 1003 + first] + count);
    for (std::size_t k = 0; k < kRows; ++k)
      y.insert(y.end(), &machines.y[k * 1003 + first], &machines.y[k * 1003 + first] + count);
    LinearFitSums part(kErrors, kRows);
    part.add(x, y, std::vector<std::uint8_t>(count, 1));
    parts.merge(part);
  }
  const LinearFit merged = parts.fit().value();
  EXPECT_EQ(merged.machines, whole.machines);
  for (std::size_t k = 0; k < kSlope.size(); ++k) EXPECT_NEAR(merged.slope[k], whole.slope[k], 1e-13);
  for (std::size_t k = 0; k < kRows; ++k) EXPECT_NEAR(merged.rest[k], whole.rest[k], 1e-12 * whole.rest[k]);
}

TEST(StoredLinearFitSums, GoOnWithTheSameBits) {
  const auto read = [](ByteReader& from) { return read_state<LinearFitSums>(from, kErrors, kRows); };
  LinearFitSums sums = sums_of(Machines(30, 0.1, 6));
  LinearFitSums stored = test::read_all(test::written(sums), read);
  for (LinearFitSums* one : {&sums, &stored}) one->merge(sums_of(Machines(20, 0.1, 7)));
  EXPECT_EQ(test::written(stored), test::written(sums));
  test::expect_no_harm(test::written(sums), read);
}

}  // namespace
}  // namespace poesy
