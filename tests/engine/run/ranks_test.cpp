#include <gtest/gtest.h>

#include <set>

#include "engine/base/error.h"
#include "engine/run/fold.h"
#include "engine/run/run_options.h"
#include "tests/engine/kinds/study_kinds.h"
#include "tests/support/fake_ranks.h"
#include "tests/support/kinds.h"
#include "tests/support/states.h"

namespace poesy {
namespace {

using namespace test;
RunOptions options_of(Team& team, std::size_t threads = 1) {
  RunOptions options;
  options.threads = threads;
  options.team = &team;
  return options;
}

void expect_code_everywhere(const FakeRun& run, int code) {
  EXPECT_EQ(run.exit_codes, std::vector<int>(run.exit_codes.size(), code));
  EXPECT_EQ(run.messages_unread, 0U);
}

/// The program of every rank. The work on the number n returns n^2, and rank 0 merges the results in order. The state
/// is the sequence of merged numbers.
struct Squares {
  std::size_t count = 0;
  std::function<std::size_t(std::size_t rank, std::size_t n)> work = [](std::size_t, std::size_t n) { return n * n; };
  std::function<void(std::size_t n)> on_merge = [](std::size_t) {};
  std::function<void(std::size_t rank)> on_worker = [](std::size_t) {};
  std::function<void(std::size_t rank)> on_pack = [](std::size_t) {};

