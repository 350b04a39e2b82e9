#include "engine/kinds/study_run.h"
#include "engine/kinds/allocation/result.h"
#include "engine/kinds/evaluate/cases.h"
#include "engine/kinds/monte_carlo/result.h"
#include "engine/kinds/sensitivity/result.h"

#include <gtest/gtest.h>

#include "engine/base/error.h"
#include "tests/engine/kinds/study_kinds.h"
#include "tests/support/kinds.h"

namespace poesy::test {
namespace {

Study with_cases() {
  Study study = study_of(&evaluate::kStudy, 0);
  asked_of<evaluate::CaseOptions>(study.analysis).cases = {{"one", {1e-3, 0.0, 0.0}}, {"two", {0.0, 1e-3, 0.0}}};
  study.analysis.limits = {{0, 1e-9}};
  return study;
}

TEST(RunStudy, FindsASensitivityStudysResultAndItsChanges) {
  const Prepared prepared(study_of(&sensitivity::kStudy, 200));
  const auto result = run_study(prepared.study);
  ASSERT_TRUE(result);
  const auto& found = result->as<sensitivity::Result>();
  EXPECT_EQ(bits_of(found), run(prepared, {}));
  EXPECT_EQ(found.index_change.size(), 4u);
  EXPECT_FALSE(result->verdicts);
}

TEST(RunStudy, FindsWhatTheRunOfAMonteCarloStudyFinds) {
  const Prepared prepared(study_of(&monte_carlo::kStudy, 200));
  const auto result = run_study(prepared.study, *prepared.model, prepared.plan.poses(), {.threads = 2});
  ASSERT_TRUE(result);
  EXPECT_EQ(bits_of(result->as<monte_carlo::Result>()), run(prepared, {}));
}

TEST(RunStudy, JudgesTheLimitsOfCases) {
  const auto result = run_study(with_cases());
  ASSERT_TRUE(result);
  EXPECT_EQ(result->as<evaluate::Evaluation>().solves.samples(), 2u);
  ASSERT_TRUE(result->verdicts);
  EXPECT_FALSE(result->verdicts->passed());
}

TEST(RunStudy, GivesNothingWhenItIsStopped) {
  const std::atomic<bool> stop = true;
  for (const Study& study : {study_of(&sensitivity::kStudy, 200), study_of(&monte_carlo::kStudy, 200), with_cases()}) {
    EXPECT_FALSE(run_study(study, {.stop = &stop})) << study.analysis.kind->name;
  }
}

TEST(RunStudy, GivesNothingForAShard) {
  EXPECT_FALSE(run_study(study_of(&monte_carlo::kStudy, 200), {.shard = Shard{0, 2}}));
}

TEST(CheckShard, TakesAsManyShardsAsTheStudyHasCellsOrPoses) {
  EXPECT_NO_THROW(check_shard({0, 6}, study_of(&sensitivity::kStudy, 200), 3));
  EXPECT_THROW(check_shard({0, 7}, study_of(&sensitivity::kStudy, 200), 3), InputError);
  EXPECT_NO_THROW(check_shard({2, 3}, study_of(&monte_carlo::kStudy, 200), 3));
  EXPECT_THROW(check_shard({3, 4}, study_of(&monte_carlo::kStudy, 200), 3), InputError);
}

TEST(CheckShard, RefusesAStudyThatNeedsAllPosesAtOnce) {
  Study adaptive = study_of(&sensitivity::kStudy, 4000);
  adaptive.analysis.adaptive = AdaptiveSamples{1000, 0.05};
  EXPECT_THROW(check_shard({0, 2}, adaptive, 3), InputError);
  EXPECT_THROW(check_shard({0, 2}, study_of(&identification::kStudy, 200), 3), InputError);
  EXPECT_THROW(check_shard({0, 2}, study_of(&allocation::kStudy, 200), 3), InputError);
}

}  // namespace
}  // namespace poesy::test
