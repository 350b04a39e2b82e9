// The stages of the search, one by one.

#include "engine/kinds/allocation/search_stages.h"

#include <gtest/gtest.h>

#include <atomic>
#include <cmath>
#include <optional>
#include <utility>
#include <vector>

#include "engine/kinds/allocation/search_constants.h"
#include "engine/random/normal_quantile.h"
#include "tests/engine/kinds/allocation/function_allocation.h"

namespace poesy::allocation {
namespace {

/// A search for the tolerances of a weighted sum, with the objects to which the search refers.
struct Search {
  test::FunctionStudy of = test::weighted_sum_study(20'000);
  PoseSet poses{1, {0.5}};
  RunOptions options{.threads = 2};
  StudyRun run{.study = of.study, .model = of.model, .poses = poses, .options = options};
  SearchProblem problem{run};
  StageLog log = {};
};

TEST(DecidingLoad, IsTheLargestLoadButTheRejects) {
  const std::vector<double> load{0.5, HUGE_VAL, 0.9, 1.2};
  EXPECT_EQ(deciding_load(load, 0), HUGE_VAL);
  EXPECT_EQ(deciding_load(load, 1), 1.2);
  EXPECT_EQ(deciding_load(load, 3), 0.5);
  EXPECT_EQ(deciding_load(load, 9), 0.5);
  EXPECT_EQ(rejects_of(load), 2u);
}

TEST(LargestRatio, IsThatOfEitherOrder) {
  EXPECT_EQ(largest_ratio(std::vector{1.0, 2.0, 3.0}, std::vector{1.0, 0.5, 6.0}), 4.0);
  EXPECT_EQ(largest_ratio(std::vector{0.0, 1.0}, std::vector{0.0, 1.0}), 1.0);
}

// For one linear response the squared slopes and the allowed root mean square are known in closed form.
TEST(Linearise, MeasuresTheSquaresOfSlopes) {
  Search search;
  const Linearised found = linearise(search.problem, search.log);
  for (std::size_t p = 0; p < 3; ++p) {
    const double slope = test::kCoefficients[p];
    EXPECT_NEAR(found.linearisation.squares.slope[p], slope * slope, 1e-9 * slope * slope);
  }
  EXPECT_NEAR(found.candidate.share, 1.0 / normal_quantile(1.0, 0.995), 1e-12);
  EXPECT_EQ(found.candidate.point.tolerance, found.candidate.chosen.tolerance);
  ASSERT_EQ(search.log.stages.size(), 1u);
  EXPECT_EQ(search.log.stages.front().name, "linear");
  EXPECT_EQ(search.log.tolerance, found.candidate.point.tolerance);
}

TEST(Choose, FindsTheLeastShareThatIsFeasible) {
  Search search;
  const Linearised found = linearise(search.problem, search.log);
  // At the finest tolerances, 0.3, the root mean square of the response is sqrt(square). The limit is 1.
  for (AllocatedPart& part : search.of.asked().parts) part.lo = 0.3;
  const SearchProblem bounded(search.run);
  double square = 0.0;
  for (const double slope : test::kCoefficients) square += std::pow(slope * 0.3 / 3.0, 2);
  EXPECT_FALSE(choose(bounded, found.linearisation, 0.999 * std::sqrt(square), {}));
  const auto least = choose_by_least_share(bounded, found.linearisation, 0.1, 1.0, {});
  ASSERT_TRUE(least);
  EXPECT_GE(least->share, std::sqrt(square) * (1.0 - 1e-12));
  EXPECT_LE(least->share, std::sqrt(square) * 1.001);
  EXPECT_FALSE(choose_by_least_share(bounded, found.linearisation, 0.01, 0.9 * std::sqrt(square), {}));
}

TEST(ScaleToYield, UsesAllAllowedRejectsAndScreensTheRest) {
  Search search;
  const Scaled found = scale_to_yield(
      search.problem, settle(search.problem, linearise(search.problem, search.log), search.log), search.log);
  const ToleranceDesign& design = found.design;
  EXPECT_EQ(design.seed, search.of.study.seed);
  EXPECT_EQ(design.load.size(), 20'000u);
  EXPECT_EQ(design.screened.numbers, screen(search.problem, design.load));
  EXPECT_LT(design.screened.numbers.size(), 4000u);
  EXPECT_FALSE(misses_rejects(search.problem, design));
  const double load = deciding_load(design.screened.load, search.problem.allowed.design);
  EXPECT_LE(load, 1.0);
  EXPECT_GE(load, 1.0 - kLoadTolerance);
  const ToleranceDesign exact = scale_screened(search.problem, design, {false, false, false});
  EXPECT_EQ(rejects_of(exact.screened.load), search.problem.allowed.design);
  const ToleranceDesign other = scale_screened(search.problem, design, {true, false, false});
  EXPECT_EQ(other.candidate.point.tolerance[0], design.candidate.point.tolerance[0]);
  EXPECT_GE(other.candidate.point.tolerance[1], design.candidate.point.tolerance[1]);
}

// The response is y = 3 a + b + c / 2. Rejects have a larger |a| than other machines; c hardly differs.
TEST(PartScores, AreLargeForErrorsThatReject) {
  Search search;
  Candidate usual{search.problem.programme.at_most(std::vector{0.6, 0.01, 0.01}), {}, 0.4};
  const ToleranceDesign design = try_all(search.problem, std::move(usual), search.of.study.seed);
  const double least = deciding_load(design.load, 500);
  std::vector<std::uint32_t> largest;
  for (const std::uint32_t machine : design.screened.numbers) {
    if (design.load[machine] > least) largest.push_back(machine);
  }
  const PartScores found = part_scores(search.problem, design, largest);
  EXPECT_GT(found.of_part[0], 2.0 * static_cast<double>(largest.size()));
  EXPECT_TRUE(found.is_sure[0]);
  EXPECT_FALSE(found.is_sure[2]);
}

TEST(UnlessStopped, ThrowsForNoValue) {
  EXPECT_EQ(unless_stopped(std::optional(3)), 3);
  EXPECT_THROW(unless_stopped(std::optional<int>()), SearchStopped);
}

TEST(FindTolerances, IsEmptyWhenStopped) {
  const test::FunctionStudy of = test::weighted_sum_study(20'000);
  std::atomic<bool> stop = true;
  EXPECT_FALSE(run_study(of.study, of.model, PoseSet(1, {0.5}), {.threads = 2, .stop = &stop}));
}

}  // namespace
}  // namespace poesy::allocation
