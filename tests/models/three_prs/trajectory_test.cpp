#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "engine/study/poses/pose_selection.h"
#include "tests/models/three_prs/reference.h"

namespace poesy::three_prs {
namespace {

std::unique_ptr<Model> with_tool(double h) {
  Geometry g;
  return catalog_entry().build(std::vector{g.a, g.c, g.l, g.rail, h}, 0);
}

/// A selection of poses along a whole curve of the paper, from its default origin.
PoseSelection curve(const Model& model, std::size_t position, std::size_t points) {
  const NamedCurve& curve = model.description().curves.at(position);
  PoseSelection selection;
  selection.select = PoseSelection::Select::trajectory;
  selection.trajectory.emplace();
  selection.trajectory->curve = position;
  selection.trajectory->origin = curve.origin;
  selection.trajectory->points = points;
  selection.trajectory->time = Range{curve.start, curve.end};
  return selection;
}

lie::Vector3<double> tip_at(std::span<const double> pose) {
  const Geometry g;
  const lie::Transform<double> platform = base_T_platform(g, {pose[0], pose[1], pose[2]});
  return platform.p + tool(g, platform.R);
}

TEST(Curves, OfThePaperAreFollowedByTheTip) {
  const auto model = published("exact");
  ASSERT_EQ(model->description().curves.size(), 2u);
  for (std::size_t position = 0; position < 2; ++position) {
    const SelectedPoses selected = select_poses(curve(*model, position, 401), *model);
    ASSERT_EQ(selected.poses.size(), 401u);
    EXPECT_EQ(selected.time.front(), 0.0);
    EXPECT_EQ(selected.time.back(), 2.0);
    for (std::size_t m = 0; m < 401; ++m) {
      const double t = selected.time[m];
      const double radius = position == 0 ? 30.0 : 15.0 * t;
      const lie::Vector3<double> wanted(radius * std::cos(std::numbers::pi * t),
                                        radius * std::sin(std::numbers::pi * t),
                                        850.0 + (position == 0 ? 30.0 : 15.0) * t);
      EXPECT_LE((tip_at(selected.poses[PoseIndex(m)]) / kMm - wanted).norm(), 1e-9) << position << " at " << t;
      EXPECT_LT(selected.condition[m], 3.0);
    }
  }
}

TEST(Helix, NeedsATool) {
  for (const double h : {0.060, 0.0703}) {
    const auto model = with_tool(h);
    EXPECT_THROW(static_cast<void>(select_poses(curve(*model, 0, 361), *model)), InputError) << h;
  }
  const auto model = with_tool(0.0705);
  EXPECT_EQ(select_poses(curve(*model, 0, 361), *model).poses.size(), 361u);
}

TEST(Charts, GiveTheSamePose) {
  const auto model = published("exact");
  for (const std::vector<double>& pose : random_poses(100, 8)) {
    const lie::Vector3<double> tip = tip_at(pose);
    const std::vector<double> joints = model->joint_displacements(pose);
    const auto by_tip = model->pose_from_chart(0, std::vector{tip.x(), tip.y(), tip.z()}).value();
    const auto by_carriages = model->pose_from_chart(1, std::vector{joints[0], joints[2], joints[4]}).value();
    for (std::size_t k = 0; k < 3; ++k) {
      EXPECT_NEAR(by_tip[k], pose[k], 1e-12);
      EXPECT_NEAR(by_carriages[k], pose[k], 1e-12);
    }
  }
}

}  // namespace
}  // namespace poesy::three_prs
