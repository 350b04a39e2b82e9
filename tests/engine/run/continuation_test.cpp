#include <gtest/gtest.h>

#include <bit>
#include <cstring>

#include "engine/run/evaluation_state.h"
#include "engine/run/identification.h"
#include "engine/run/monte_carlo_collector.h"
#include "engine/run/runner.h"
#include "engine/run/sensitivity_collector.h"
#include "tests/support/fake_model.h"

namespace poesy {
namespace {

using Kind = Analysis::Kind;

const Catalog& catalog() {
  static const Catalog fake = test::fake_catalog();
  return fake;
}

Study study_of(Kind kind, std::size_t samples) {
  Study study;
  study.mechanism = {&catalog().front(), {test::FakeModel::kArm}, 0, {}};
  study.errors.by_factor.assign(3, Distribution::normal(1e-3));
  study.poses.count = 3;
  study.poses.workspace = {{-0.3, -0.2}, {-0.1, 0.1}, {-0.1, 0.1}};
  study.analysis.kind = kind;
  study.analysis.factors = {FactorIndex(0), FactorIndex(1)};
  study.analysis.samples = samples;
  study.analysis.quantiles = {0.1, 0.9};
  study.seed = 3;
  return study;
}

struct Prepared {
  explicit Prepared(const Study& of)
      : study(of), model(build_model(of.mechanism)), plan(of, select_poses(of.poses, *model).poses) {}
  Study study;
  std::unique_ptr<Model> model;
  Plan plan;
};

/// All numbers of a result, bit by bit.
using Bits = std::vector<std::uint64_t>;

void append(Bits& bits, const std::vector<double>& values) {
  for (const double value : values) bits.push_back(std::bit_cast<std::uint64_t>(value));
}

void append(Bits& bits, const SolveCounts& solves) {
  bits.insert(bits.end(), solves.by_status.begin(), solves.by_status.end());
  bits.insert(bits.end(), {solves.iterations, solves.most_iterations});
}

Bits bits_of(const SensitivityResult& result) {
  Bits bits;
  for (const auto* values : {&result.local, &result.local_ci_low, &result.global, &result.global_ci_high, &result.mean,
                             &result.std, &result.count, &result.background}) {
    append(bits, *values);
  }
  for (const SolveCounts& solves : result.solves) append(bits, solves);
  return bits;
}

Bits bits_of(const MonteCarloResult& result) {
  Bits bits;
  for (const auto* values :
       {&result.mean, &result.mean_ci_low, &result.std, &result.min, &result.max, &result.quantiles,
        &result.overall_mean, &result.overall_std, &result.overall_min, &result.overall_quantiles}) {
    append(bits, *values);
  }
  bits.insert(bits.end(), result.count.begin(), result.count.end());
  bits.insert(bits.end(), result.overall_count.begin(), result.overall_count.end());
  for (const SolveCounts& solves : result.solves) append(bits, solves);
  return bits;
}

Bits bits_of(const EvaluationResult& result) {
  Bits bits;
  append(bits, result.response);
  append(bits, result.detail);
  append(bits, result.total());
  return bits;
}

Bits bits_of(const IdentificationResult& result) {
  Bits bits(result.coupled_below);
  append(bits, result.single_max);
  bits.insert(bits.end(), result.coupled_reduced.begin(), result.coupled_reduced.end());
  bits.insert(bits.end(), result.coupled.begin(), result.coupled.end());
  append(bits, result.solves);
  return bits;
}

/// One run of a study of some kind; its result's bits, or nothing when it was stopped.
std::optional<Bits> run(const Prepared& prepared, const RunOptions& options) {
  const auto table = [&](const ErrorTable& errors) {
    return run_evaluation(*prepared.model, {}, prepared.plan.poses(), errors, Pairing::every_pose_with_every_row,
                          options);
  };
  const auto bits = [](const auto& result) { return result ? std::optional(bits_of(*result)) : std::nullopt; };
  switch (prepared.study.analysis.kind) {
    case Kind::sensitivity:
      return bits(run_sensitivity(prepared.plan, *prepared.model, 0.95, options));
    case Kind::monte_carlo:
      return bits(run_monte_carlo(prepared.plan, *prepared.model, prepared.study.analysis, options));
    case Kind::identification: {
      Analysis analysis = prepared.study.analysis;
      analysis.groups = {{"one", 1e-3, 1e-3}, {"two", 2e-3, 2e-3}};
      analysis.pose_share = 0.9;
      return bits(identify(analysis, prepared.model->description(), table));
    }
    default: {
      ErrorTable errors{{FactorIndex(0), FactorIndex(1)}, {}, 700};
      for (std::size_t k = 0; k < 2 * errors.rows; ++k) errors.values.push_back(1e-6 * static_cast<double>(k));
      return bits(table(errors));
    }
  }
}

using States = std::vector<Bytes>;

/// The states of the stages at each moment at which a run could have been stopped, and its result.
struct Recorded {
  std::vector<States> states;
  Bits result;
};

Recorded record(const Prepared& prepared, States start = {}) {
  Recorded recorded;
  Checkpoints checkpoints(
      [] { return true; },
      [&](std::span<const Bytes> stages) { recorded.states.emplace_back(stages.begin(), stages.end()); },
      std::move(start));
  RunOptions options;
  options.threads = 2;
  options.checkpoints = &checkpoints;
  recorded.result = run(prepared, options).value();
  checkpoints.save();
  return recorded;
}

class Continuation : public testing::TestWithParam<Kind> {};

TEST_P(Continuation, FromAnyMomentGivesTheSameBits) {
  for (const std::size_t samples : {2 * Plan::kUnitSamples, 2 * Plan::kUnitSamples + 300, std::size_t{300}}) {
    const Prepared prepared(study_of(GetParam(), samples));
    const Bits expected = run(prepared, {}).value();
    const Recorded whole = record(prepared);
    EXPECT_EQ(whole.result, expected);
    ASSERT_GT(whole.states.size(), 3U);
    std::size_t pieces_left = whole.states.size() - 1;  // the last state is of the whole
    for (const States& state : whole.states) {
      const Recorded rest = record(prepared, state);
      EXPECT_EQ(rest.result, expected);
      if (pieces_left > 0) --pieces_left;
      EXPECT_EQ(rest.states.size(), pieces_left + 1) << "some work was done twice";
    }
  }
}

TEST_P(Continuation, StopsWithAStateThatIsContinued) {
  const Prepared prepared(study_of(GetParam(), 2 * Plan::kUnitSamples + 300));
  const Bits expected = run(prepared, {}).value();
  States kept;
  std::size_t stops = 0;
  for (;;) {
    std::atomic<bool> stop{false};
    Checkpoints checkpoints([] { return false; },
                            [&](std::span<const Bytes> stages) { kept.assign(stages.begin(), stages.end()); }, kept);
    RunOptions options;
    options.threads = 1;
    options.stop = &stop;
    options.progress = [&](const Progress&) { stop = true; };
    options.checkpoints = &checkpoints;
    if (const auto result = run(prepared, options)) {
      EXPECT_EQ(*result, expected);
      break;
    }
    ++stops;
    ASSERT_LT(stops, 1000U);
  }
  EXPECT_GT(stops, 0U);
}

std::string kind_name(const testing::TestParamInfo<Kind>& info) {
  std::string text(name(info.param));
  std::erase(text, '-');
  return text;
}

INSTANTIATE_TEST_SUITE_P(Kinds, Continuation,
                         testing::Values(Kind::sensitivity, Kind::monte_carlo, Kind::evaluate, Kind::identification),
                         kind_name);

class Extension : public testing::TestWithParam<Kind> {};

TEST_P(Extension, GivesTheBitsOfAFreshRun) {
  const std::size_t unit = Plan::kUnitSamples;
  for (const auto& [fewer, more] : {std::pair{unit, 2 * unit},
                                    {unit, unit + 300},
                                    {unit + 300, 2 * unit},
                                    {unit + 300, unit + 400},
                                    {std::size_t{300}, unit + 1}}) {
    const Prepared shorter(study_of(GetParam(), fewer));
    const Prepared longer(study_of(GetParam(), more));
    const Bits expected = run(longer, {}).value();
    for (const States& state : record(shorter).states) {
      // Also from a moment of the extension itself.
      const Recorded extended = record(longer, state);
      EXPECT_EQ(extended.result, expected);
      EXPECT_EQ(record(longer, extended.states[extended.states.size() / 2]).result, expected);
    }
  }
}

TEST_P(Extension, SolvesOnlyWhatIsNew) {
  const std::size_t unit = Plan::kUnitSamples;
  const Prepared shorter(study_of(GetParam(), 3 * unit + 300));
  const Prepared longer(study_of(GetParam(), 4 * unit));
  const Recorded extended = record(longer, record(shorter).states.back());
  EXPECT_EQ(extended.states.size(), longer.plan.cells() + 1);
}

TEST_P(Extension, NeverGivesFewerSamples) {
  const Recorded longer = record(Prepared(study_of(GetParam(), 2300)));
  EXPECT_THROW(record(Prepared(study_of(GetParam(), 2200)), longer.states.back()), BytesError);
}

INSTANTIATE_TEST_SUITE_P(Kinds, Extension, testing::Values(Kind::sensitivity, Kind::monte_carlo), kind_name);

/// The states that one shard of a study leaves.
States run_shard(const Prepared& prepared, const Shard& shard) {
  Checkpoints checkpoints([] { return false; }, [](std::span<const Bytes>) {});
  RunOptions options;
  options.threads = 2;
  options.checkpoints = &checkpoints;
  options.shard = shard;
  EXPECT_FALSE(run(prepared, options).has_value());
  EXPECT_TRUE(checkpoints.complete());
  return {checkpoints.stages().begin(), checkpoints.stages().end()};
}

class Sharding : public testing::TestWithParam<Kind> {};

TEST_P(Sharding, ShardsTogetherHaveTheBitsOfTheWhole) {
  for (const std::size_t samples : {2 * Plan::kUnitSamples, Plan::kUnitSamples + 300, std::size_t{300}}) {
    const Prepared prepared(study_of(GetParam(), samples));
    const Bits expected = run(prepared, {}).value();
    for (const std::size_t count : {1U, 2U, 3U}) {
      States merged;
      for (std::size_t index = 0; index < count; ++index) {
        const States states = run_shard(prepared, {index, count});
        merged.resize(states.size());
        for (std::size_t k = 0; k < states.size(); ++k) {
          merged[k].insert(merged[k].end(), states[k].begin(), states[k].end());
        }
      }
      const Recorded whole = record(prepared, merged);
      EXPECT_EQ(whole.result, expected);
      EXPECT_EQ(whole.states.size(), 1U) << "some work was done twice";
    }
  }
}

TEST_P(Sharding, RefusesAShardTwice) {
  const Prepared prepared(study_of(GetParam(), Plan::kUnitSamples + 300));
  States states = run_shard(prepared, {0, 2});
  const Bytes once = states.front();
  states.front().insert(states.front().end(), once.begin(), once.end());
  EXPECT_THROW(record(prepared, states), BytesError);
}

INSTANTIATE_TEST_SUITE_P(Kinds, Sharding, testing::Values(Kind::sensitivity, Kind::monte_carlo, Kind::evaluate),
                         kind_name);

TEST(Shard, PartsFollowEachOther) {
  for (const std::size_t all : {0UL, 1UL, 5UL, 3950UL, 1UL << 62U}) {
    for (const std::size_t count : {1UL, 2UL, 3UL, 7UL}) {
      std::size_t next = 0;
      for (std::size_t index = 0; index < count; ++index) {
        const NumberRange part = Shard{index, count}.of(all);
        EXPECT_EQ(part.first, next);
        EXPECT_LE(part.end - part.first, all / count + 1);
        next = part.end;
      }
      EXPECT_EQ(next, all);
    }
  }
}

/// Whether a run function takes these states.
bool accepted(const Prepared& prepared, const States& states) {
  try {
    record(prepared, states);
    return true;
  } catch (const BytesError&) {
    return false;
  }
}

TEST_P(Continuation, RefusesEveryTruncation) {
  const Prepared prepared(study_of(GetParam(), Plan::kUnitSamples + 300));
  const std::vector<States> states = record(prepared).states;
  for (const std::size_t at : {std::size_t{0}, states.size() / 2, states.size() - 1}) {
    States cut = states[at];
    Bytes& last = cut.back();
    const Bytes sound = last;
    const std::size_t step = 1 + sound.size() / 500;
    for (std::size_t length = 1; length < sound.size(); length += step) {
      last.assign(sound.begin(), sound.begin() + static_cast<std::ptrdiff_t>(length));
      EXPECT_FALSE(accepted(prepared, cut)) << length;
    }
    last = sound;
    last.push_back(std::byte{0});
    EXPECT_FALSE(accepted(prepared, cut));
  }
}

TEST_P(Continuation, TakesOrRefusesAnyOtherBytes) {
  // Nothing to compare with: neither the program nor a sanitizer may find fault with it.
  const Prepared prepared(study_of(GetParam(), Plan::kUnitSamples + 300));
  const std::vector<States> states = record(prepared).states;
  States changed = states[states.size() / 2];
  for (std::size_t at = 0; at < changed.back().size(); at += 1 + changed.back().size() / 200) {
    for (const auto flip : {std::byte{1}, std::byte{0x80}, std::byte{0xff}}) {
      changed.back()[at] ^= flip;
      static_cast<void>(accepted(prepared, changed));
      changed.back()[at] ^= flip;
    }
  }
}

TEST(Continuation, RefusesAStateOfAnotherKind) {
  const Prepared sensitivity(study_of(Kind::sensitivity, 300));
  const Prepared monte_carlo(study_of(Kind::monte_carlo, 300));
  EXPECT_FALSE(accepted(sensitivity, record(monte_carlo).states.back()));
  EXPECT_FALSE(accepted(monte_carlo, record(sensitivity).states.back()));
}

}  // namespace
}  // namespace poesy
