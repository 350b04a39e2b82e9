#include "engine/run/checkpoints.h"

#include <gtest/gtest.h>

#include "engine/base/error.h"
#include "engine/run/run_options.h"
#include "engine/storage/checkpoint.h"
#include "tests/engine/kinds/study_kinds.h"
#include "tests/support/kinds.h"
#include "tests/support/states.h"
#include "tests/support/temp_folder.h"

namespace poesy {
namespace {

using namespace test;
using States = std::vector<Bytes>;

Bytes some_bytes(std::size_t count, int value = 1) { return Bytes(count, static_cast<std::byte>(value)); }

/// A source of these bytes; it keeps a copy.
ByteSource source_of(const Bytes& bytes) {
  return [bytes](ByteWriter& to) { to.raw(bytes); };
}

/// Checkpoints in memory. Each save replaces `last`, which can be read again. States of more than ten bytes count as
/// large.
struct Saved {
  States last;
  std::size_t saves = 0;
  std::size_t fetches = 0;
  bool is_full = false;
  bool is_due = false;

  Checkpoints checkpoints(const States& start = {}) {
    last = start;
    return {[this] { return is_due; },
            [this](std::span<const ByteSource> stages) {
              if (is_full) throw FileError("r.h5.part", "cannot be written", "make room");
              last = bytes_of_each(stages);
              ++saves;
            },
            start,
            [this](std::size_t stage, ByteWriter& to) {
              ++fetches;
              to.raw(Bytes(last.at(stage)));
            },
            10};
  }
};

TEST(Checkpoints, ASmallEndStaysInMemory) {
  Saved saved;
  Checkpoints checkpoints = saved.checkpoints();
  EXPECT_EQ(checkpoints.begin(), Bytes());
  checkpoints.end(true, {});
  checkpoints.keep(source_of(some_bytes(10)));
  EXPECT_EQ(saved.saves, 0U);
  checkpoints.save();
  EXPECT_EQ(saved.last, States{some_bytes(10)});
  checkpoints.begin();
  checkpoints.save(source_of(some_bytes(3)));
  EXPECT_EQ(saved.last, (States{some_bytes(10), some_bytes(3)}));
  EXPECT_EQ(saved.fetches, 0U);
}

TEST(Checkpoints, ALargeEndIsSavedAtOnceAndTakenOver) {
  Saved saved;
  Checkpoints checkpoints = saved.checkpoints();
  checkpoints.begin();
  checkpoints.keep(source_of(some_bytes(11)));
  EXPECT_EQ(saved.saves, 1U);
  EXPECT_EQ(saved.last, States{some_bytes(11)});
  checkpoints.save();
  EXPECT_EQ(saved.saves, 1U) << "all of it is there";
  checkpoints.begin();
  saved.is_due = true;
  checkpoints.merged(source_of(some_bytes(3)));
  EXPECT_EQ(saved.last, (States{some_bytes(11), some_bytes(3)}));
  EXPECT_GT(saved.fetches, 0U);
  checkpoints.keep(source_of(some_bytes(4)));
  EXPECT_EQ(saved.saves, 2U);
  EXPECT_EQ(checkpoints.stages(), (States{some_bytes(11), some_bytes(4)}));
  checkpoints.save();
  EXPECT_EQ(saved.last, (States{some_bytes(11), some_bytes(4)}));
}

TEST(Checkpoints, WhatFindsNoRoomStaysInMemory) {
  Saved saved;
  Checkpoints checkpoints = saved.checkpoints();
  checkpoints.begin();
  saved.is_full = true;
  EXPECT_NO_THROW(checkpoints.keep(source_of(some_bytes(20))));
  EXPECT_EQ(checkpoints.stages(), States{some_bytes(20)});
  EXPECT_THROW(checkpoints.save(), FileError);
  EXPECT_EQ(checkpoints.stages(), States{some_bytes(20)});
  saved.is_full = false;
  checkpoints.begin();
  checkpoints.save(source_of(some_bytes(2)));
  EXPECT_EQ(saved.last, (States{some_bytes(20), some_bytes(2)}));
  EXPECT_EQ(saved.fetches, 0U);
  checkpoints.save(source_of(some_bytes(2, 2)));
  EXPECT_EQ(saved.last, (States{some_bytes(20), some_bytes(2, 2)}));
  EXPECT_GT(saved.fetches, 0U);
}

TEST(Checkpoints, BetweenSavesTheLastStateOfAStageIsTheSavedOne) {
  Saved saved;
  Checkpoints checkpoints = saved.checkpoints();
  checkpoints.begin();
  saved.is_due = true;
  checkpoints.merged(source_of(some_bytes(5)));
  saved.is_due = false;
  checkpoints.merged(source_of(some_bytes(6)));
  checkpoints.save();
  EXPECT_EQ(saved.saves, 1U);
  EXPECT_EQ(checkpoints.stages(), States{some_bytes(5)});
}

TEST(Checkpoints, GiveAnEarlierRunsStatesWhetherLargeOrSmall) {
  const States start{some_bytes(30, 1), some_bytes(3, 2), some_bytes(40, 3)};
  Saved saved;
  Checkpoints checkpoints = saved.checkpoints(start);
  checkpoints.save();
  EXPECT_EQ(saved.saves, 0U) << "nothing has changed";
  EXPECT_EQ(checkpoints.begin(), start[0]);
  checkpoints.save(source_of(some_bytes(1)));
  EXPECT_EQ(saved.last, (States{some_bytes(1), start[1], start[2]}));
  EXPECT_EQ(checkpoints.begin(), start[1]);
  EXPECT_EQ(checkpoints.begin(), start[2]);
  EXPECT_EQ(checkpoints.begin(), Bytes());
}

TEST(Checkpoints, OfARunThatNobodyContinuesKeepNothing) {
  Checkpoints checkpoints;
  EXPECT_EQ(checkpoints.begin(), Bytes());
  bool written = false;
  const ByteSource state = [&](ByteWriter&) { written = true; };
  checkpoints.merged(state);
  checkpoints.end(true, {});
  checkpoints.keep(state);
  checkpoints.save(state);
  checkpoints.save();
  EXPECT_FALSE(written);
  EXPECT_TRUE(checkpoints.complete());
}

/// Runs a study with a checkpoint after every merge. Returns the contents of the checkpoint files, without repetitions.
std::vector<std::string> files_of(const Prepared& prepared, std::size_t most_in_memory, const Bits& expected) {
  const TempFolder folder;
  CheckpointFiles files(folder / "r.h5");
  std::vector<std::string> contents;
  const auto save = [&](std::span<const ByteSource> stages) {
    files.write({}, {}, stages);
    std::string content = read_bytes(files.newer());
    if (contents.empty() || contents.back() != content) contents.push_back(std::move(content));
  };
  Checkpoints checkpoints([] { return true; }, save, {},
                          [&](std::size_t stage, ByteWriter& to) { files.write_state(stage, to); }, most_in_memory);
  RunOptions options;
  options.threads = 2;
  options.checkpoints = &checkpoints;
  EXPECT_EQ(run(prepared, options), expected);
  checkpoints.save();
  return contents;
}

class CheckpointsInFiles : public testing::TestWithParam<KindOfStudy> {};

TEST_P(CheckpointsInFiles, AreTheSameFromDisk) {
  const Prepared prepared(study_of(GetParam(), Plan::kUnitSamples + 300));
  const Bits expected = run(prepared, {}).value();
  const std::vector<std::string> contents = files_of(prepared, 0, expected);
  EXPECT_TRUE(contents == files_of(prepared, kMostStateInMemory, expected));
  for (const std::string& content : contents) {
    const TempFolder folder;
    CheckpointFiles files(folder / "r.h5");
    write_bytes(files.newer(), content);
    States stages = files.find().value().checkpoint.stages;
    Checkpoints checkpoints([] { return true; }, [&](std::span<const ByteSource> all) { files.write({}, {}, all); },
                            std::move(stages), [&](std::size_t stage, ByteWriter& to) { files.write_state(stage, to); },
                            0);
    RunOptions options;
    options.threads = 1;
    options.checkpoints = &checkpoints;
    EXPECT_EQ(run(prepared, options), expected);
    checkpoints.save();
    EXPECT_TRUE(read_bytes(files.newer()) == contents.back()) << "continued to its end, it is the same run";
  }
}

INSTANTIATE_TEST_SUITE_P(Kinds, CheckpointsInFiles,
                         testing::Values(&sensitivity::kStudy, &monte_carlo::kStudy, &evaluate::kStudy,
                                         &identification::kStudy),
                         kind_name);

}  // namespace
}  // namespace poesy
