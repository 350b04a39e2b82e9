#include "engine/study/poses/unusual_workspace.h"

#include <gtest/gtest.h>

#include "tests/support/fake_model.h"

namespace poesy {
namespace {

const test::FakeModel kModel;

/// The clause about what is unusual in a selection from these ranges of z (m) and beta (rad), with poses at these
/// values of z. The mechanism's workspace has z from -0.3 m to -0.18 m and beta from -0.5 rad to 0.5 rad.
std::string unusual(const Range& z, const std::vector<double>& z_of_poses, const Range& beta = {-0.5, 0.5}) {
  PoseSelection selection;
  selection.workspace = {z, beta, {-0.6, 0.6}};
  std::vector<double> values;
  for (const double value : z_of_poses) values.insert(values.end(), {value, 0.0, 0.0});
  return unusual_workspace(selection, PoseSet(3, values), kModel.description());
}

TEST(UnusualWorkspace, IsNoneThatIsTheMechanismsOrNearIt) {
  EXPECT_EQ(unusual({-0.3, -0.18}, {-0.3, -0.2}), "");
  EXPECT_EQ(unusual({-0.33, -0.15}, {-0.33, -0.32, -0.15}), "") << "wider: the boundary alone is outside";
  EXPECT_EQ(unusual({-0.35, -0.23}, {-0.35, -0.34, -0.33}), "") << "shifted by less than half";
  EXPECT_EQ(unusual_workspace({}, {}, kModel.description()), "") << "a selection without a box";
}

TEST(UnusualWorkspace, IsOneThatIsTiny) {
  EXPECT_EQ(
      unusual({-0.2003, -0.2002}, {-0.2002}),
      "z is from -200.3 mm to -200.2 mm, in the mechanism's workspace from -300 mm to -180 mm; that is less than a "
      "hundredth of it");
  EXPECT_EQ(unusual({-0.2, -0.198}, {-0.2}), "");
}

TEST(UnusualWorkspace, IsOneThatIsApart) {
  const std::string own = ", in the mechanism's workspace from -300 mm to -180 mm";
  EXPECT_EQ(unusual({0.18, 0.3}, {0.2}), "z is from 180 mm to 300 mm" + own);
  EXPECT_EQ(unusual({-3.0, -1.8}, {}), "z is from -3000 mm to -1800 mm" + own);
  EXPECT_EQ(unusual({-0.18, 0.18}, {-0.18}), "z is from -180 mm to 180 mm" + own) << "it touches the other one only";
}

TEST(UnusualWorkspace, IsOneThatIsMostlyOutside) {
  const std::string text =
      "z is from -300 mm to 300 mm, in the mechanism's workspace from -300 mm to -180 mm; most poses are outside it";
  EXPECT_EQ(unusual({-0.3, 0.3}, {-0.2, 0.1, 0.2}), text);
  EXPECT_EQ(unusual({-0.3, 0.3}, {-0.2, -0.18, 0.2, 0.3}), "") << "half of them are not most";
  EXPECT_EQ(unusual({-0.3, 0.3}, {}), "") << "without poses nothing is known of them";
}

TEST(UnusualWorkspace, IsOneOfMoreThanAFullTurn) {
  EXPECT_EQ(unusual({-0.3, -0.18}, {-0.2}, {-20.0, 20.0}),
            "beta is from -1145.92 deg to 1145.92 deg, in the mechanism's workspace from -28.6479 deg to 28.6479 deg; "
            "that is more than a full turn");
  EXPECT_EQ(unusual({-0.3, -0.18}, {-0.2}, {-6.0, 6.0}), "");
}

}  // namespace
}  // namespace poesy
