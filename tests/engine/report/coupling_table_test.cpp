#include "engine/report/coupling_table.h"

#include <gtest/gtest.h>

#include <limits>

#include "engine/report/tables.h"

namespace poesy {
namespace {

StoredResult example() {
  StoredResult result;
  result.kind = "coupling";
  result.responses = {{"tilt", "rad"}, {"x", "m"}};
  result.headline = {1};
  StoredCoupling& stored = result.coupling;
  stored.size_names = {"0.1 mm"};
  stored.linear = {1e-4};
  stored.angular = {std::numeric_limits<double>::quiet_NaN()};
  stored.sources = {"FS", "T"};
  stored.subsets = {"FS", "T", "FS+T"};
  CouplingResult& found = stored.found;
  found.responses = 2;
  found.sizes = 1;
  found.subsets = 3;
  found.poses = 4;
  found.count.assign(6, 4);
  found.effect_max = {0.0, 0.0, 0.0, 4e-5, 1e-5, 3.5e-5};
  found.effect_max_pose = {0, 0, 0, 3, 0, 3};
  found.interaction_max = {0.0, 0.0, 0.0, 0.0, 0.0, 1e-8};
  found.worst_case_max = {0.0, 0.0, 0.0, 4e-5, 1e-5, 4.5e-5};
  found.root_sum_square_max = {0.0, 0.0, 0.0, 4e-5, 1e-5, 4.125e-5};
  found.opposed_share = {0.0, 0.0, 0.0, 0.0, 0.0, 0.75};
  found.cancellation_max = {0.0, 0.0, 0.0, 0.0, 0.0, 0.5};
  found.cancellation_max_pose = {0, 0, 0, 0, 0, 2};
  return result;
}

TEST(CouplingTable, ShowsEachHeadlineResponseAtEachSize) {
  EXPECT_EQ(
      result_tables(example(), "x"),
      "2 sources of errors, alone and together; largest values over 4 poses. interaction: together minus the sum "
      "of each\nalone. opposed: share of the poses where the sum is less than its largest part\n"
      "\n"
      "0.1 mm: x [mm]\n"
      "subset  max|effect|   pose            rss     worst case    interaction    opposed  cancellation\n"
      "FS             0.04      3           0.04           0.04              0\n"
      "T              0.01      0           0.01           0.01              0\n"
      "FS+T          0.035      3        0.04125          0.045          1e-05     75.0 %     50.0 % at pose 2\n");
}

TEST(CouplingTable, SaysWherePosesAreLeftOut) {
  StoredResult result = example();
  result.coupling.found.count[4] = 3;
  EXPECT_NE(coupling_table(result).find("some subsets leave out poses"), std::string::npos);
}

TEST(CouplingTable, CallsRoundingZero) {
  StoredResult result = example();
  result.coupling.found.interaction_max[5] = 1e-15;
  EXPECT_EQ(coupling_table(result).find("e-"), std::string::npos);
}

}  // namespace
}  // namespace poesy
