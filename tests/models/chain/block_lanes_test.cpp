#include <gtest/gtest.h>

#include <algorithm>
#include <bit>
#include <cstdint>
#include <limits>
#include <tuple>

#include "tests/models/chain/block_samples.h"
#include "tests/support/isa.h"

// Tests that a sample's outcome depends only on the sample, not on the other samples, its position or the size of the
// block.

namespace poesy::chain {
namespace {

constexpr std::size_t kCount = 83;

bool same_bits(double a, double b) { return std::bit_cast<std::uint64_t>(a) == std::bit_cast<std::uint64_t>(b); }

/// Expects that sample b of one outcome and sample `at` of the other have the same bits.
void expect_same(const BlockOutcome& one, std::size_t b, const BlockOutcome& other, std::size_t at) {
  EXPECT_EQ(one.status[b], other.status[at]) << "sample " << b;
  EXPECT_EQ(one.iterations[b], other.iterations[at]) << "sample " << b;
  for (const auto& [x, y] : {std::pair(&one.delta_mu, &other.delta_mu), std::pair(&one.responses, &other.responses)}) {
    for (Eigen::Index row = 0; row < x->rows(); ++row) {
      const double a = (*x)(row, static_cast<Eigen::Index>(b));
      const double c = (*y)(row, static_cast<Eigen::Index>(at));
      ASSERT_TRUE(same_bits(a, c)) << "sample " << b << ", row " << row << ": " << a << " and " << c;
    }
  }
}

std::vector<std::size_t> positions(std::size_t first, std::size_t last) {
  std::vector<std::size_t> all(last - first);
  std::iota(all.begin(), all.end(), first);
  return all;
}

/// A kind of block. Kernels treat the kinds differently.
struct Kind {
  const char* name;
  two_upr_rpu::Pose pose;
  bool single;
  double range;  ///< of the predicted starts, in mm or deg; 0: no prediction
  double size;   ///< sigma of all errors, or of the constant errors around a single one (mm or deg)
};

constexpr two_upr_rpu::Pose kEasy{-0.25, 0.1, 0.2};
constexpr two_upr_rpu::Pose kHard{-0.21, 0.5, 0.9};  ///< close to singular: some samples need every pass
constexpr Kind kKinds[] = {{"single", kHard, true, 0.0, 0.3},
                           {"predicted", kEasy, true, 4.0, 0.1},
                           {"predicted_in_part", kEasy, true, 0.5, 0.1},
                           {"predicted_hard", kHard, true, 4.0, 0.3},
                           {"all", kHard, false, 0.0, 0.5},
                           {"all_large", kEasy, false, 0.0, 3.0}};

BlockSamples samples_of(const Kind& kind) {
  constexpr std::size_t kFactor = 60;
  std::mt19937_64 engine(43);
  BlockSamples samples = kind.single ? single_error_samples(kind.pose, kFactor, kind.size, kCount, engine)
                                     : all_error_samples(kind.pose, kind.size, kCount, engine);
  samples.range = kind.range * unit_of(samples.varied[0]);
  return samples;
}

class Lanes : public testing::TestWithParam<std::tuple<const char*, Kind, SolverOptions::Method>> {
 protected:
  void SetUp() override {
    const auto& [isa, kind, method] = GetParam();
    if (!test::machine_has(isa)) GTEST_SKIP() << "this machine has no " << isa;
    forced_.emplace(isa);
    options_.method = method;
    samples_ = samples_of(kind);
    whole_ = solve(samples_, options_);
  }

  /// Solves the samples in this order in blocks of this size, and expects the outcomes of the whole block.
  void expect_whole(std::span<const std::size_t> order, std::size_t block) {
    BlockSolver solver(samples_.chain, options_);
    prepare(solver, samples_);
    for (std::size_t first = 0; first < order.size(); first += block) {
      const auto some = order.subspan(first, std::min(block, order.size() - first));
      const BlockOutcome part = solve(solver, picked(samples_, some));
      for (std::size_t n = 0; n < some.size(); ++n) expect_same(whole_, some[n], part, n);
    }
  }

  SolverOptions options_;
  BlockSamples samples_;
  BlockOutcome whole_;

 private:
  std::optional<test::ForcedIsa> forced_;
};

TEST_P(Lanes, IgnoreBlockSize) {
  for (const std::size_t block : {1u, 2u, 3u, 8u, 17u, 64u}) expect_whole(positions(0, kCount), block);
}

TEST_P(Lanes, IgnorePosition) {
  std::mt19937_64 engine(47);
  std::vector<std::size_t> order = positions(0, kCount);
  for (const std::size_t block : {std::size_t{5}, std::size_t{16}, kCount}) {
    std::shuffle(order.begin(), order.end(), engine);
    expect_whole(order, block);
  }
}

TEST_P(Lanes, DoNotRemember) {
  BlockSolver solver(samples_.chain, options_);
  std::mt19937_64 engine(53);
  BlockSamples other = single_error_samples(random_pose(engine), 12, 0.2, 3 * kCount, engine);
  other.range = 4.0 * kMillimetre;
  prepare(solver, other);
  solve(solver, other);
  prepare(solver, samples_);
  const BlockOutcome again = solve(solver, samples_);
  for (std::size_t b = 0; b < kCount; ++b) expect_same(whole_, b, again, b);
}

TEST_P(Lanes, IgnoreOthers) {
  const double awful[] = {
      std::numeric_limits<double>::quiet_NaN(), std::numeric_limits<double>::infinity(), 1e300, -1e6, 3.0, -0.5};
  for (const double value : awful) {
    BlockSamples spoilt = samples_;
    std::vector<bool> is_spoilt(kCount, false);
    for (std::size_t b = 0; b < kCount; b += 3) {
      is_spoilt[b] = true;
      for (std::size_t v = 0; v < spoilt.varied.size(); ++v) spoilt.values[v * kCount + b] = value;
    }
    const BlockOutcome found = solve(spoilt, options_);
    for (std::size_t b = 0; b < kCount; ++b) {
      if (!is_spoilt[b]) expect_same(whole_, b, found, b);
    }
  }
}

std::string lanes_name(const testing::TestParamInfo<Lanes::ParamType>& info) {
  const auto& [isa, kind, method] = info.param;
  return std::string(isa) + "_" + kind.name + (method == SolverOptions::Method::newton ? "_newton" : "_gauss_newton");
}

INSTANTIATE_TEST_SUITE_P(Kinds, Lanes,
                         testing::Combine(testing::ValuesIn(test::kEveryIsa), testing::ValuesIn(kKinds),
                                          testing::Values(SolverOptions::Method::newton,
                                                          SolverOptions::Method::gauss_newton)),
                         lanes_name);

/// The tests above are only meaningful if the samples of a block need different numbers of iterations.
TEST(LaneKinds, DifferInIterations) {
  for (const Kind& kind : kKinds) {
    const BlockOutcome found = solve(samples_of(kind), {});
    const auto [least, most] = std::ranges::minmax(found.iterations);
    if (kind.range == 0.0 || kind.size > 0.2) {
      EXPECT_LE(least, 12u) << kind.name;
      EXPECT_GT(most, 50u) << kind.name;
    } else {
      EXPECT_LE(least, 1u) << kind.name;
      EXPECT_TRUE(most > 2u || kind.range == 4.0) << kind.name;
    }
  }
}

}  // namespace
}  // namespace poesy::chain
