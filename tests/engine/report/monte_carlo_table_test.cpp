#include <gtest/gtest.h>

#include <limits>

#include "engine/report/tables.h"
#include "engine/report/text_table.h"

namespace poesy {
namespace {

StoredResult example() {
  StoredResult result;
  result.kind = "monte-carlo";
  result.factors = {{"delta_1", "m"}, {"epsilon_1", "rad"}};
  result.responses = {{"linear_deformation", "m"}, {"ratio", "1"}};
  result.headline = {0, 1};
  MonteCarloResult& found = result.monte_carlo;
  found.responses = 2;
  found.poses = 3;
  found.quantile_relative_error = 1.0 / 512.0;
  found.levels = {0.5, 0.95};
  found.mean = {1e-3, 4e-3, 1e-3, 0.5, 0.25, 0.75};
  found.quantiles = {1e-3, 9e-3, 4e-3, 8e-3, 1e-3, 7e-3, 0.5, 1.0, 0.25, 2.0, 0.75, 1.5};
  found.overall_mean = {2e-3, 0.5};
  found.overall_std = {1.5e-3, 0.125};
  found.overall_count = {36000, 2};
  found.overall_min = {1e-6, 0.0625};
  found.overall_max = {1.25e-2, 3.0};
  found.overall_quantiles = {1.75e-3, 8.5e-3, 0.4375, 1.25};
  found.solves.resize(3);
  for (SolveCounts& solves : found.solves) solves.by_status[0] = 12000;
  return result;
}

TEST(MonteCarloTable, ShowsAllPosesTogetherAndTheWorst) {
  EXPECT_EQ(text_of(result_tables(example(), "linear_deformation"), kUnlimitedWidth),
            "2 errors vary together: responses over the samples of all 3 poses\n"
            "response            unit  mean    std       rms     min   q_0.5  q_0.95   max\n"
            "linear_deformation  mm     2    1.5    2.49999   0.001   1.75      8.5   12.5\n"
            "ratio               1      0.5  0.125  0.507752  0.0625  0.4375    1.25   3\n"
            "12 000 samples at each pose; std: standard deviation; rms: root mean square; q_0.95: 95 % of the\n"
            "samples lie below it (quantiles to 0.2 % of their value)\n"
            "\n"
            "Pose by pose: the mean of the poses' means, and the worst poses\n"
            "                          mean of  largest    at  largest    at\n"
            "response            unit    means     mean  pose   q_0.95  pose\n"
            "linear_deformation  mm        2       4        1        9     0\n"
            "ratio               1         0.5     0.75     2        2     1\n");
}

TEST(MonteCarloTable, NamesTheWorstOfThePosesThatAreKnown) {
  StoredResult result = example();
  result.monte_carlo.mean[0] = std::numeric_limits<double>::quiet_NaN();
  const Table poses = monte_carlo_tables(result).at(1);
  EXPECT_EQ(poses.rows[0][2].text, "-");
  EXPECT_FALSE(poses.rows[0][2].value);
  EXPECT_EQ(poses.rows[0][4].text, "1");
}

TEST(MonteCarloTable, ShowsTheHeadlineAlone) {
  StoredResult result = example();
  result.headline = {1};
  for (const Table& table : monte_carlo_tables(result)) {
    ASSERT_EQ(table.rows.size(), 1U);
    EXPECT_EQ(table.rows[0][0].text, "ratio");
  }
}

TEST(DefaultRanking, IsTheFirstLengthOfTheHeadline) {
  StoredResult result = example();
  result.responses = {{"x", "m"}, {"rotation", "rad"}, {"position", "m"}};
  result.headline = {1, 2};
  EXPECT_EQ(default_ranking(result), "position");
  result.headline = {1};
  EXPECT_EQ(default_ranking(result), "rotation");
}

TEST(SummaryText, ShowsNoControlCharacterOfATitle) {
  StoredResult result = example();
  result.title = "\x1b[31mred\x07";
  EXPECT_TRUE(summary_text(result, kUnlimitedWidth).starts_with("?[31mred?\n"));
}

TEST(MonteCarloTable, CountsOnePoseAsOne) {
  StoredResult result = example();
  result.factors.resize(1);
  result.monte_carlo.poses = 1;
  EXPECT_EQ(monte_carlo_tables(result).at(0).caption, "1 error varies together: responses over the samples of 1 pose");
}

TEST(FailuresText, CountsTheSolvesOfAllPosesOnce) {
  StoredResult result = example();
  result.monte_carlo.solves[2].by_status[2] = 360;
  EXPECT_EQ(failures_text(result, "r.h5", kUnlimitedWidth), "360 of 36 360 solves (0.99 %) did not converge\n");
  result.monte_carlo.failures = {{0, PoseIndex{2}, {SampleIndex{7}, SolveStatus::iteration_cap}}};
  EXPECT_EQ(failures_text(result, "my r.h5", 80),
            "360 of 36 360 solves (0.99 %) did not converge\n"
            "the first of them (error, pose, sample): all 2 7, iteration_cap; failures.csv of\n"
            "'poesy export' lists 1 of the 360 (at most 10 of each pose, and 1 000 in all)\n"
            "replay it: poesy replay 'my r.h5' all 2 7\n");
}

}  // namespace
}  // namespace poesy
