#include <gtest/gtest.h>

#include "engine/run/run_options.h"
#include "tests/engine/kinds/study_kinds.h"
#include "tests/support/kinds.h"
#include "tests/support/states.h"

namespace poesy {
namespace {

using namespace test;
using States = std::vector<Bytes>;

/// The states of all stages after each merge of a run, from which the run can be resumed, and the bits of its result.
struct Recorded {
  std::vector<States> states;
  Bits result;
};

Recorded record(const Prepared& prepared, States start = {}) {
  Recorded recorded;
  Checkpoints checkpoints([] { return true; },
                          [&](std::span<const ByteSource> stages) { recorded.states.push_back(bytes_of_each(stages)); },
                          std::move(start));
  RunOptions options;
  options.threads = 2;
  options.checkpoints = &checkpoints;
  recorded.result = run(prepared, options).value();
  checkpoints.save();
  return recorded;
}

class Continuation : public testing::TestWithParam<KindOfStudy> {};

TEST_P(Continuation, GivesTheSameBits) {
  for (const std::size_t samples : {2 * Plan::kUnitSamples, 2 * Plan::kUnitSamples + 300, std::size_t{300}}) {
    const Prepared prepared(study_of(GetParam(), samples));
    const Bits expected = run(prepared, {}).value();
    const Recorded whole = record(prepared);
    EXPECT_EQ(whole.result, expected);
    ASSERT_GT(whole.states.size(), 3U);
    std::size_t pieces_left = whole.states.size() - 1;  // the last state is that of the complete run
    for (const States& state : whole.states) {
      const Recorded rest = record(prepared, state);
      EXPECT_EQ(rest.result, expected);
      if (pieces_left > 0) --pieces_left;
      EXPECT_EQ(rest.states.size(), pieces_left + 1) << "some work was done twice";
    }
  }
}

TEST_P(Continuation, StopsInAStateToContinue) {
  const Prepared prepared(study_of(GetParam(), 2 * Plan::kUnitSamples + 300));
  const Bits expected = run(prepared, {}).value();
  States kept;
  std::size_t stops = 0;
  for (;;) {
    std::atomic<bool> stop{false};
    Checkpoints checkpoints([] { return false; },
                            [&](std::span<const ByteSource> stages) { kept = bytes_of_each(stages); }, kept);
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

INSTANTIATE_TEST_SUITE_P(Kinds, Continuation,
                         testing::Values(&sensitivity::kStudy, &monte_carlo::kStudy, &evaluate::kStudy,
                                         &identification::kStudy),
                         kind_name);

class Extension : public testing::TestWithParam<KindOfStudy> {};

TEST_P(Extension, GivesTheBitsOfAFreshRun) {
  const std::size_t unit = Plan::kUnitSamples;
  for (const auto& [fewer, more] : {std::pair{unit, 2 * unit},
                                    {unit, unit + 300},
                                    {unit + 300, 2 * unit},
                                    {unit + 300, unit + 400},
                                    {2 * unit, 3 * unit},
                                    {2 * unit + 300, 5 * unit},
                                    {std::size_t{300}, unit + 1}}) {
    const Prepared shorter(study_of(GetParam(), fewer));
    const Prepared longer(study_of(GetParam(), more));
    const Bits expected = run(longer, {}).value();
    for (const States& state : record(shorter).states) {
      // The extended run can be resumed from one of its own states too.
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

INSTANTIATE_TEST_SUITE_P(Kinds, Extension, testing::Values(&sensitivity::kStudy, &monte_carlo::kStudy), kind_name);

/// The final states of one shard of a study.
States run_shard(const Prepared& prepared, const Shard& shard) {
  Checkpoints checkpoints([] { return false; }, [](std::span<const ByteSource>) {});
  RunOptions options;
  options.threads = 2;
  options.checkpoints = &checkpoints;
  options.shard = shard;
  EXPECT_FALSE(run(prepared, options).has_value());
  EXPECT_TRUE(checkpoints.complete());
  return checkpoints.stages();
}

class Sharding : public testing::TestWithParam<KindOfStudy> {};

TEST_P(Sharding, TogetherHasTheBitsOfTheWhole) {
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

INSTANTIATE_TEST_SUITE_P(Kinds, Sharding,
                         testing::Values(&sensitivity::kStudy, &monte_carlo::kStudy, &evaluate::kStudy), kind_name);

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

/// Whether a run can be resumed from these states.
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

TEST_P(Continuation, TakesOrRefusesOtherBytes) {
  // There is no expected result. The test passes if neither a contract of the program nor a sanitizer reports an error.
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

TEST_P(Sharding, MergesOrRefusesAnyOtherBytes) {
  // There is no expected result here either.
  const Prepared prepared(study_of(GetParam(), Plan::kUnitSamples + 300));
  States changed = run_shard(prepared, {0, 4});
  for (std::size_t index = 1; index < 4; ++index) {
    const States next = run_shard(prepared, {index, 4});
    for (std::size_t k = 0; k < next.size(); ++k) changed[k].insert(changed[k].end(), next[k].begin(), next[k].end());
  }
  for (std::size_t at = 0; at < changed.front().size(); at += 1 + changed.front().size() / 1000) {
    for (const auto flip : {std::byte{1}, std::byte{0x3f}, std::byte{0x80}, std::byte{0xff}}) {
      changed.front()[at] ^= flip;
      static_cast<void>(accepted(prepared, changed));
      changed.front()[at] ^= flip;
    }
  }
}

TEST(Continuation, RefusesAStateOfAnotherKind) {
  const Prepared sensitivity(study_of(&sensitivity::kStudy, 300));
  const Prepared monte_carlo(study_of(&monte_carlo::kStudy, 300));
  EXPECT_FALSE(accepted(sensitivity, record(monte_carlo).states.back()));
  EXPECT_FALSE(accepted(monte_carlo, record(sensitivity).states.back()));
}

}  // namespace
}  // namespace poesy
