#include <gtest/gtest.h>

#include <limits>

#include "engine/kinds/sensitivity/result.h"
#include "engine/report/table.h"
#include "engine/report/tables.h"
#include "tests/engine/kinds/stored.h"

namespace poesy::sensitivity {
namespace {

constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();
constexpr double kInfinity = std::numeric_limits<double>::infinity();

StoredResult example() {
  StoredResult result;
  result.kind = "sensitivity";
  result.factors = {{"q_1", "m"}, {"theta_1", "rad"}, {"b_1", "m"}, {"c_1", "m"}};
  result.factor_sigma = {1e-3, 1e-2, 1e-3, 1e-3};
  result.responses = {{"x", "m"}, {"y", "m"}};
  set_indices(result, {1.0, 0.5, 0.0, 0.0, 1.0, 0.5, 0.0, 0.0});
  FidelityResult& found = sensitivity_in(result).fidelity.emplace();
  found.fidelities = {"exact", "first-order"};
  found.relative_discrepancy = {{2, 4}, {1e-4, 0.01, kNaN, kInfinity, 2e-5, -0.04, kNaN, kNaN}};
  found.nonlinearity = {{2, 4}, {5e-4, 0.07, kNaN, kInfinity, 6e-4, 0.03, kNaN, kNaN}};
  found.linear = {{4}, {1, 0, 1, 0}};
  found.not_converged = {{4, 1}, {0, 2, 0, 1100}};
  return result;
}

TEST(FidelityTable, ShowsTheLargestOfEachErrorAndTheVerdict) {
  const StoredResult result = example();
  EXPECT_EQ(text_of(result_tables(result, "x").at(1), kUnlimitedWidth),
            "Fidelity \"first-order\" against \"exact\" on the same draws\n"
            "rank  error    discrepancy  largest for   nonlinearity  largest for   verdict\n"
            "                       [%]                         [%]\n"
            "   1  theta_1        -4     y                     7     x             not linear\n"
            "   2  q_1             0.01  x                     0.06  y             linear\n"
            "   3  b_1                -  -                        -  -             no effect\n"
            "   4  c_1        no effect  by the first     no effect  by the first  not linear\n"
            "2 of 4 errors are not linear: they differ by more than 1 %, at the size the study sets\n"
            "discrepancy: of the index, in percent of the error's largest; nonlinearity: of mean and spread, in\n"
            "percent of its largest effect\n"
            "1 102 solves at fidelity \"first-order\" did not converge\n");
}

TEST(FidelityTable, IsThereForTwoFidelitiesAlone) {
  StoredResult result = example();
  sensitivity_in(result).fidelity.reset();
  EXPECT_EQ(result_tables(result, "x").size(), 1U);
}

}  // namespace
}  // namespace poesy::sensitivity
