#include <gtest/gtest.h>

#include <limits>

#include "models/three_prs/error_mapping.h"
#include "tests/models/three_prs/closure_samples.h"
#include "tests/support/isa.h"

// Compares the first-order kernels of every instruction set with the matrix of effects.

namespace poesy::three_prs {
namespace {

using Rows = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;

const std::vector<double> kPose{0.1, -0.2, 0.75};

struct Mapped {
  Rows responses;  ///< [12 x count]
  Rows swings;     ///< [3 x count]
  std::vector<SolveStatus> status;
};

Mapped map(const ClosureSamples& samples) {
  const auto count = static_cast<Eigen::Index>(samples.count);
  Mapped out{Rows(kResponseRows, count), Rows(kDetailRows, count), std::vector<SolveStatus>(samples.count)};
  std::vector<std::uint32_t> iterations(samples.count);
  SampleBlock block = samples.block();
  block.pose = kPose;
  const auto span = [](Rows& rows) { return std::span(rows.data(), static_cast<std::size_t>(rows.size())); };
  published("first-order")
      ->evaluator({})
      ->evaluate(block, {span(out.responses), out.status, iterations, span(out.swings)});
  EXPECT_EQ(iterations, std::vector<std::uint32_t>(samples.count, 1));
  return out;
}

ClosureSamples some_varied(std::size_t count) {
  std::mt19937_64 engine(37);
  std::vector<FactorIndex> factors;
  for (std::size_t f = 1; f < kFactors; f += 2) factors.emplace_back(f);
  ClosureSamples samples = varied_samples(kPose, factors, 1e-3, count, engine);
  samples.errors.assign(kFactors, 1e-4);
  return samples;
}

class EveryFirstOrderKernel : public test::WithIsa {};

TEST_P(EveryFirstOrderKernel, IsTheMatrixOfEffects) {
  const Effects effects = first_order_effects({}, configuration({}, {kPose[0], kPose[1], kPose[2]}));
  const ClosureSamples samples = some_varied(147);
  const Mapped found = map(samples);
  for (std::size_t b = 0; b < samples.count; ++b) {
    Eigen::Matrix<double, kFactors, 1> errors(samples.errors.data());
    for (std::size_t v = 0; v < samples.varied.size(); ++v) {
      errors[static_cast<Eigen::Index>(samples.varied[v].value)] = samples.values[v * samples.count + b];
    }
    const Eigen::Matrix<double, kMotions, 1> truth = effects * errors;
    const auto column = static_cast<Eigen::Index>(b);
    EXPECT_LE((found.responses.col(column).head<9>() - truth.head<9>()).norm(), 1e-16);
    EXPECT_LE((found.swings.col(column) - truth.tail<3>()).norm(), 1e-16);
    for (Eigen::Index n = 0; n < 3; ++n) {
      EXPECT_NEAR(found.responses(9 + n, column), truth.segment<3>(3 * n).norm(), 1e-16);
    }
    EXPECT_EQ(found.status[b], SolveStatus::converged);
  }
}

TEST_P(EveryFirstOrderKernel, KeepsSamplesApart) {
  ClosureSamples samples = some_varied(147);
  const Mapped whole = map(samples);
  for (std::size_t b = 0; b < samples.count; b += 3) {
    samples.values[b] = b % 2 == 0 ? std::numeric_limits<double>::infinity() : std::numeric_limits<double>::quiet_NaN();
  }
  const Mapped spoilt = map(samples);
  for (std::size_t b = 0; b < samples.count; ++b) {
    EXPECT_EQ(spoilt.status[b], b % 3 == 0 ? SolveStatus::non_finite : SolveStatus::converged);
    if (b % 3 == 0) continue;
    const auto column = static_cast<Eigen::Index>(b);
    const Mapped alone = map(picked(samples, std::array{b}));
    EXPECT_EQ(whole.responses.col(column), spoilt.responses.col(column));
    EXPECT_EQ(whole.responses.col(column), alone.responses.col(0));
    EXPECT_EQ(whole.swings.col(column), alone.swings.col(0));
  }
}

INSTANTIATE_TEST_SUITE_P(Isa, EveryFirstOrderKernel, testing::ValuesIn(test::kEveryIsa), test::isa_name);

TEST(FirstOrderIsas, WithFusedMultiplyAddsAgreeInEveryBit) {
  if (!test::machine_has("avx2") || !test::machine_has("avx512")) GTEST_SKIP() << "this machine has not both";
  const auto map_with = [&](const char* isa) {
    const test::ForcedIsa forced(isa);
    return map(some_varied(147));
  };
  const Mapped four = map_with("avx2"), eight = map_with("avx512");
  EXPECT_EQ(four.responses, eight.responses);
  EXPECT_EQ(four.swings, eight.swings);
}

}  // namespace
}  // namespace poesy::three_prs
