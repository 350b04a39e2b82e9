#include <gtest/gtest.h>

#include "engine/report/table.h"
#include "engine/report/tables.h"

namespace poesy {
namespace {

const Settling kIndices{"global indices", {"a", "b"}, {0, 1}};

StoredResult example() {
  StoredResult result;
  result.factors = {{"a", "m"}, {"b", "rad"}};
  result.responses = {{"x", "m"}, {"y", "m"}};
  result.convergence = {.min = 1000,
                        .max = 8000,
                        .relative_error = 0.01,
                        .course = {.samples = {1000, 8000}, .value = {}, .half_width = {}, .conf_level = 0.95},
                        .reached = {1, 0, 1, 0},
                        .relative_half_width = {0.005, 0.02, 0.01, 0.025},
                        .samples = {1000, 8000}};
  return result;
}

TEST(ConvergenceTable, NamesWhatDidNotReachItTheWidestFirst) {
  EXPECT_EQ(text_of(convergence_table(example(), kIndices).value(), kUnlimitedWidth),
            "Convergence: 2 of 4 global indices have a 95 % interval within +-1 % of their value, from 1 000 to\n"
            "8 000 samples at each pose\n"
            "                 half the     samples that\n"
            "error  response  interval  would do, about\n"
            "                      [%]\n"
            "b      y              2.5           50 000\n"
            "b      x              2             32 000\n"
            "Raise max, which is 8 000, and go on with --resume if the checkpoint was kept\n");
}

TEST(ConvergenceTable, IsOneSentenceWhenAllReachedIt) {
  StoredResult result = example();
  result.convergence->reached = {1, 1, 1, 1};
  result.convergence->samples = {8000, 8000};
  EXPECT_EQ(text_of(convergence_table(result, kIndices).value(), kUnlimitedWidth),
            "Convergence: 4 of 4 global indices have a 95 % interval within +-1 % of their value, 8 000 samples\n"
            "at each pose\n");
}

TEST(ConvergenceTable, SpeaksOfTheResponsesThatDecide) {
  StoredResult result = example();
  result.convergence->reached = {0, 1};
  result.convergence->relative_half_width = {0.02, 0.01};
  result.convergence->samples = {8000};
  const Table one = convergence_table(result, {"overall means", {"all errors"}, {1}}).value();
  EXPECT_NE(one.caption.find("1 of 1 overall means"), std::string::npos) << one.caption;
  const Table both = convergence_table(result, {"overall means", {"all errors"}, {0, 1}}).value();
  ASSERT_EQ(both.rows.size(), 1U);
  EXPECT_EQ(both.rows[0][0].text, "all errors");
  EXPECT_EQ(both.rows[0][1].text, "x");
}

TEST(ConvergenceTable, IsNotThereForFixedSamples) { EXPECT_FALSE(convergence_table(StoredResult(), kIndices)); }

}  // namespace
}  // namespace poesy
