#include <gtest/gtest.h>

#include <algorithm>
#include <bit>
#include <limits>
#include <tuple>

#include "tests/models/three_prs/closure_samples.h"
#include "tests/support/isa.h"

// Tests that a sample's outcome depends only on the sample, not on the other samples, its position or the size of the
// block.

namespace poesy::three_prs {
namespace {

constexpr std::size_t kCount = 150;  // more than two tiles of the kernel

bool same_bits(double a, double b) { return std::bit_cast<std::uint64_t>(a) == std::bit_cast<std::uint64_t>(b); }

/// Expects that sample b of one outcome and sample `at` of the other have the same bits.
void expect_same(const ClosureOutcome& one, std::size_t b, const ClosureOutcome& other, std::size_t at) {
  EXPECT_EQ(one.status[b], other.status[at]) << "sample " << b;
  EXPECT_EQ(one.iterations[b], other.iterations[at]) << "sample " << b;
  for (Eigen::Index row = 0; row < one.responses.rows(); ++row) {
    const double x = one.responses(row, static_cast<Eigen::Index>(b));
    const double y = other.responses(row, static_cast<Eigen::Index>(at));
    ASSERT_TRUE(same_bits(x, y)) << "sample " << b << ", row " << row << ": " << x << " and " << y;
  }
}

std::vector<std::size_t> positions(std::size_t count) {
  std::vector<std::size_t> all(count);
  std::iota(all.begin(), all.end(), 0);
  return all;
}

struct Kind {
  const char* name;
  bool all;
  double size;
};
/// Samples of the large kinds need many iterations, or the kernel gives up on them.
constexpr Kind kKinds[] = {
    {"all", true, 1e-3}, {"all_large", true, 0.1}, {"one", false, 1e-3}, {"one_large", false, 0.3}};

ClosureSamples samples_of(const Kind& kind) {
  std::mt19937_64 engine(23);
  const std::vector<double> pose{0.1, -0.2, 0.75};
  return kind.all ? all_varied(pose, kind.size, kCount, engine)
                  : one_varied(pose, factor_of(1, Source::c), kind.size, kCount, engine);
}

class ClosureLanes : public testing::TestWithParam<std::tuple<const char*, Kind>> {
 protected:
  void SetUp() override {
    const auto& [isa, kind] = GetParam();
    if (!test::machine_has(isa)) GTEST_SKIP() << "this machine has no " << isa;
    forced_.emplace(isa);
    samples_ = samples_of(kind);
    whole_.emplace(solve(samples_, {}));
  }

  /// Solves the samples in this order in blocks of this size, and expects the outcomes of the whole block.
  void expect_whole(std::span<const std::size_t> order, std::size_t block) {
    ClosureSolver solver(samples_.geometry, {});
    for (std::size_t first = 0; first < order.size(); first += block) {
      const auto some = order.subspan(first, std::min(block, order.size() - first));
      const ClosureOutcome part = solve(solver, picked(samples_, some));
      for (std::size_t n = 0; n < some.size(); ++n) expect_same(*whole_, some[n], part, n);
    }
  }

  ClosureSamples samples_;
  std::optional<ClosureOutcome> whole_;

 private:
  std::optional<test::ForcedIsa> forced_;
};

TEST_P(ClosureLanes, IgnoreBlockSize) {
  for (std::size_t block = 1; block <= 2 * kMostLanes + 1; ++block) expect_whole(positions(kCount), block);
  for (const std::size_t block : {kTile - 1, kTile, kTile + 1}) expect_whole(positions(kCount), block);
}

TEST_P(ClosureLanes, IgnorePosition) {
  std::mt19937_64 engine(29);
  std::vector<std::size_t> order = positions(kCount);
  for (const std::size_t block : {std::size_t{5}, std::size_t{16}, kCount}) {
    std::ranges::shuffle(order, engine);
    expect_whole(order, block);
  }
}

TEST_P(ClosureLanes, DoNotRemember) {
  ClosureSolver solver(samples_.geometry, {});
  std::mt19937_64 engine(31);
  solve(solver, one_varied({-0.1, 0.1, 0.8}, 3, 0.05, 2 * kCount, engine));
  const ClosureOutcome again = solve(solver, samples_);
  for (std::size_t b = 0; b < kCount; ++b) expect_same(*whole_, b, again, b);
}

TEST_P(ClosureLanes, IgnoreNeighbours) {
  const double awful[] = {
      std::numeric_limits<double>::quiet_NaN(), std::numeric_limits<double>::infinity(), 1e300, 1e7, -1e3, 3.0, -0.5};
  for (const double value : awful) {
    ClosureSamples spoilt = samples_;
    for (std::size_t b = 0; b < kCount; b += 3) {
      for (std::size_t v = 0; v < spoilt.varied.size(); ++v) spoilt.values[v * kCount + b] = value;
    }
    const ClosureOutcome found = solve(spoilt, {});
    for (std::size_t b = 0; b < kCount; ++b) {
      if (b % 3 != 0) expect_same(*whole_, b, found, b);
    }
  }
}

std::string lanes_name(const testing::TestParamInfo<ClosureLanes::ParamType>& info) {
  return std::string(std::get<0>(info.param)) + "_" + std::get<1>(info.param).name;
}

INSTANTIATE_TEST_SUITE_P(Kinds, ClosureLanes,
                         testing::Combine(testing::ValuesIn(test::kEveryIsa), testing::ValuesIn(kKinds)), lanes_name);

TEST(ClosureIsas, WithFusedMultiplyAddsAgreeInEveryBit) {
  if (!test::machine_has("avx2") || !test::machine_has("avx512")) GTEST_SKIP() << "this machine has not both";
  for (const Kind& kind : kKinds) {
    const ClosureSamples samples = samples_of(kind);
    const auto solve_with = [&](const char* isa) {
      const test::ForcedIsa forced(isa);
      return solve(samples, {});
    };
    const ClosureOutcome four = solve_with("avx2");
    const ClosureOutcome eight = solve_with("avx512");
    for (std::size_t b = 0; b < kCount; ++b) expect_same(four, b, eight, b);
  }
}

/// The tests above are only meaningful if the samples of a block need different numbers of iterations.
TEST(ClosureKinds, DifferInIterations) {
  for (const Kind& kind : kKinds) {
    const ClosureOutcome found = solve(samples_of(kind), {});
    const auto [least, most] = std::ranges::minmax(found.iterations);
    EXPECT_LT(least, most) << kind.name;
    EXPECT_TRUE(kind.size < 0.05 || most > least + 4) << kind.name << " " << least << " " << most;
  }
}

}  // namespace
}  // namespace poesy::three_prs
