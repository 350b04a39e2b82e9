#include "engine/kinds/study_run.h"

#include <gtest/gtest.h>

#include "engine/kinds/allocation/result.h"
#include "tests/engine/kinds/study_kinds.h"
#include "tests/support/kinds.h"

namespace poesy::test {
namespace {

/// Does the first piece of each work; the shares that these were.
std::vector<double> first_pieces(const std::vector<WorkOutlook>& all) {
  std::vector<double> shares;
  for (const WorkOutlook& work : all) shares.push_back(work.do_piece(0.0));
  return shares;
}

TEST(Outlook, CountsTheSolvesOfASensitivityStudy) {
  const Prepared prepared(study_of(&kSensitivityStudy, 400));
  const Outlook expected = outlook(prepared.study, *prepared.model, prepared.plan.poses());
  EXPECT_EQ(expected.solves, "2 errors x 3 poses x 400 samples = 2400 solves");
  EXPECT_EQ(expected.least, 1.0);
  // A piece is 200 samples; the solves at a tenth of the size come to the study's own.
  EXPECT_EQ(first_pieces(expected.shared), std::vector{200.0 / 2400.0});
  EXPECT_GT(expected.shared.front().times, 1.0);
  EXPECT_TRUE(expected.by_one.empty());
}

TEST(Outlook, NamesBothEndsOfAdaptiveSamples) {
  Study study = study_of(&kMonteCarloStudy, 4000);
  study.analysis.adaptive = AdaptiveSamples{1000, 0.05};
  const Prepared prepared(study);
  const Outlook expected = outlook(study, *prepared.model, prepared.plan.poses());
  EXPECT_EQ(expected.solves,
            "3 poses x 1000 to 4000 samples of 2 errors together = at least 3000 and at most 12000 solves");
  EXPECT_EQ(expected.least, 0.25);
  EXPECT_EQ(first_pieces(expected.shared), std::vector{200.0 / 12000.0});
}

TEST(Outlook, CountsTheTrialsOfMachinesOfAStudyOfTolerances) {
  Study study = study_of(&kAllocationStudy, 4000);
  study.analysis.draws = Draws::per_machine;
  study.analysis.limits = {{0, 1e-3}};
  asked_of<AllocationOptions>(study.analysis).parts = {{.name = "both", .factors = study.analysis.factors}};
  const Prepared prepared(study);
  const Outlook expected = outlook(study, *prepared.model, prepared.plan.poses());
  EXPECT_EQ(expected.solves, "about 5 x 3 poses x 4000 machines and 7e+03 for the effects of 2 errors: 6.7e+04 solves");
  EXPECT_EQ(expected.least, 1.0);
  EXPECT_GT(expected.memory.peak(), 4 * 4000 * sizeof(double));
  const std::vector<double> shares = first_pieces(expected.shared);
  ASSERT_EQ(shares.size(), 1u);
  EXPECT_GT(shares.front(), 0.0);
  EXPECT_LT(shares.front(), 0.1);
  EXPECT_TRUE(expected.by_one.empty());
}

TEST(Outlook, TriesAFewPosesOfATable) {
  Study study = study_of(&kEvaluateStudy, 0);
  asked_of<CaseOptions>(study.analysis).cases = {{"one", {1e-3, 0.0, 0.0}}};
  const Prepared prepared(study_of(&kSensitivityStudy, 10));
  const Outlook expected = outlook(study, *prepared.model, prepared.plan.poses());
  EXPECT_EQ(expected.solves, "1 cases x 3 poses = 3 solves");
  EXPECT_EQ(first_pieces(expected.shared), std::vector{1.0});
  EXPECT_GT(expected.memory.peak(), 0u);
}

}  // namespace
}  // namespace poesy::test
