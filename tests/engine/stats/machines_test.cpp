#include "engine/stats/machines.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <boost/random/mersenne_twister.hpp>
#include <cmath>
#include <limits>

#include "engine/stats/moments.h"
#include "tests/engine/stats/stored_bytes.h"

namespace poesy {
namespace {

using test::expect_no_harm;
using test::read_all;
using test::written;

constexpr double kInfinity = std::numeric_limits<double>::infinity();
constexpr double kNone = std::numeric_limits<double>::quiet_NaN();

using Flags = std::vector<std::uint8_t>;

/// Two responses of four machines at two poses. Machine 0 is good, 1 breaks the first limit at pose 1, 2 is not
/// solved at pose 0, 3 breaks both limits and is not solved at pose 1.
MachineBlock four_machines() {
  MachineBlock block(std::array<ValueLimit, 2>{1.0, 10.0}, 4);
  block.add_pose(std::array{0.5, -1.0, kNone, -1.5,  //
                            3.0, 4.0, kNone, 11.0},
                 Flags{1, 1, 0, 1});
  block.add_pose(std::array{-1.0, 1.25, 0.0, kNone,  //
                            -4.0, 3.0, 0.0, kNone},
                 Flags{1, 1, 1, 0});
  return block;
}

TEST(MachineBlock, CountsRejectsBothWays) {
  const MachineBlock block = four_machines();
  const MachineCounts counts = block.counts();
  EXPECT_EQ(block.poses(), 2U);
  EXPECT_EQ(counts.machines, 4U);
  EXPECT_EQ(counts.unsolved, 2U);
  EXPECT_EQ(counts.all, (Rejects{3, 2}));
  EXPECT_TRUE(std::ranges::equal(counts.by_limit, std::vector<Rejects>{{3, 2}, {2, 1}}));
  EXPECT_TRUE(std::ranges::equal(counts.at_pose, std::vector<Rejects>{{2, 1}, {2, 1}, {2, 1}, {1, 0}}));
  EXPECT_EQ(block.rejected(), (Flags{0, 1, 1, 1}));
  EXPECT_EQ(Flags(block.solved().begin(), block.solved().end()), (Flags{1, 1, 0, 0}));
}

TEST(MachineBlock, GivesLargestAndRootMeanSquareOfSolvedMachines) {
  const MachineBlock block = four_machines();
  const auto largest = block.largest();
  const auto rms = block.root_mean_square();
  EXPECT_EQ(largest(0, 0), 1.0);
  EXPECT_EQ(largest(0, 1), 1.25);
  EXPECT_EQ(largest(1, 0), 4.0);
  EXPECT_DOUBLE_EQ(rms(0, 0), std::sqrt(0.625));
  EXPECT_DOUBLE_EQ(rms(1, 1), std::sqrt(12.5));
  for (std::size_t r = 0; r < 2; ++r) {
    for (const std::size_t unsolved : {2U, 3U}) {
      EXPECT_TRUE(std::isnan(largest(r, unsolved))) << r << " " << unsolved;
      EXPECT_TRUE(std::isnan(rms(r, unsolved))) << r << " " << unsolved;
    }
  }
}

TEST(MachineBlock, WithoutALimitRejectsNothingButTheUnsolved) {
  MachineBlock block(std::array<ValueLimit, 1>{kInfinity}, 3);
  block.add_pose(std::array{1e300, kNone, -1e300}, Flags{1, 0, 1});
  const MachineCounts counts = block.counts();
  EXPECT_EQ(counts.all, (Rejects{1, 0}));
  EXPECT_EQ(counts.by_limit(0), (Rejects{1, 0}));
}

TEST(MachineBlock, RejectsWhatIsNotANumber) {
  MachineBlock block(std::array<ValueLimit, 1>{1.0}, 1);
  block.add_pose(std::array{kNone}, Flags{1});
  EXPECT_EQ(block.counts().all, (Rejects{1, 1}));
}

MachineCounts read_counts(ByteReader& from, std::size_t responses, std::size_t poses) {
  MachineCounts counts = MachineCounts::of_none(responses, poses);
  Archive archive(from);
  counts.state(archive);
  return counts;
}

/// Limits of every kind, judged by plain loops over the poses of each machine.
TEST(MachineBlock, JudgesEveryKindOfLimitAsPlainLoopsDo) {
  constexpr std::size_t kMachines = 400;
  constexpr std::size_t kPoses = 10;
  const std::array<ValueLimit, 6> limits{
      ValueLimit::between(-0.8, 0.95), ValueLimit::between(-kInfinity, 0.9),
      ValueLimit(0.9).at_share(0.9),   ValueLimit::between(-0.7, kInfinity).at_share(0.75),
      ValueLimit::of_spread(1.7),      0.95};
  boost::random::mt19937_64 engine(3);
  std::vector<std::array<std::array<double, kPoses>, kMachines>> y(limits.size());
  Flags counts(kPoses * kMachines);
  for (auto& response : y) {
    for (auto& machine : response) {
      for (double& value : machine) value = 2.0 * static_cast<double>(engine() >> 11U) * 0x1p-53 - 1.0;
    }
  }
  for (std::uint8_t& flag : counts) flag = static_cast<std::uint8_t>(engine() % 40 != 0);
  MachineBlock block(limits, kMachines);
  for (std::size_t m = 0; m < kPoses; ++m) {
    std::vector<double> values;
    for (const auto& response : y) {
      for (const auto& machine : response) values.push_back(machine[m]);
    }
    block.add_pose(values, std::span(counts).subspan(m * kMachines, kMachines));
  }
  const auto is_good = [&](std::size_t r, std::size_t b) {
    int low = 0;
    int high = 0;
    int solved = 0;
    double least = kInfinity;
    double most = -kInfinity;
    for (std::size_t m = 0; m < kPoses; ++m) {
      if (counts[m * kMachines + b] == 0) continue;
      const double value = y[r][b][m];
      ++solved;
      least = std::min(least, value);
      most = std::max(most, value);
      low += value < limits[r].from() ? 1 : 0;
      high += value > limits[r].to() ? 1 : 0;
    }
    const std::array<bool, 6> good{low + high == 0, high == 0,           low + high <= 1,
                                   low <= 2,        most - least <= 1.7, low + high == 0};
    return good[r];
  };
  const MachineCounts found = block.counts();
  const Flags rejected = block.rejected();
  for (std::size_t r = 0; r < limits.size(); ++r) {
    std::uint64_t strict = 0;
    std::uint64_t lenient = 0;
    for (std::size_t b = 0; b < kMachines; ++b) {
      lenient += is_good(r, b) ? 0 : 1;
      strict += is_good(r, b) && block.solved()[b] == 1 ? 0 : 1;
      EXPECT_TRUE(is_good(r, b) || rejected[b] == 1);
      if (limits[r].is_plain() || block.solved()[b] == 0) continue;
      EXPECT_EQ(limits[r].holds(block.deciding(r)[b]), is_good(r, b)) << r << ' ' << b;
    }
    EXPECT_EQ(found.by_limit(r), (Rejects{strict, lenient})) << r;
    EXPECT_GT(lenient, kMachines / 20) << r;
    EXPECT_LT(strict, 19 * kMachines / 20) << r;
  }
  EXPECT_EQ(read_all(written(found), [&](ByteReader& from) { return read_counts(from, limits.size(), kPoses); }),
            found);
}

/// The counts of 600 random machines, added in blocks of this size.
MachineCounts in_blocks(std::size_t block_size) {
  constexpr std::size_t kMachines = 600;
  constexpr std::size_t kPoses = 5;
  const std::array<ValueLimit, 3> limits{0.9, 0.95, kInfinity};
  boost::random::mt19937_64 engine(7);
  std::vector<double> responses(kPoses * limits.size() * kMachines);
  Flags solved(kPoses * kMachines);
  for (double& response : responses) response = 2.0 * static_cast<double>(engine() >> 11U) * 0x1p-53 - 1.0;
  for (std::uint8_t& flag : solved) flag = static_cast<std::uint8_t>(engine() % 50 != 0);
  MachineCounts counts;
  for (std::size_t first = 0; first < kMachines; first += block_size) {
    MachineBlock block(limits, block_size);
    for (std::size_t m = 0; m < kPoses; ++m) {
      std::vector<double> values;
      for (std::size_t r = 0; r < limits.size(); ++r) {
        const auto row = responses.begin() + static_cast<std::ptrdiff_t>((m * limits.size() + r) * kMachines + first);
        values.insert(values.end(), row, row + static_cast<std::ptrdiff_t>(block_size));
      }
      block.add_pose(values, std::span(solved).subspan(m * kMachines + first, block_size));
    }
    counts.merge(block.counts());
  }
  return counts;
}

TEST(MachineCounts, DoNotDependOnBlocks) {
  const MachineCounts whole = in_blocks(600);
  EXPECT_GT(whole.all.strict, whole.all.lenient);
  EXPECT_GT(whole.all.lenient, whole.by_limit(0).lenient);
  EXPECT_EQ(in_blocks(1), whole);
  EXPECT_EQ(in_blocks(200), whole);
}

TEST(MachineCounts, OfNothingTakeAndLeave) {
  MachineCounts counts = in_blocks(600);
  const MachineCounts same = counts;
  counts.merge({});
  EXPECT_EQ(counts, same);
}

TEST(StoredMachineCounts, ComeBack) {
  const MachineCounts counts = in_blocks(600);
  const auto read = [](ByteReader& from) { return read_counts(from, 3, 5); };
  EXPECT_EQ(read_all(written(counts), read), counts);
  expect_no_harm(written(counts), read);
}

TEST(StoredMachineCounts, OfNoMachinesAreRefused) {
  const auto read = [](ByteReader& from) { return read_counts(from, 1, 1); };
  const auto counts_of = [](std::uint64_t unsolved, Rejects all, Rejects by_limit, Rejects at_pose) {
    return written(MachineCounts{9, unsolved, all, Array<Rejects, axis::Response>({1}, by_limit),
                                 Array<Rejects, axis::Response, axis::Pose>({1, 1}, at_pose)});
  };
  const auto refused = [&](auto... counts) { EXPECT_THROW(read_all(counts_of(counts...), read), BytesError); };
  using R = Rejects;
  EXPECT_NO_THROW(read_all(counts_of(2, {5, 3}, {5, 3}, {5, 3}), read));
  refused(10, R{9, 0}, R{9, 0}, R{9, 0});  // more unsolved machines than machines
  refused(2, R{1, 0}, R{1, 0}, R{1, 0});   // unsolved but not rejected
  refused(2, R{5, 2}, R{5, 2}, R{5, 2});   // rejected without a reason
  refused(2, R{5, 3}, R{6, 3}, R{5, 3});   // more by one limit than by all
  refused(2, R{5, 3}, R{1, 0}, R{1, 0});   // unsolved but within a limit
  refused(2, R{5, 3}, R{5, 3}, R{5, 4});   // more at one pose than at all
}

}  // namespace
}  // namespace poesy