  /// The merged numbers, the same on every rank. None if the run was stopped.
  std::optional<std::vector<std::size_t>> operator()(const RunOptions& options) const {
    std::vector<std::size_t> merged;
    const ByteSource state = [&](ByteWriter& to) {
      to.number(merged.size());
      for (const std::size_t n : merged) to.number(n);
    };
    const auto restore = [&](std::span<const std::byte> bytes) {
      ByteReader from(bytes);
      merged.assign(from.count(1), 0);
      for (std::size_t& n : merged) n = static_cast<std::size_t>(from.number());
    };
    const std::size_t rank = options.team == nullptr ? 0 : options.team->ranks().rank();
    Stage stage(options.checkpoints, options.team);
    stage.begin(restore);
    const std::size_t first = merged.size();
    const bool complete = run_in_order(
        count - first, options,
        [&] {
          on_worker(rank);
          return 0;
        },
        [&](int, std::size_t n) { return work(rank, first + n); },
        [&](std::size_t n, std::size_t output) {
          EXPECT_EQ(output, (first + n) * (first + n));
          EXPECT_EQ(rank, 0U);
          on_merge(first + n);
          merged.push_back(first + n);
          stage.merged(state);
        },
        [&](Archive& archive, std::size_t, std::size_t& output) {
          if (!archive.reads()) on_pack(rank);
          archive.number(output);
        });
    stage.end(
        complete, [] { return SolveCounts(); }, state, restore);
    return complete ? std::optional(merged) : std::nullopt;
  }
};

std::vector<std::size_t> up_to(std::size_t count) {
  std::vector<std::size_t> numbers(count);
  for (std::size_t n = 0; n < count; ++n) numbers[n] = n;
  return numbers;
}

void doze() { std::this_thread::sleep_for(std::chrono::microseconds(300)); }

class RanksOf : public testing::TestWithParam<std::tuple<KindOfStudy, std::size_t>> {
 protected:
  static KindOfStudy kind() { return std::get<0>(GetParam()); }
  static std::size_t size() { return std::get<1>(GetParam()); }
};

TEST_P(RanksOf, GiveTheBitsOfOneProcess) {
  for (const std::size_t samples : {7 * Plan::kUnitSamples, 2 * Plan::kUnitSamples + 300, std::size_t{1}}) {
    const Prepared prepared(study_of(kind(), samples));
    const Bits expected = run(prepared, {}).value();
    std::vector<std::optional<Bits>> found(size());
    const FakeRun ended =
        run_on_fake_ranks(size(), [&](Team& team) { found[team.ranks().rank()] = run(prepared, options_of(team, 2)); });
    expect_code_everywhere(ended, 0);
    EXPECT_FALSE(ended.left);
    for (const auto& bits : found) EXPECT_EQ(bits, expected);
  }
}

TEST_P(RanksOf, ContinueOneProcessAndViceVersa) {
  const Prepared prepared(study_of(kind(), 3 * Plan::kUnitSamples + 300));
  const Bits expected = run(prepared, {}).value();
  std::vector<Bytes> kept;
  std::vector<std::optional<Bits>> found(size());
  std::size_t runs = 0;
  do {
    ASSERT_LT(++runs, 1000U);
    std::atomic<bool> stop{false};
    std::size_t merges = 0;
    Checkpoints checkpoints([] { return false; },
                            [&](std::span<const ByteSource> stages) { kept = bytes_of_each(stages); }, kept);
    RunOptions leading;
    leading.threads = 1;
    leading.stop = &stop;
    leading.checkpoints = &checkpoints;
    leading.progress = [&](const Progress&) { stop = ++merges >= 2; };
    if (runs % 2 == 1) {
      found.assign(size(), run(prepared, leading));
      continue;
    }
    const FakeRun ended = run_on_fake_ranks(size(), [&](Team& team) {
      RunOptions options = team.leads() ? leading : options_of(team);
      options.team = &team;
      found[team.ranks().rank()] = run(prepared, options);
    });
    expect_code_everywhere(ended, 0);
  } while (!found[0]);
  EXPECT_GT(runs, 1U);
  for (const auto& bits : found) EXPECT_EQ(bits, expected);
}

std::string kind_and_size(const testing::TestParamInfo<std::tuple<KindOfStudy, std::size_t>>& tested) {
  return kind_name({std::get<0>(tested.param), 0}) + "_on_" + std::to_string(std::get<1>(tested.param));
}

INSTANTIATE_TEST_SUITE_P(Kinds, RanksOf,
                         testing::Combine(testing::Values(&sensitivity::kStudy, &monte_carlo::kStudy, &evaluate::kStudy,
                                                          &identification::kStudy),
                                          testing::Values(1, 2, 3, 4)),
                         kind_and_size);

TEST(Ranks, EachTakesAPart) {
  std::mutex mutex;
  std::set<std::size_t> ranks;
  Squares squares{3001};
  squares.work = [&](std::size_t rank, std::size_t n) {
    doze();
    const std::lock_guard lock(mutex);
    ranks.insert(rank);
    return n * n;
  };
  std::vector<std::optional<std::vector<std::size_t>>> found(4);
  const FakeRun ended =
      run_on_fake_ranks(4, [&](Team& team) { found[team.ranks().rank()] = squares(options_of(team, 2)); });
  expect_code_everywhere(ended, 0);
  EXPECT_EQ(ranks.size(), 4U);
  for (const auto& merged : found) EXPECT_EQ(merged, up_to(3001));
}

TEST(Ranks, StudiesOfManyStagesAndOfNothing) {
  const FakeRun ended = run_on_fake_ranks(3, [&](Team& team) {
    for (std::size_t count = 0; count < 60; ++count) {
      EXPECT_EQ(Squares{count}(options_of(team)), up_to(count));
    }
  });
  expect_code_everywhere(ended, 0);
}

TEST(Ranks, ASlowOneHoldsUpNothingButTheEnd) {
  Squares squares{5000};
  squares.work = [](std::size_t rank, std::size_t n) {
    if (rank == 1) std::this_thread::sleep_for(std::chrono::milliseconds(20));
    return n * n;
  };
  const FakeRun ended = run_on_fake_ranks(3, [&](Team& team) { EXPECT_EQ(squares(options_of(team)), up_to(5000)); });
  expect_code_everywhere(ended, 0);
}

/// Runs Squares on fake ranks. Rank 0 saves checkpoints; `stages` is the last one.
struct Kept {
  std::vector<Bytes> stages;
  std::size_t saves = 0;

  FakeRun operator()(std::size_t size, const Squares& squares, const std::function<void(RunOptions&)>& change = {}) {
    return run_on_fake_ranks(size, [&](Team& team) {
      Checkpoints checkpoints([] { return false; },
                              [&](std::span<const ByteSource> all) {
                                stages = bytes_of_each(all);
                                ++saves;
                              },
                              stages);
      RunOptions options = options_of(team, 2);
      if (team.leads()) options.checkpoints = &checkpoints;
      if (change) change(options);
      const auto merged = squares(options);
      EXPECT_EQ(merged.value_or(up_to(squares.count)), up_to(squares.count));
    });
  }

