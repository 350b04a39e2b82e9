#include <gtest/gtest.h>

#include <algorithm>
#include <limits>

#include "engine/kinds/sensitivity/result.h"
#include "engine/report/table.h"
#include "engine/report/tables.h"
#include "tests/engine/kinds/stored.h"

namespace poesy::sensitivity {
namespace {

TEST(SeparationTable, IsInTheOrderOfTheRanking) {
  StoredResult result;
  result.kind = "sensitivity";
  result.factors = {{"q_1", "m"}, {"theta_1", "rad"}, {"b_1", "m"}};
  result.factor_sigma = {1e-3, 1e-2, 1e-3};
  result.responses = {{"position", "m"}};
  set_indices(result, {1.0, 0.5, 0.0});
  EXPECT_EQ(result_tables(result, "position").size(), 1U);
  SeparationResult& found = sensitivity_in(result).separation.emplace();
  const double none = std::numeric_limits<double>::quiet_NaN();
  found.drive_share = {{3}, {1.0, 0.25, none}};
  found.removable = {{3}, {1.0, 0.0625, none}};
  found.removable_together = 0.4321;
  found.measure = "how far the platform moves";
  found.published = {{3}, std::vector<std::string>{"compensable", "non-compensable", ""}};
  EXPECT_EQ(text_of(result_tables(result, "position").at(1), kUnlimitedWidth),
            "What calibration can remove of each error's effect, to first order, over the poses\n"
            "                                drive  removable by\n"
            "rank  error    published class  share   calibration\n"
            "                                  [%]           [%]\n"
            "   1  theta_1  non-compensable     25          6.25\n"
            "   2  q_1      compensable        100        100\n"
            "   3  b_1      -                    -             -\n"
            "effect: how far the platform moves\n"
            "all errors together, at the size the study sets: 43.2 % of the effect is removable\n");
  std::ranges::fill(found.published, "");
  const std::string without_classes = text_of(result_tables(result, "position").at(1), kUnlimitedWidth);
  EXPECT_EQ(without_classes.find("published"), std::string::npos);
  EXPECT_NE(without_classes.find("   1  theta_1     25          6.25\n"), std::string::npos) << without_classes;
}

}  // namespace
}  // namespace poesy::sensitivity
