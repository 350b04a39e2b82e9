#include "engine/app/resumable.h"

#include <gtest/gtest.h>

#include <string>

#include "tests/support/temp_folder.h"

namespace poesy::app {
namespace {

/// The times of a resumed run include the times that its checkpoint recorded.
TEST(ResumableRun, CountsTheTimeOfEarlierParts) {
  constexpr RunTime kBefore{.wall = 1e6, .checkpoints = 1e5};
  const CheckpointIdentity identity{
      .poesy_version = "1", .git_commit = "c", .model = "m", .samples = 2, .study = "s", .poses = "p"};
  const test::TempFolder folder;
  const std::string result = folder / "r.h5";
  CheckpointFiles(result).write(identity, kBefore, {});

  ResumeOptions options;
  options.resume = true;
  ResumableRun run(options, result, "poesy run --resume");
  run.start(identity, true);
  EXPECT_GE(run.time().wall, kBefore.wall);
  EXPECT_EQ(run.time().checkpoints, kBefore.checkpoints);
  run.checkpoints().save();
  EXPECT_GT(run.time().checkpoints, kBefore.checkpoints);
}

TEST(ResumableRun, StartsWhereThereIsNothingToResume) {
  const test::TempFolder folder;
  ResumeOptions options;
  options.resume = true;
  EXPECT_FALSE(ResumableRun(options, folder / "r.h5", "").continues());
  folder.write("r.h5", "a result");
  EXPECT_THROW(ResumableRun(options, folder / "r.h5", ""), InputError) << "that run is complete";
  CheckpointFiles(folder / "r.h5").write({}, {}, {});
  EXPECT_TRUE(ResumableRun(options, folder / "r.h5", "").continues());
}

TEST(ResumableRun, KnowsWhetherItEndsByItself) {
  const test::TempFolder folder;
  ResumeOptions options;
  EXPECT_FALSE(ResumableRun(options, folder / "a.h5", "").ends_within(1e9));
  options.max_wall = "2 h";
  EXPECT_TRUE(ResumableRun(options, folder / "b.h5", "").ends_within(7201.0));
  EXPECT_FALSE(ResumableRun(options, folder / "c.h5", "").ends_within(7000.0));
}

}  // namespace
}  // namespace poesy::app
