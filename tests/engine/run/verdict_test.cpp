#include "engine/kinds/monte_carlo/columns.h"
#include "engine/kinds/monte_carlo/result.h"
#include "engine/run/evaluation.h"
#include "tests/support/elements.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>

namespace poesy {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();
constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();

/// A result with two responses at two poses, with four draws at each pose. One draw was not solved.
monte_carlo::Result draws() {
  monte_carlo::Result found;
  found.overall_rms = {{2}, {2.0, 0.5}};
  found.share_magnitude = {{2, 2}, {3.0, 4.0, 1.0, 0.75}};
  found.solves.resize(2);
  found.solves[0].by_status = {4, 0, 0, 0, 0};
  found.solves[1].by_status = {3, 0, 1, 0, 0};
  return found;
}

/// The sketches of the seven solved draws over both poses. Samples of the first response are magnitudes, those of the
/// second have both signs.
std::vector<QuantileSketch> overall() {
  std::vector<QuantileSketch> sketches(2);
  sketches[0].add(std::vector{1.0, 1.0, 2.0, 3.0, 1.0, 1.0, 2.0});
  sketches[1].add(std::vector{-0.75, 0.25, 0.5, -0.25, 0.125, -0.125, 0.5});
  return sketches;
}

LimitVerdicts judged(Judge judge, const ValueLimit& first, const ValueLimit& second,
                     const monte_carlo::Result& found = draws()) {
  const std::vector<ResponseLimit> limits{{0, first}, {1, second}};
  return monte_carlo::judge_draws(limits, judge, 0.5, found, overall());
}

TEST(JudgeDraws, ByRootMeanSquareUpToTheLimitItself) {
  const LimitVerdicts verdicts = judged(Judge::rms, 2.0, 0.49);
  ASSERT_EQ(verdicts.limits.size(), 2u);
  EXPECT_TRUE(verdicts.limits[0].passed);
  EXPECT_EQ(verdicts.limits[0].value, 2.0);
  EXPECT_EQ(verdicts.limits[0].limit, 2.0);
  EXPECT_FALSE(verdicts.limits[0].pose);
  EXPECT_FALSE(verdicts.limits[1].passed);
  EXPECT_FALSE(verdicts.passed());
  EXPECT_TRUE(judged(Judge::rms, 2.0, 0.5).passed());
}

TEST(JudgeDraws, ByTheWorstPoseOfAShare) {
  const LimitVerdicts verdicts = judged(Judge::share, 3.5, 1.0);
  EXPECT_FALSE(verdicts.limits[0].passed);
  EXPECT_EQ(verdicts.limits[0].value, 4.0);
  EXPECT_EQ(verdicts.limits[0].pose, 1u);
  EXPECT_TRUE(verdicts.limits[1].passed);
  EXPECT_EQ(verdicts.limits[1].pose, 0u);
}

/// All eight draws are counted, by magnitude. The draw that was not solved is not within the limit.
TEST(JudgeDraws, CountsTheDrawsWithinTheLimit) {
  const LimitVerdicts verdicts = judged(Judge::rms, 2.5, 0.375);
  EXPECT_EQ(verdicts.limits[0].tried, 8u);
  EXPECT_EQ(verdicts.limits[0].within, 6u);
  EXPECT_EQ(verdicts.limits[1].within, 4u);
}

TEST(JudgeDraws, RefusesWhatIsNotKnown) {
  monte_carlo::Result found = draws();
  found.overall_rms(0) = kNaN;
  EXPECT_FALSE(judged(Judge::rms, 1e9, 1.0, found).limits[0].passed);
  found.share_magnitude(0, 1) = kInfinity;
  EXPECT_FALSE(judged(Judge::share, 1e9, 1.0, found).limits[0].passed);
}

/// value_at_rank() is the value of this rank if values are sorted by how far they are beyond the limit.
TEST(ValueAtRank, IsTheWorstOfTheShare) {
  QuantileSketch sketch;
  sketch.add(std::vector{-3.0, -1.0, 0.0, 0.5, 2.0, 4.0});
  const ValueLimit ends = ValueLimit::between(-1.0, 3.0);  // 4 is beyond by 1, -3 by 2
  EXPECT_EQ(monte_carlo::value_at_rank(sketch, ends, 6), -3.0);
  EXPECT_EQ(monte_carlo::value_at_rank(sketch, ends, 5), 4.0);
  EXPECT_EQ(monte_carlo::value_at_rank(sketch, ends, 4), -1.0);
  EXPECT_TRUE(std::isnan(monte_carlo::value_at_rank(sketch, ends, 7)));
  EXPECT_EQ(monte_carlo::value_at_rank(sketch, 1.0, 5), 3.0);
  EXPECT_EQ(monte_carlo::value_at_rank(sketch, 1.0, 7), kInfinity);
}

TEST(JudgeDraws, BetweenTwoEndsByTheWorstPose) {
  monte_carlo::Result found = draws();
  found.share_magnitude = {{2, 2}, {3.0, -1.5, 1.0, 0.75}};
  const LimitVerdict beyond = judged(Judge::share, ValueLimit::between(-1.0, 4.0), 1.0, found).limits[0];
  EXPECT_FALSE(beyond.passed);
  EXPECT_EQ(beyond.value, -1.5);
  EXPECT_EQ(beyond.pose, 1u);
  EXPECT_TRUE(judged(Judge::share, ValueLimit::between(-2.0, 4.0), 1.0, found).limits[0].passed);
  EXPECT_EQ(judged(Judge::share, 5.0, ValueLimit::between(-0.125, 0.3), found).limits[1].within, 3u);
  found.share_magnitude(0, 0) = kNaN;
  EXPECT_FALSE(judged(Judge::share, ValueLimit::between(-1e9, kInfinity), 1.0, found).limits[0].passed);
}

/// Solves of two rows at three poses. Row 1 has the larger values, with both signs.
EvaluationResult evaluation() {
  EvaluationResult result;
  result.response = {{1, 3, 2}, {1.0, 10.0, 2.0, -90.0, 6.0, 20.0}};
  result.status = decltype(result.status)({3, 2}, SolveStatus::converged);
  return result;
}

LimitVerdict judged(const ValueLimit& limit, const EvaluationResult& found,
                    NotConverged policy = NotConverged::exclude) {
  const std::vector<ResponseLimit> limits{{0, limit}};
  return judge_rows(limits, found, Pairing::every_pose_with_every_row, policy).limits.at(0);
}

TEST(JudgeRows, ByTheLargestMagnitudeOfEachRow) {
  const LimitVerdict kept = judged(90.0, evaluation());
  EXPECT_TRUE(kept.passed);
  EXPECT_EQ(kept.value, 90.0);
  EXPECT_EQ(kept.row, 1u);
  EXPECT_EQ(kept.pose, 1u);
  const LimitVerdict missed = judged(50.0, evaluation());
  EXPECT_FALSE(missed.passed);
  EXPECT_EQ(missed.tried, 2u);
  EXPECT_EQ(missed.within, 1u);
  EXPECT_EQ(judged(5.0, evaluation()).within, 0u);
}

TEST(JudgeRows, ByTwoEndsByAShareOfThePosesAndByTheSpread) {
  // Row 0 is 1, 2, 6 and row 1 is 10, -90, 20.
  const LimitVerdict ends = judged(ValueLimit::between(-50.0, 20.0), evaluation());
  EXPECT_EQ(ends.within, 1u);
  EXPECT_EQ(ends.value, -90.0);
  EXPECT_EQ(ends.row, 1u);
  EXPECT_EQ(ends.pose, 1u);
  EXPECT_EQ(judged(ValueLimit::between(-kInfinity, 20.0), evaluation()).within, 2u);
  const LimitVerdict share = judged(ValueLimit::between(-50.0, 15.0).at_share(0.6), evaluation());
  EXPECT_EQ(share.within, 1u);
  EXPECT_EQ(share.value, 20.0);
  EXPECT_EQ(share.pose, 2u);
  EXPECT_TRUE(judged(ValueLimit::between(-50.0, 20.0).at_share(0.6), evaluation()).passed);
  const LimitVerdict spread = judged(ValueLimit::of_spread(5.0), evaluation());
  EXPECT_EQ(spread.within, 1u);
  EXPECT_EQ(spread.value, 110.0);
  EXPECT_EQ(spread.row, 1u);
  EXPECT_FALSE(spread.pose);
}

/// A row that was not solved at one pose is within no limit, even if its other values are.
TEST(JudgeRows, RefusesARowThatWasNotSolvedEverywhere) {
  EvaluationResult some = evaluation();
  some.status(2, 0) = SolveStatus::iteration_cap;  // row 0 at the last pose
  const LimitVerdict exclude = judged(100.0, some);
  EXPECT_FALSE(exclude.passed);
  EXPECT_EQ(exclude.within, 1u);
  EXPECT_TRUE(judged(100.0, some, NotConverged::include).passed);
  std::ranges::fill(some.status, SolveStatus::singular);
  EXPECT_TRUE(std::isnan(judged(100.0, some, NotConverged::include).value));
  EXPECT_FALSE(judged(100.0, some, NotConverged::include).row);
}

TEST(JudgeRows, TakesEachRowAtItsOwnPoseRowByRow) {
  EvaluationResult paired;
  paired.response = {{1, 6, 1}, test::elements(evaluation().response)};
  paired.status = decltype(paired.status)({6, 1}, SolveStatus::converged);
  const std::vector<ResponseLimit> limits{{0, 10.0}};
  const LimitVerdict verdict = judge_rows(limits, paired, Pairing::row_by_row, NotConverged::exclude).limits.at(0);
  EXPECT_EQ(verdict.tried, 6u);
  EXPECT_EQ(verdict.within, 4u);
  EXPECT_EQ(verdict.row, 3u);
  EXPECT_EQ(verdict.pose, 3u);
  EXPECT_FALSE(verdict.passed);
}

}  // namespace
}  // namespace poesy
