// Compares the rejects that NearLimit estimates for a coarser part with the closed form for a normal response.

#include "engine/kinds/allocation/near_limit.h"

#include <gtest/gtest.h>

#include <cmath>
#include <cstdint>
#include <numeric>
#include <random>
#include <vector>

#include "engine/random/normal_quantile.h"

namespace poesy::test {
namespace {

constexpr std::size_t kMachines = 149'000;
constexpr double kStep = 1.05;
/// The limit divided by the standard deviation of the response, so that 310 of all machines are rejects.
const double kBound = normal_quantile(1.0, 1.0 - 0.5 * 310.0 / static_cast<double>(kMachines));

/// Machines with a normal response. share: the share of one part in the mean square of the response.
class NormalMachines {
 public:
  NormalMachines(double share, std::uint64_t seed) : others_(kMachines), part_(kMachines) {
    std::mt19937_64 bits(seed);
    const auto normal = [&](double sigma) {
      return normal_quantile(sigma, (static_cast<double>(bits() >> 11U) + 0.5) * 0x1p-53);
    };
    for (double& x : others_) x = normal(std::sqrt(1.0 - share) / kBound);
    for (double& x : part_) x = normal(std::sqrt(share) / kBound);
    numbers_.resize(kMachines);
    std::iota(numbers_.begin(), numbers_.end(), 0U);
  }

  allocation::NearLimit near(std::size_t count) const { return {numbers_, loads(numbers_, 1.0), count}; }
  /// The loads of machines, with the error of the part multiplied by `factor`.
  std::vector<double> loads(const std::vector<std::uint32_t>& machines, double factor) const {
    std::vector<double> loads;
    for (const std::uint32_t s : machines) loads.push_back(std::abs(others_[s] + factor * part_[s]));
    return loads;
  }
  double plain(const allocation::NearLimit& near) const { return near.added_rejects(loads(near.machines(), kStep)); }
  double mirrored(const allocation::NearLimit& near) const {
    const auto& machines = near.machines();
    return near.added_rejects(loads(machines, kStep), loads(machines, -1.0), loads(machines, -kStep));
  }

