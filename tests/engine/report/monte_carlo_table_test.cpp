#include <gtest/gtest.h>

#include "engine/report/tables.h"

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
  found.overall_min = {1e-6, 0.0625};
  found.overall_max = {1.25e-2, 3.0};
  found.overall_quantiles = {1.75e-3, 8.5e-3, 0.4375, 1.25};
  found.solves.resize(3);
  for (SolveCounts& solves : found.solves) solves.by_status[0] = 12000;
  return result;
}

TEST(MonteCarloTable, ShowsAllPosesTogetherAndTheWorst) {
  EXPECT_EQ(result_tables(example(), "linear_deformation"),
            "2 errors vary together, 12 000 samples at each of 3 poses; quantiles to 0.2 % of their value\n"
            "\n"
            "all poses together       unit          mean           std           min         q_0.5        q_0.95       "
            "    max\n"
            "linear_deformation         mm             2           1.5         0.001          1.75           8.5       "
            "   12.5\n"
            "ratio                       1           0.5         0.125        0.0625        0.4375          1.25       "
            "      3\n"
            "\n"
            "over the poses           unit mean of means            largest mean          largest q_0.95\n"
            "linear_deformation         mm             2             4    pose 1             9    pose 0\n"
            "ratio                       1           0.5          0.75    pose 2             2    pose 1\n");
}

TEST(MonteCarloTable, NamesTheWorstOfThePosesThatAreKnown) {
  StoredResult result = example();
  result.monte_carlo.mean[0] = std::numeric_limits<double>::quiet_NaN();
  const std::string table = monte_carlo_table(result);
  EXPECT_NE(table.find("pose 1"), std::string::npos) << table;
}

TEST(MonteCarloTable, ShowsTheHeadlineAlone) {
  StoredResult result = example();
  result.headline = {1};
  const std::string table = monte_carlo_table(result);
  EXPECT_EQ(table.find("linear_deformation"), std::string::npos) << table;
  EXPECT_NE(table.find("ratio"), std::string::npos) << table;
}

TEST(DefaultRanking, IsTheFirstLengthOfTheHeadline) {
  StoredResult result = example();
  result.responses = {{"x", "m"}, {"rotation", "rad"}, {"position", "m"}};
  result.headline = {1, 2};
  EXPECT_EQ(default_ranking(result), "position");
  result.headline = {1};
  EXPECT_EQ(default_ranking(result), "rotation");
}

TEST(SummaryText, CountsTheSolvesOfAllPoses) {
  StoredResult result = example();
  result.monte_carlo.solves[2].by_status[2] = 360;
  EXPECT_NE(summary_text(result).find("360 solves (0.99 %) did not converge"), std::string::npos)
      << summary_text(result);
}

}  // namespace
}  // namespace poesy
