#include <gtest/gtest.h>

#include <atomic>
#include <bit>
#include <cmath>

#include "engine/kinds/monte_carlo/result.h"
#include "engine/kinds/sensitivity/result.h"
#include "engine/run/rounds.h"
#include "engine/run/run_options.h"
#include "engine/stats/tolerance.h"
#include "engine/study/plan.h"
#include "tests/engine/run/adaptive_study.h"
#include "tests/support/kinds.h"
#include "tests/support/states.h"

namespace poesy {
namespace {

using test::adaptive_study;
using test::AdaptiveRun;
using Bits = std::vector<std::uint64_t>;
using States = std::vector<Bytes>;

void append(Bits& bits, std::span<const double> values) {
  for (const double value : values) bits.push_back(std::bit_cast<std::uint64_t>(value));
}

Bits bits_of(const ConvergenceResult& found) {
  Bits bits(found.course.samples);
  append(bits, found.course.value);
  append(bits, found.course.half_width);
  append(bits, found.relative_half_width);
  bits.insert(bits.end(), found.reached.begin(), found.reached.end());
  bits.insert(bits.end(), found.samples.begin(), found.samples.end());
  return bits;
}

Bits bits_of(const sensitivity::Result& found) {
  EXPECT_FALSE(found.history) << "what a history would say is in the convergence";
  Bits bits = bits_of(found.convergence.value());
  bits.insert(bits.end(), found.count.begin(), found.count.end());
  for (const auto values : {found.local.all(), found.local_ci_high.all(), found.global.all(), found.global_ci_low.all(),
                            found.mean.all(), found.std.all()}) {
    append(bits, values);
  }
  return bits;
}

Bits bits_of(const monte_carlo::Result& found) {
  Bits bits = bits_of(found.convergence.value());
  for (const std::span<const double> values : std::initializer_list<std::span<const double>>{
           found.mean, found.mean_ci_low, found.std, found.min, found.max, found.quantiles, found.overall_mean,
           found.overall_std, found.overall_quantiles}) {
    append(bits, values);
  }
  bits.insert(bits.end(), found.count.begin(), found.count.end());
  return bits;
}

/// Runs the study. Returns the bits of its result, or none if the run was stopped.
std::optional<Bits> run(const AdaptiveRun& run, const RunOptions& options) {
  const auto bits = [](const auto& result) { return result ? std::optional(bits_of(*result)) : std::nullopt; };
  return run.study.analysis.kind == &sensitivity::kStudy ? bits(run.sensitivity(options))
                                                         : bits(run.monte_carlo(options));
}

RunOptions on_threads(std::size_t threads) {
  RunOptions options;
  options.threads = threads;
  return options;
}

TEST(AdaptiveSensitivity, EachErrorEndsAtItsOwnMilestone) {
  const AdaptiveRun study(adaptive_study(&sensitivity::kStudy, 0.015, 100'000));
  const sensitivity::Result found = study.sensitivity({}).value();
  const ConvergenceResult& end = found.convergence.value();
  const std::size_t milestones = end.course.samples.size();
  EXPECT_EQ(end.samples[2], 1000u) << "an error without effect has nothing to wait for";
  EXPECT_LT(end.samples[1], end.samples[0]);
  EXPECT_LT(end.samples[0], 100'000u);
  EXPECT_EQ(end.course.samples.back(), end.samples[0]);
  for (std::size_t cell = 0; cell < end.reached.size(); ++cell) {
    const auto [r, factor] = found.global.positions(cell);
    EXPECT_EQ(end.reached[cell], 1);
    EXPECT_EQ(found.count(r, factor, 0), end.samples[factor]);
    const double index = found.global(r, factor);
    const double half = std::max(index - found.global_ci_low(r, factor), found.global_ci_high(r, factor) - index);
    for (std::size_t k = 0; k < milestones; ++k) {
      const double seen = end.course.half_width[cell * milestones + k];
      EXPECT_EQ(std::isnan(seen), end.course.samples[k] > end.samples[factor]);
      if (end.course.samples[k] != end.samples[factor]) continue;
      EXPECT_EQ(seen, half);
      EXPECT_EQ(end.course.value[cell * milestones + k], index);
    }
    if (factor == 2) continue;
    EXPECT_EQ(end.relative_half_width[cell], half / index);
    EXPECT_LE(end.relative_half_width[cell], 0.015);
  }
  // At the previous milestone, a response to the first error had not yet reached the aim.
  const auto before = [&](std::size_t response) {
    const std::size_t at = response * 3 * milestones + milestones - 2;
    return end.course.half_width[at] / end.course.value[at];
  };
  EXPECT_GT(std::max(before(0), before(1)), 0.015);
}

TEST(AdaptiveSensitivity, GivesTheBitsOfAsManyFixedSamples) {
  Study study = adaptive_study(&sensitivity::kStudy, 0.015, 100'000);
  const sensitivity::Result found = AdaptiveRun(study).sensitivity({}).value();
  study.analysis.samples = found.convergence->samples[0];
  study.analysis.adaptive.reset();
  const sensitivity::Result fixed = AdaptiveRun(study).sensitivity({}).value();
  EXPECT_FALSE(fixed.convergence);
  EXPECT_EQ(fixed.global(0, 0), found.global(0, 0));
  EXPECT_EQ(fixed.local(0, 0, 0), found.local(0, 0, 0));
  EXPECT_EQ(fixed.global_ci_low(1, 0), found.global_ci_low(1, 0));
}

TEST(AdaptiveSensitivity, MaxEndsWhatDoesNotReachIt) {
  const AdaptiveRun study(adaptive_study(&sensitivity::kStudy, 0.001, 4300));
  const sensitivity::Result found = study.sensitivity({}).value();
  const ConvergenceResult& end = found.convergence.value();
  EXPECT_EQ(end.course.samples, (std::vector<std::uint64_t>{1000, 2000, 3000, 4300}));
  EXPECT_EQ(end.samples, (std::vector<std::uint64_t>{4300, 4300, 1000}));
  EXPECT_EQ(end.reached, (std::vector<std::uint8_t>{0, 0, 1, 0, 0, 1}));
  EXPECT_EQ(end.course.value[3], found.global(0, 0)) << "the last milestone is max, with its unit that is not whole";
  EXPECT_GT(end.relative_half_width[0], 0.001);
}

TEST(AdaptiveSensitivity, FewerThanTheFirstMilestoneAreOneRound) {
  Study study = adaptive_study(&sensitivity::kStudy, 0.5, 700);
  study.analysis.adaptive->min = 2;
  const ConvergenceResult end = AdaptiveRun(study).sensitivity({})->convergence.value();
  EXPECT_EQ(end.course.samples, (std::vector<std::uint64_t>{700}));
  EXPECT_EQ(end.reached, (std::vector<std::uint8_t>(6, 1)));
}

TEST(AdaptiveMonteCarlo, EndsWhereEveryOverallMeanIsReached) {
  const AdaptiveRun study(adaptive_study(&monte_carlo::kStudy, 0.01, 100'000));
  const monte_carlo::Result found = study.monte_carlo({}).value();
  const ConvergenceResult& end = found.convergence.value();
  ASSERT_EQ(end.samples.size(), 1u);
  EXPECT_LT(end.samples[0], 100'000u);
  EXPECT_GT(end.samples[0], 1000u);
  EXPECT_EQ(end.course.samples.back(), end.samples[0]);
  const std::size_t last = end.course.samples.size() - 1;
  for (std::size_t r = 0; r < 2; ++r) {
    EXPECT_EQ(end.reached[r], 1);
    const double mean = end.course.value[r * end.course.samples.size() + last];
    EXPECT_NEAR(mean, found.overall_mean(r), 1e-12 * mean);
    // All poses have equally many samples, so the variance of the overall mean is the mean of the poses' variances,
    // divided by the number of all samples.
    double variance = 0.0;
    for (std::size_t m = 0; m < 3; ++m) variance += std::pow(found.std(r, m), 2) / 3.0;
    const double half = 1.96 * std::sqrt(variance / (3.0 * static_cast<double>(end.samples[0])));
    EXPECT_NEAR(end.course.half_width[r * end.course.samples.size() + last], half, 1e-3 * half);
  }
}

TEST(Rounds, ResponsesThatDoNotDecideAreReportedOnly) {
  const AdaptiveRun run(adaptive_study(&monte_carlo::kStudy, 0.01, 4000));
  Rounds rounds(run.plan, {2, {0}, 0.95, {0.0, 0.0}});
  EXPECT_FALSE(rounds.go_on([](std::size_t) {
    return std::vector<Estimate>{{1.0, {0.995, 1.005}}, {1.0, {0.0, 2.0}}};
  }));
  EXPECT_EQ(rounds.result()->reached, (std::vector<std::uint8_t>{1, 0}));
}

TEST(Rounds, ExpectTheSolvesThatTheHalfWidthsAskFor) {
  Study study = adaptive_study(&monte_carlo::kStudy, 0.01, 100'000);
  const AdaptiveRun run(study);
  Rounds rounds(run.plan, {1, {0}, 0.95, {0.0}});
  EXPECT_EQ(rounds.samples(0), 1000u);
  EXPECT_EQ(rounds.expected_solves(), 300'000u);
  // The interval is three times wider than the aim, so the prediction is nine times as many samples, rounded up to a
  // milestone.
  EXPECT_TRUE(rounds.go_on([](std::size_t) { return std::vector<Estimate>{{1.0, {0.97, 1.03}}}; }));
  EXPECT_EQ(rounds.samples(0), 2000u);
  EXPECT_EQ(rounds.expected_solves(), 3u * 12'000u);
}

TEST(Rounds, WhatIsUnknownIsNotReached) {
  const AdaptiveRun run(adaptive_study(&monte_carlo::kStudy, 0.01, 3000));
  const double nan = std::nan("");
  for (const Estimate& unknown : {Estimate{nan, {nan, nan}}, Estimate{1.0, {nan, nan}}, Estimate{1.0, {1.0, nan}}}) {
    Rounds rounds(run.plan, {1, {0}, 0.95, {kIndexRounding}});
    while (rounds.go_on([&](std::size_t) { return std::vector{unknown}; })) {
    }
    EXPECT_EQ(rounds.samples(0), 3000u);
    EXPECT_EQ(rounds.result()->reached, (std::vector<std::uint8_t>{0}));
  }
}

TEST(Rounds, BothEndsOfAnIntervalCount) {
  const AdaptiveRun run(adaptive_study(&monte_carlo::kStudy, 0.01, 3000));
  for (const Estimate& wide :
       {Estimate{1.0, {0.98, 1.001}}, Estimate{1.0, {0.999, 1.02}}, Estimate{-1.0, {-1.02, -1.0}}}) {
    Rounds rounds(run.plan, {1, {0}, 0.95, {0.0}});
    EXPECT_TRUE(rounds.go_on([&](std::size_t) { return std::vector{wide}; }));
  }
  Rounds rounds(run.plan, {1, {0}, 0.95, {0.0}});
  EXPECT_FALSE(rounds.go_on([&](std::size_t) { return std::vector{Estimate{-1.0, {-1.009, -0.991}}}; }));
}

struct Case {
  const char* name;
  test::KindOfStudy kind;
  double relative_error;
  std::size_t max;
};

class Adaptive : public testing::TestWithParam<Case> {
 protected:
  AdaptiveRun study_{adaptive_study(GetParam().kind, GetParam().relative_error, GetParam().max)};
};

TEST_P(Adaptive, SameBitsOnAnyNumberOfThreads) {
  const Bits expected = run(study_, on_threads(1)).value();
  for (const std::size_t threads : {2U, 3U, 7U}) EXPECT_EQ(run(study_, on_threads(threads)), expected) << threads;
}

TEST_P(Adaptive, StoppedItGoesOnToTheSameBits) {
  const Bits expected = run(study_, on_threads(2)).value();
  States kept;
  std::size_t stops = 0;
  for (;;) {
    std::atomic<bool> stop{false};
    Checkpoints checkpoints([] { return false; },
                            [&](std::span<const ByteSource> stages) { kept = test::bytes_of_each(stages); }, kept);
    RunOptions options = on_threads(1 + stops % 2);
    options.stop = &stop;
    options.progress = [&](const Progress& progress) {
      EXPECT_LE(progress.solves, progress.total);
      stop = true;
    };
    options.checkpoints = &checkpoints;
    if (const auto result = run(study_, options)) {
      EXPECT_EQ(*result, expected);
      break;
    }
    ASSERT_LT(++stops, 1000u);
  }
  EXPECT_GT(stops, 5u);
}

/// All states from which a run of the study may be resumed. The last one is that of the complete run.
std::vector<States> states_of(const AdaptiveRun& study) {
  std::vector<States> states;
  Checkpoints checkpoints([] { return true; },
                          [&](std::span<const ByteSource> stages) { states.push_back(test::bytes_of_each(stages)); });
  RunOptions options = on_threads(2);
  options.checkpoints = &checkpoints;
  EXPECT_TRUE(run(study, options));
  checkpoints.save();
  return states;
}

std::optional<Bits> run_from(const AdaptiveRun& study, const States& state) {
  Checkpoints checkpoints([] { return false; }, [](std::span<const ByteSource>) {}, state);
  RunOptions options = on_threads(2);
  options.checkpoints = &checkpoints;
  return run(study, options);
}

TEST_P(Adaptive, ALargerMaxGivesAFreshRunsBits) {
  for (const std::size_t max : {GetParam().max + 1, GetParam().max + 700, 2 * GetParam().max, 5 * GetParam().max}) {
    const AdaptiveRun longer(adaptive_study(GetParam().kind, GetParam().relative_error, max));
    const Bits expected = run(longer, on_threads(2)).value();
    const std::vector<States> states = states_of(study_);
    for (std::size_t n = 0; n < states.size(); n += 1 + states.size() / 6) {
      EXPECT_EQ(run_from(longer, states[n]), expected) << max << " from " << n;
    }
    EXPECT_EQ(run_from(longer, states.back()), expected) << max;
  }
}

TEST_P(Adaptive, ASmallerMaxIsRefused) {
  const AdaptiveRun shorter(adaptive_study(GetParam().kind, GetParam().relative_error, 1500));
  EXPECT_THROW(run_from(shorter, states_of(study_).back()), BytesError);
}

TEST_P(Adaptive, TakesOrRefusesOtherBytes) {
  // There is no expected result. The test passes if neither a contract of the program nor a sanitizer reports an error.
  const std::vector<States> states = states_of(study_);
  States changed = states[states.size() / 2];
  Bytes& state = changed.front();
  const Bytes sound = state;
  for (std::size_t at = 0; at < sound.size(); at += 1 + at / 4) {
    state[at] ^= std::byte{0xff};
    try {
      run_from(study_, changed);
    } catch (const BytesError&) {
    }
    state = sound;
  }
  for (std::size_t length = 1; length < sound.size(); length += 1 + sound.size() / 50) {
    state.assign(sound.begin(), sound.begin() + static_cast<std::ptrdiff_t>(length));
    EXPECT_THROW(run_from(study_, changed), BytesError);
  }
}

INSTANTIATE_TEST_SUITE_P(Kinds, Adaptive,
                         testing::Values(Case{"SensitivityReached", &sensitivity::kStudy, 0.02, 20'000},
                                         Case{"SensitivityMax", &sensitivity::kStudy, 0.012, 4300},
                                         Case{"MonteCarloReached", &monte_carlo::kStudy, 0.015, 20'000},
                                         Case{"MonteCarloMax", &monte_carlo::kStudy, 0.006, 4300}),
                         [](const auto& one) { return one.param.name; });

}  // namespace
}  // namespace poesy
