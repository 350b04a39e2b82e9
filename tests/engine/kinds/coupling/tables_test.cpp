#include <gtest/gtest.h>

#include <algorithm>
#include <limits>

#include "engine/kinds/coupling/coupling.h"
#include "engine/report/table.h"
#include "engine/report/tables.h"
#include "tests/engine/kinds/stored.h"

namespace poesy::coupling {
namespace {

StoredResult example() {
  StoredResult result;
  result.kind = "coupling";
  result.pose_coordinates = {{"z", "m"}, {"gamma", "rad"}};
  result.poses = PoseSet(2, {-0.3, 0.0, -0.25, 0.0, -0.2, 0.0, -0.18, 0.1});
  result.factors = {{"a", "m"}, {"b", "m"}};
  result.responses = {{"tilt", "rad"}, {"x", "m"}};
  result.signed_headline = {1};
  Result& found = coupling_in(result);
  found.size_names = {"0.1 mm"};
  found.linear = decltype(found.linear)({1}, 1e-4);
  found.angular = decltype(found.angular)({1}, std::numeric_limits<double>::quiet_NaN());
  found.sources = {"FS", "T"};
  found.subsets = {"FS", "T", "FS+T"};
  found.effect = Result::Curves({2, 1, 3, 4});
  found.worst_case = found.effect;  // the tables show only the maxima over the poses
  found.count = Result::Summary<std::uint64_t>({2, 1, 3}, 4);
  found.effect_max = {{2, 1, 3}, {0.0, 0.0, 0.0, 4e-5, 1e-5, 3.5e-5}};
  found.effect_max_pose = {{2, 1, 3}, {0, 0, 0, 3, 0, 3}};
  found.interaction_max = {{2, 1, 3}, {0.0, 0.0, 0.0, 0.0, 0.0, 1e-8}};
  found.rounding = {{2, 1}, {1e-14, 1e-14}};
  found.first_order_sum_max = {{2, 1, 3}, {0.0, 0.0, 0.0, 4e-5, 1e-5, 4.5e-5}};
  found.worst_case_max = {{2, 1, 3}, {0.0, 0.0, 0.0, 4e-5, 1e-5, 5.5e-5}};
  found.worst_case_max_pose = {{2, 1, 3}, {0, 0, 0, 3, 0, 3}};
  found.worst_case_signs = {{2, 1, 3, 2}, {1, 0, 0, 1, 1, 1, 1, 0, 0, 1, 1, -1}};
  found.corners = decltype(found.corners)({1, 3, 4}, 4);
  found.unsolved_corners = decltype(found.unsolved_corners)({1, 3, 4}, 0);
  found.unsolved_pose = {{1, 3}, {-1, -1, -1}};
  found.unsolved_signs = decltype(found.unsolved_signs)({1, 3, 2}, 0);
  found.root_sum_square_max = {{2, 1, 3}, {0.0, 0.0, 0.0, 4e-5, 1e-5, 4.125e-5}};
  found.opposed_share = {{2, 1, 3}, {0.0, 0.0, 0.0, 0.0, 0.0, 0.75}};
  found.cancellation_max = {{2, 1, 3}, {0.0, 0.0, 0.0, 0.0, 0.0, 0.5}};
  found.cancellation_max_pose = {{2, 1, 3}, {0, 0, 0, 0, 0, 2}};
  return result;
}

TEST(CouplingTable, ShowsEachHeadlineResponseAtEachSize) {
  EXPECT_EQ(text_of(result_tables(example(), "x"), kUnlimitedWidth),
            "0.1 mm: x [mm]\n"
            "        largest    at                             root sum  first-order  worst                            "
            "            "
            "at\n"
            "subset   effect  pose  largest where                square          sum   case  interaction  opposed  "
            "cancellation  "
            "pose  cancelled where\n"
            "           [mm]                                       [mm]         [mm]   [mm]         [mm]      [%]      "
            "     [%]\n"
            "FS        0.04      3  z -180 mm, gamma 5.73 deg   0.04           0.04   0.04         0            -      "
            "       -     "
            "-  -\n"
            "T         0.01      0  z -300 mm, gamma 0 deg      0.01           0.01   0.01         0            -      "
            "       -     "
            "-  -\n"
            "FS+T      0.035     3  z -180 mm, gamma 5.73 deg   0.04125        0.045  0.055        1e-05       75      "
            "      50     "
            "2  z -200 mm, gamma 0 deg\n"
            "worst case of FS+T: pose 3 (z -180 mm, gamma 5.73 deg), with +a, -b\n"
            "2 sources of errors, alone and together; largest values over 4 poses\n"
            "interaction: together minus the sum of each alone\n"
            "worst case: the largest value that was found with either sign of each error: the signs by which the\n"
            "magnitudes of each alone add up (first-order sum), solved together, then flipped one by one until no\n"
            "flip is worse. No bound: other signs, or sizes in between, may do more\n"
            "opposed: share of the poses where the sum is less than its largest part, cancellation: by how much\n"
            "at most; a norm, which has no sign, cannot tell\n");
}

TEST(CouplingTable, NamesCornersThatCannotBeAssembled) {
  StoredResult result = example();
  EXPECT_EQ(coupling_tables(result).back().notes.front(),
            "worst case of FS+T: pose 3 (z -180 mm, gamma 5.73 deg), with +a, -b");
  Result& found = coupling_in(result);
  found.unsolved_corners = {{1, 3, 4}, {0, 0, 0, 0, 0, 0, 0, 0, 1, 0, 2, 0}};
  found.unsolved_pose = {{1, 3}, {-1, -1, 0}};
  found.unsolved_signs = {{1, 3, 2}, {0, 0, 0, 0, -1, -1}};
  EXPECT_EQ(coupling_tables(result).back().notes[5],
            "3 of the 48 combinations of signs that were tried have no solution, so worst cases are of the others; the "
            "first: 0.1 mm of FS+T, pose 0 (z -300 mm, gamma 0 deg), with -a, -b");
}

TEST(CouplingTable, SaysWherePosesAreLeftOut) {
  StoredResult result = example();
  coupling_in(result).count(1, 0, 1) = 3;
  const std::string note = coupling_tables(result).back().notes.back();
  EXPECT_NE(note.find("some subsets leave out poses"), std::string::npos) << note;
}

TEST(CouplingTable, SaysWhySymmetricSourcesCancel) {
  StoredResult result = example();
  result.study_text = "[analysis]\nlimbs = \"all\"\n";
  EXPECT_EQ(coupling_tables(result).back().notes.size(), 5U) << "every source does something";
  coupling_in(result).effect_max(1, 0, 1) = 0.0;
  EXPECT_TRUE(coupling_tables(result).back().notes.back().starts_with("all limbs have the same error here"));
  result.study_text = "[analysis]\nlimbs = \"independent\"\n";
  EXPECT_EQ(coupling_tables(result).back().notes.size(), 5U);
}

TEST(CouplingTable, NamesNoPoseOfRounding) {
  StoredResult result = example();
  coupling_in(result).effect_max(1, 0, 1) = 1e-16;
  const std::vector<Cell> row = coupling_tables(result)[0].rows[1];
  EXPECT_EQ(row[1].text, "0");
  EXPECT_EQ(row[2].text, "-");
  EXPECT_EQ(row[3].text, "-");
}

TEST(CouplingTable, CallsRoundingZero) {
  StoredResult result = example();
  coupling_in(result).interaction_max(1, 0, 2) = 1e-15;
  const Table table = coupling_tables(result)[0];
  const auto column = std::ranges::find(table.columns, "interaction_max", &Column::name) - table.columns.begin();
  const Cell& cell = table.rows[2][static_cast<std::size_t>(column)];
  EXPECT_EQ(cell.text, "0");
  EXPECT_DOUBLE_EQ(cell.value.value(), 1e-12);
}

}  // namespace
}  // namespace poesy::coupling
