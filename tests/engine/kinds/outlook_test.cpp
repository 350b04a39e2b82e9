#include "engine/kinds/study_run.h"

#include <gtest/gtest.h>

#include <utility>

#include "engine/kinds/allocation/result.h"
#include "engine/kinds/monte_carlo/result.h"
#include "tests/engine/kinds/study_kinds.h"
#include "tests/support/kinds.h"

namespace poesy::test {
namespace {

/// Does the first piece of each kind of work. Returns the share of the whole work that each piece was.
std::vector<double> first_pieces(const std::vector<WorkOutlook>& all) {
  std::vector<double> shares;
  for (const WorkOutlook& work : all) {
    if (work.prepare) work.prepare();
    shares.push_back(work.do_piece(0.0));
  }
  return shares;
}

TEST(Outlook, CountsTheSolvesOfASensitivityStudy) {
  const Prepared prepared(study_of(&sensitivity::kStudy, 400));
  const Outlook expected = outlook(prepared.study, *prepared.model, prepared.plan.poses());
  EXPECT_EQ(expected.solves, "2 errors x 3 poses x 400 samples = 2400 solves, fewer where series replace them");
  EXPECT_EQ(expected.least, 1.0);
  // A piece is 200 samples. `times` exceeds 1, because the study also solves samples at a tenth of the size.
  EXPECT_EQ(first_pieces(expected.shared), std::vector{200.0 / 2400.0});
  EXPECT_GT(expected.shared.front().times, 1.0);
  EXPECT_TRUE(expected.by_one.empty());
}

TEST(Outlook, NamesBothEndsOfAdaptiveSamples) {
  Study study = study_of(&monte_carlo::kStudy, 4000);
  study.analysis.adaptive = AdaptiveSamples{1000, 0.05};
  const Prepared prepared(study);
  const Outlook expected = outlook(study, *prepared.model, prepared.plan.poses());
  EXPECT_EQ(expected.solves,
            "3 poses x 1000 to 4000 samples of 2 errors together = at least 3000 and at most 12000 solves");
  EXPECT_EQ(expected.least, 0.25);
  EXPECT_EQ(first_pieces(expected.shared), std::vector{200.0 / 12000.0});
}

/// Merging is tried too: all samples of a small study, or whole units of a larger one.
TEST(Outlook, TriesTheMergingOfAStudyThatDrawsPerPose) {
  for (const auto& [samples, tried] : {std::pair<std::size_t, std::size_t>{20, 20}, {2500, 2000}, {40'000, 8000}}) {
    const Prepared prepared(study_of(&monte_carlo::kStudy, samples));
    const Outlook expected = outlook(prepared.study, *prepared.model, prepared.plan.poses());
    const double share = static_cast<double>(tried) / static_cast<double>(samples);
    EXPECT_EQ(first_pieces(expected.merging), std::vector{share}) << samples;
    EXPECT_EQ(expected.merging.front().do_piece(0.5), share) << samples;
    EXPECT_EQ(first_pieces(expected.by_one), std::vector{1.0}) << samples;
  }
}

/// A piece is a unit of machines at all poses. The evaluation at the end of the study is tried at one of three poses
/// and, for the parts over all poses, as a whole.
TEST(Outlook, TriesUnitsOfMachines) {
  for (const auto& [machines, tried] : {std::pair<std::size_t, std::size_t>{30, 30}, {4000, 1000}}) {
    Study study = study_of(&monte_carlo::kStudy, machines);
    study.analysis.draws = Draws::per_machine;
    study.analysis.limits = {{0, 1e-3}};
    asked_of<monte_carlo::Options>(study.analysis).judge = Judge::yield;
    const Prepared prepared(study);
    const Outlook expected = outlook(study, *prepared.model, prepared.plan.poses());
    const double share = static_cast<double>(tried) / static_cast<double>(machines);
    EXPECT_EQ(first_pieces(expected.shared), std::vector{share});
    EXPECT_EQ(first_pieces(expected.merging), std::vector{share});
    for (int again = 0; again < 10; ++again) EXPECT_EQ(expected.merging.front().do_piece(0.0), share);
    EXPECT_EQ(first_pieces(expected.by_one), (std::vector{1.0 / 3.0, 1.0}));
  }
}

/// Only one thread at a time merges, so the merging limits how fast many threads can be.
TEST(Outlook, AddsUpSeconds) {
  const WorkSeconds seconds{.shared = 12.0, .merging = 2.0, .by_one = 0.5};
  EXPECT_EQ(seconds.on(1), 14.5);
  EXPECT_EQ(seconds.on(2), 7.5);
  EXPECT_EQ(seconds.on(7), 2.5);
  EXPECT_EQ(seconds.on(64), 2.5);
  EXPECT_EQ(seconds.on(2, 0.25), 2.25);
}

TEST(Outlook, CountsTheTrialsOfMachinesOfAStudyOfTolerances) {
  Study study = study_of(&allocation::kStudy, 4000);
  study.analysis.draws = Draws::per_machine;
  study.analysis.limits = {{0, 1e-3}};
  asked_of<allocation::Options>(study.analysis).parts = {{.name = "both", .factors = study.analysis.factors}};
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
  Study study = study_of(&evaluate::kStudy, 0);
  asked_of<evaluate::CaseOptions>(study.analysis).cases = {{"one", {1e-3, 0.0, 0.0}}};
  const Prepared prepared(study_of(&sensitivity::kStudy, 10));
  const Outlook expected = outlook(study, *prepared.model, prepared.plan.poses());
  EXPECT_EQ(expected.solves, "1 cases x 3 poses = 3 solves");
  EXPECT_EQ(first_pieces(expected.shared), std::vector{1.0});
  EXPECT_GT(expected.memory.peak(), 0u);
}

}  // namespace
}  // namespace poesy::test