  /// Expects that a run on this process alone can be resumed from the last checkpoint and completed.
  void expect_continued(Squares squares) const {
    Checkpoints checkpoints([] { return false; }, [](std::span<const ByteSource>) {}, stages);
    RunOptions options;
    options.checkpoints = &checkpoints;
    std::size_t fresh = 0;
    squares.work = [](std::size_t, std::size_t n) { return n * n; };
    squares.on_merge = [&](std::size_t) { ++fresh; };
    EXPECT_EQ(squares(options), up_to(squares.count));
    EXPECT_LT(fresh, squares.count);
  }
};

class LeavingRank : public testing::TestWithParam<std::size_t> {};

TEST_P(LeavingRank, EndsTheRunOnAllWithACheckpoint) {
  const std::size_t culprit = GetParam();
  Squares squares{4000};
  squares.work = [&](std::size_t rank, std::size_t n) {
    doze();
    if (rank == culprit && n > 500) throw FileError("table.csv", "cannot be read", "mend it");
    return n * n;
  };
  Kept kept;
  const FakeRun ended = kept(4, squares);
  if (culprit == 0) {
    EXPECT_THROW(std::rethrow_exception(ended.problem), FileError);
    expect_code_everywhere(ended, 9);
    return;
  }
  expect_code_everywhere(ended, 0);
  ASSERT_TRUE(ended.left);
  EXPECT_EQ(ended.left->reason, LeaveReason::file_trouble);
  EXPECT_EQ(ended.left->text, "rank " + std::to_string(culprit) + " on fake: table.csv: cannot be read; mend it");
  EXPECT_EQ(kept.saves, 1U);
  kept.expect_continued(squares);
}

TEST_P(LeavingRank, AlsoWhenItCannotBegin) {
  Squares squares{4000};
  squares.work = [](std::size_t, std::size_t n) {
    doze();
    return n * n;
  };
  squares.on_worker = [&](std::size_t rank) {
    if (rank == GetParam()) throw std::runtime_error("no memory");
  };
  const FakeRun ended = Kept()(4, squares);
  expect_code_everywhere(ended, GetParam() == 0 ? 9 : 0);
  if (GetParam() == 0) return;
  ASSERT_TRUE(ended.left);
  EXPECT_EQ(ended.left->reason, LeaveReason::internal);
}

TEST_P(LeavingRank, AlsoWhenItHasNoMemory) {
  Squares squares{4000};
  squares.work = [](std::size_t rank, std::size_t n) {
    doze();
    if (rank == GetParam() && n > 500) throw std::bad_alloc();
    return n * n;
  };
  Kept kept;
  const FakeRun ended = kept(4, squares);
  if (GetParam() == 0) {
    EXPECT_THROW(std::rethrow_exception(ended.problem), std::bad_alloc);
    expect_code_everywhere(ended, 9);
    return;
  }
  expect_code_everywhere(ended, 0);
  ASSERT_TRUE(ended.left);
  EXPECT_EQ(ended.left->reason, LeaveReason::file_trouble);
  EXPECT_EQ(ended.left->text, "rank " + std::to_string(GetParam()) + " on fake: " + kTooLittleMemory);
  EXPECT_EQ(kept.saves, 1U);
  kept.expect_continued(squares);
}

TEST_P(LeavingRank, AlsoWhenItCannotPack) {
  Squares squares{4000};
  squares.work = [](std::size_t, std::size_t n) {
    doze();
    return n * n;
  };
  squares.on_pack = [&](std::size_t rank) {
    if (rank == GetParam()) throw InputError({}, "no words", "");
  };
  const FakeRun ended = Kept()(4, squares);
  expect_code_everywhere(ended, 0);
  if (GetParam() == 0) return;  // rank 0 packs no results
  ASSERT_TRUE(ended.left);
  EXPECT_EQ(ended.left->reason, LeaveReason::bad_input);
}

TEST_P(LeavingRank, AlsoWhenItIsStopped) {
  std::vector<std::atomic<bool>> stops(4);
  Squares squares{20000};
  squares.work = [&](std::size_t rank, std::size_t n) {
    doze();
    if (rank == GetParam() && n > 500) stops[rank] = true;
    return n * n;
  };
  Kept kept;
  const FakeRun ended =
      kept(4, squares, [&](RunOptions& options) { options.stop = &stops[options.team->ranks().rank()]; });
  expect_code_everywhere(ended, 0);
  EXPECT_EQ(kept.saves, 1U);
  kept.expect_continued(squares);
  ASSERT_EQ(ended.left.has_value(), GetParam() != 0);
  EXPECT_EQ(ended.left.value_or(RankLeft{LeaveReason::stopped, {}}).reason, LeaveReason::stopped);
}

INSTANTIATE_TEST_SUITE_P(AnyRank, LeavingRank, testing::Values(0, 1, 3), testing::PrintToStringParamName());

TEST(Ranks, DoNotWaitForOthersWhenStopped) {
  std::atomic<bool> stop{false};
  std::atomic<bool> let_go{false};
  Squares squares{4000};
  squares.work = [&](std::size_t rank, std::size_t n) {
    doze();
    while (rank != 0 && n > 100 && !let_go) doze();
    if (rank == 0 && n > 120) stop = true;
    return n * n;
  };
  bool saved_before = false;
  const FakeRun ended = run_on_fake_ranks(2, [&](Team& team) {
    Checkpoints checkpoints([] { return false; }, [&](std::span<const ByteSource>) { saved_before = !let_go; });
    RunOptions options = options_of(team);
    if (team.leads()) {
      options.checkpoints = &checkpoints;
      options.stop = &stop;
    }
    EXPECT_FALSE(squares(options));
    let_go = true;
  });
  expect_code_everywhere(ended, 0);
  EXPECT_TRUE(saved_before);
}

TEST(Ranks, ATroubledMergeEndsTheRunOnAll) {
  Squares squares{4000};
  squares.on_merge = [](std::size_t n) {
    if (n == 300) throw FileError("out.h5.part", "No space left on device", "");
  };
  const FakeRun ended = Kept()(4, squares);
  EXPECT_THROW(std::rethrow_exception(ended.problem), FileError);
  expect_code_everywhere(ended, 9);
}

TEST(Ranks, ATroubledCheckpointEndsTheRunOnAll) {
  std::atomic<bool> stop{true};
  const FakeRun ended = run_on_fake_ranks(3, [&](Team& team) {
    Checkpoints checkpoints([] { return false; },
                            [](std::span<const ByteSource>) { throw FileError("out.h5.part", "No space left", ""); });
    RunOptions options = options_of(team);
    if (team.leads()) {
      options.checkpoints = &checkpoints;
      options.stop = &stop;
    }
    Squares{1000}(options);
  });
  EXPECT_THROW(std::rethrow_exception(ended.problem), FileError);
  expect_code_everywhere(ended, 9);
}

TEST(Ranks, RankZeroInTroubleBetweenStagesEndsTheRunOnAll) {
  const FakeRun ended = run_on_fake_ranks(3, [&](Team& team) {
    Squares{100}(options_of(team));
    if (team.leads()) throw std::runtime_error("between");
    Squares{100}(options_of(team));
  });
  expect_code_everywhere(ended, 9);
}

TEST(Ranks, WithoutRoomForAStateEndTheRunOnAll) {
  constexpr std::size_t kRoom = 1000;
  FakeRun ended = run_on_fake_ranks(
      3,
      [](Team& team) {
        EXPECT_EQ(Squares{4000}(options_of(team)), up_to(4000));
        EXPECT_FALSE(Squares{4000}(options_of(team)));
      },
      kRoom);
  expect_code_everywhere(ended, 0);
  ASSERT_TRUE(ended.left);
  EXPECT_EQ(ended.left->reason, LeaveReason::file_trouble);
  EXPECT_TRUE(ended.left->text.ends_with(kTooLittleMemory)) << ended.left->text;

  // At the end of the run rank 0 need not send its state, so there is enough room.
  ended = run_on_fake_ranks(
      3, [](Team& team) { EXPECT_EQ(Squares{4000}(options_of(team)), up_to(4000)); }, kRoom);
  expect_code_everywhere(ended, 0);
}

TEST(Ranks, AgreeOnTheStudy) {
  std::vector<std::size_t> threads(3);
  FakeRun ended = run_on_fake_ranks(3, [&](Team& team) {
    const std::size_t rank = team.ranks().rank();
    EXPECT_TRUE(team.agree("the same", rank + 1, nullptr));
    threads[rank] = team.threads();
    EXPECT_EQ(Squares{50}(options_of(team)), up_to(50));
  });
  expect_code_everywhere(ended, 0);
  EXPECT_EQ(threads[0], 6U);

  ended = run_on_fake_ranks(3, [](Team& team) {
    const bool other = team.ranks().rank() == 2;
    if (team.agree(other ? "another" : "the same", 1, nullptr)) return;
    if (other) throw InputError({"study.toml"}, "is not that of rank 0", "");
  });
  expect_code_everywhere(ended, 0);
  ASSERT_TRUE(ended.left);
  EXPECT_EQ(ended.left->reason, LeaveReason::bad_input);
  EXPECT_EQ(ended.left->text, "rank 2 on fake: study.toml: is not that of rank 0");
}

}  // namespace
}  // namespace poesy
