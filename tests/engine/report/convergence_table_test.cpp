#include <gtest/gtest.h>

#include "engine/report/tables.h"

namespace poesy {
namespace {

StoredResult example() {
  StoredResult result;
  result.kind = "sensitivity";
  result.factors = {{"a", "m"}, {"b", "rad"}};
  result.responses = {{"x", "m"}, {"y", "m"}};
  result.headline = {1};
  result.sensitivity.convergence = {.min = 1000,
                                    .max = 8000,
                                    .relative_error = 0.01,
                                    .conf_level = 0.95,
                                    .milestones = {1000, 8000},
                                    .quantity = {},
                                    .half_width = {},
                                    .reached = {1, 0, 1, 0},
                                    .relative_half_width = {0.005, 0.02, 0.01, 0.025},
                                    .samples = {1000, 8000}};
  return result;
}

TEST(ConvergenceTable, NamesWhatDidNotReachItTheWidestFirst) {
  EXPECT_EQ(convergence_table(example()),
            "\n"
            "Convergence: 2 of 4 global indices have a 95 % interval within +-1 % of their value, from 1 000 to 8 000 "
            "samples at each pose\n"
            "  b                 y                            2.5 %  about 50 000 samples would do\n"
            "  b                 x                              2 %  about 32 000 samples would do\n"
            "Raise max, which is 8 000, and go on with --resume if the checkpoint was kept\n");
}

TEST(ConvergenceTable, IsOneLineWhenAllReachedIt) {
  StoredResult result = example();
  result.sensitivity.convergence->reached = {1, 1, 1, 1};
  result.sensitivity.convergence->samples = {8000, 8000};
  EXPECT_EQ(
      convergence_table(result),
      "\nConvergence: 4 of 4 global indices have a 95 % interval within +-1 % of their value, 8 000 samples at each "
      "pose\n");
}

TEST(ConvergenceTable, OfAMonteCarloResultSpeaksOfTheHeadline) {
  StoredResult result = example();
  result.kind = "monte-carlo";
  result.monte_carlo.convergence = result.sensitivity.convergence;
  result.monte_carlo.convergence->reached = {0, 1};
  result.monte_carlo.convergence->relative_half_width = {0.02, 0.01};
  result.monte_carlo.convergence->samples = {8000};
  const std::string text = convergence_table(result);
  EXPECT_NE(text.find("1 of 1 overall means"), std::string::npos) << text;
  result.headline = {0, 1};
  EXPECT_NE(convergence_table(result).find("  all errors        x "), std::string::npos);
}

TEST(ConvergenceTable, IsEmptyForFixedSamples) { EXPECT_EQ(convergence_table(StoredResult()), ""); }

}  // namespace
}  // namespace poesy
