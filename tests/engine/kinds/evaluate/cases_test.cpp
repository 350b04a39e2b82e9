#include "engine/kinds/evaluate/cases.h"
#include "engine/run/evaluation.h"

#include <gtest/gtest.h>

#include <cmath>

namespace poesy {
namespace {

EvaluationResult evaluation() {
  EvaluationResult result;
  result.poses = 3;
  result.samples = 2;
  result.responses = 1;
  result.response = {1.0, 10.0, 2.0, 20.0, 6.0, 90.0};  // pose by pose
  result.status.assign(6, SolveStatus::converged);
  result.iterations.assign(6, 1);
  return result;
}

TEST(CaseTable, HasARowForEachCase) {
  const std::vector<ErrorCase> cases{{"one", {1.0, 2.0}}, {"two", {3.0, 4.0}}};
  const ErrorTable table = case_table(cases);
  EXPECT_EQ(table.rows, 2u);
  EXPECT_EQ(table.factors, (std::vector<FactorIndex>{FactorIndex(0), FactorIndex(1)}));
  EXPECT_EQ(table.values, (std::vector<double>{1.0, 2.0, 3.0, 4.0}));
}

TEST(CaseResult, TakesMeanAndMaximumOverThePoses) {
  const CaseResult result = case_result(evaluation(), NotConverged::exclude);
  EXPECT_EQ(result.mean, (std::vector<double>{3.0, 40.0}));
  EXPECT_EQ(result.max, (std::vector<double>{6.0, 90.0}));
  EXPECT_EQ(result.count, (std::vector<std::uint64_t>{3, 3}));
}

TEST(CaseResult, LeavesOutWhatDoesNotCount) {
  EvaluationResult some = evaluation();
  some.status[5] = SolveStatus::iteration_cap;
  some.status[4] = SolveStatus::singular;
  const CaseResult exclude = case_result(some, NotConverged::exclude);
  EXPECT_EQ(exclude.mean, (std::vector<double>{1.5, 15.0}));
  EXPECT_EQ(exclude.count, (std::vector<std::uint64_t>{2, 2}));
  const CaseResult include = case_result(some, NotConverged::include);
  EXPECT_EQ(include.mean, (std::vector<double>{1.5, 40.0}));
  some.status.assign(6, SolveStatus::non_finite);
  EXPECT_TRUE(std::isnan(case_result(some, NotConverged::include).mean[0]));
}

}  // namespace
}  // namespace poesy