 private:
  std::vector<double> others_;
  std::vector<double> part_;
  std::vector<std::uint32_t> numbers_;
};

double exact(double share) {
  const auto rejects = [](double square) {
    return static_cast<double>(kMachines) * std::erfc(kBound / std::sqrt(2.0 * square));
  };
  return rejects(1.0 + share * (kStep * kStep - 1.0)) - rejects(1.0);
}

struct MeanOfSets {
  double mean;
  double error;  ///< standard error
  int positive;  ///< number of sets with an estimate above zero
};

constexpr int kSets = 20;

template <class Estimate>
MeanOfSets over_sets(double share, std::size_t count, Estimate estimate) {
  double sum = 0.0;
  double squares = 0.0;
  int positive = 0;
  for (int set = 0; set < kSets; ++set) {
    const NormalMachines machines(share, 1000 + static_cast<std::uint64_t>(set));
    const double come = estimate(machines, machines.near(count));
    sum += come;
    squares += come * come;
    if (come > 0.0) ++positive;
  }
  const double mean = sum / kSets;
  return {mean, std::sqrt((squares / kSets - mean * mean) / (kSets - 1)), positive};
}

const auto kPlain = [](const NormalMachines& machines, const allocation::NearLimit& near) {
  return machines.plain(near);
};
const auto kMirrored = [](const NormalMachines& machines, const allocation::NearLimit& near) {
  return machines.mirrored(near);
};

// Allows 4.5 standard errors, and 3 % for the bias of the window: the density of the loads is not constant within it.
TEST(NearLimit, TellsWhatAPartDoes) {
  for (const double share : {0.3, 0.05}) {
    for (const auto& found : {over_sets(share, 700, kPlain), over_sets(share, 700, kMirrored)}) {
      EXPECT_NEAR(found.mean, exact(share), 4.5 * found.error + 0.03 * exact(share)) << share;
      EXPECT_EQ(found.positive, kSets);
    }
  }
}

TEST(NearLimit, TellsWhatAPartDoesThatHardlyDoesAnything) {
  constexpr double kShare = 5e-5;  // a coarser part adds 0.008 rejects
  const MeanOfSets plain = over_sets(kShare, 700, kPlain);
  const MeanOfSets mirrored = over_sets(kShare, 3000, kMirrored);
  EXPECT_NEAR(plain.mean, exact(kShare), 4.5 * plain.error);
  EXPECT_NEAR(mirrored.mean, exact(kShare), 4.5 * mirrored.error + 0.1 * exact(kShare));
  EXPECT_LT(mirrored.error, 0.15 * plain.error);
  EXPECT_LT(plain.positive, kSets);  // the plain estimate is mostly noise
  EXPECT_EQ(mirrored.positive, kSets);
}

TEST(NearLimit, NoEffectIsNoReject) {
  const NormalMachines machines(0.0, 1);
  const allocation::NearLimit near = machines.near(700);
  EXPECT_EQ(machines.plain(near), 0.0);
  EXPECT_EQ(machines.mirrored(near), 0.0);
  EXPECT_EQ(near.change(machines.loads(near.machines(), kStep)), 0.0);
}

TEST(NearLimit, TakesTheNearestMachines) {
  const NormalMachines machines(0.1, 1);
  const allocation::NearLimit near = machines.near(700);
  EXPECT_NEAR(static_cast<double>(near.machines().size()), 700.0, 1.0);
  for (const double load : machines.loads(near.machines(), 1.0)) EXPECT_LE(std::abs(load - 1.0), near.window());
  EXPECT_EQ(machines.near(kMachines).window(), 0.2);
  EXPECT_EQ(machines.near(1).window(), 0.02);
}

// Loads by hand: one machine is within the window of half-width 0.2, and two are above it; one of them has no solution.
TEST(NearLimit, CountsByDegrees) {
  const std::vector<std::uint32_t> numbers{1, 3, 5, 7};
  const std::vector<double> loads{0.5, 1.0, 1.3, HUGE_VAL};
  const allocation::NearLimit near(numbers, loads, 10);
  EXPECT_EQ(near.machines(), (std::vector<std::uint32_t>{3}));
  const double scale = 2.0 / 2.5;  // two rejects, but 2.5 fractional rejects: the machine at the limit counts one half
  EXPECT_DOUBLE_EQ(near.added_rejects(std::vector{1.2}), 0.5 * scale);
  EXPECT_DOUBLE_EQ(near.added_rejects(std::vector{HUGE_VAL}), 0.5 * scale);
  EXPECT_DOUBLE_EQ(near.added_rejects(std::vector{0.0}), -0.5 * scale);
  const double half = 0.5 * (15.0 - 0.25 * (10.0 - 0.75)) / 16.0;  // rise of the fraction from load 1.0 to 1.1
  EXPECT_DOUBLE_EQ(near.added_rejects(std::vector{1.1}), half * scale);
  // The mirrored machine is outside the window, so the antithetic pair is counted once, with weight 1.
  EXPECT_DOUBLE_EQ(near.added_rejects(std::vector{1.1}, std::vector{0.5}, std::vector{0.5}), half * scale);
  EXPECT_NEAR(near.added_rejects(std::vector{1.1}, std::vector{1.0}, std::vector{0.9}), 0.0, 1e-15);
  EXPECT_DOUBLE_EQ(near.change(std::vector{1.1}), 1.1 - 1.0);
  EXPECT_EQ(near.change(std::vector{HUGE_VAL}), 0.0);
}

TEST(NearLimit, NeedsNoMachines) {
  const allocation::NearLimit near({}, {}, 700);
  EXPECT_TRUE(near.machines().empty());
  EXPECT_EQ(near.added_rejects({}), 0.0);
  EXPECT_EQ(near.change({}), 0.0);
}

}  // namespace
}  // namespace poesy::test
