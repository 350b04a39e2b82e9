#include "engine/kinds/evaluate/cases.h"
#include "engine/run/evaluation.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <utility>
#include <vector>

#include "tests/support/elements.h"

namespace poesy::evaluate {
namespace {

using test::elements;

EvaluationResult evaluation() {
  EvaluationResult result;
  result.response = {{1, 3, 2}, {1.0, 10.0, 2.0, 20.0, 6.0, 90.0}};
  result.status = decltype(result.status)({3, 2}, SolveStatus::converged);
  result.iterations = decltype(result.iterations)({3, 2}, 1);
  return result;
}

const std::vector<ErrorCase> kCases{{"one", {1.0, 2.0}}, {"two", {3.0, 4.0}}};

Evaluation of_cases(EvaluationResult solves, NotConverged policy) {
  return evaluation_of_cases(std::move(solves), kCases, {}, policy);
}

TEST(CaseTable, HasARowForEachCase) {
  const ErrorTable table = case_table(kCases);
  EXPECT_EQ(table.rows, 2u);
  EXPECT_EQ(table.factors, (std::vector<FactorIndex>{FactorIndex(0), FactorIndex(1)}));
  EXPECT_EQ(table.values, (std::vector<double>{1.0, 2.0, 3.0, 4.0}));
}

TEST(Evaluation, TakesMeanAndExtremeOverThePoses) {
  const Evaluation result = of_cases(evaluation(), NotConverged::exclude);
  EXPECT_EQ(elements(result.mean), (std::vector<double>{3.0, 40.0}));
  EXPECT_EQ(elements(result.extreme), (std::vector<double>{6.0, 90.0}));
  EXPECT_EQ(elements(result.count), (std::vector<std::uint64_t>{3, 3}));
}

TEST(Evaluation, TheExtremeHasTheLargestMagnitudeAndItsSign) {
  EvaluationResult some = evaluation();
  some.response = {{1, 3, 2}, {-0.2345, 3.0, 0.1, -2.0, -0.2135, -4.0}};
  EXPECT_EQ(elements(of_cases(some, NotConverged::exclude).extreme), (std::vector<double>{-0.2345, -4.0}));
}

TEST(Evaluation, LeavesOutWhatDoesNotCount) {
  EvaluationResult some = evaluation();
  some.status(2, 1) = SolveStatus::iteration_cap;
  some.status(2, 0) = SolveStatus::singular;
  const Evaluation exclude = of_cases(some, NotConverged::exclude);
  EXPECT_EQ(elements(exclude.mean), (std::vector<double>{1.5, 15.0}));
  EXPECT_EQ(elements(exclude.count), (std::vector<std::uint64_t>{2, 2}));
  const Evaluation include = of_cases(some, NotConverged::include);
  EXPECT_EQ(elements(include.mean), (std::vector<double>{1.5, 40.0}));
  std::ranges::fill(some.status, SolveStatus::non_finite);
  EXPECT_TRUE(std::isnan(of_cases(some, NotConverged::include).mean(0, 0)));
}

}  // namespace
}  // namespace poesy::evaluate
