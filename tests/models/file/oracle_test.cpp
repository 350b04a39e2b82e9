#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "models/file/mobility.h"
#include "models/file/tracking.h"
#include "tests/models/file/files.h"

namespace poesy::file {
namespace {

using nlohmann::json;

const json& oracle() {
  static const json all = json::parse(std::ifstream(POESY_TEST_DATA "/mechanisms.json"));
  return all["mechanisms"];
}

Vector3 vector(const json& list) { return {list[0].get<double>(), list[1].get<double>(), list[2].get<double>()}; }

class Oracle : public testing::TestWithParam<const char*> {
 protected:
  const json& expected() const { return oracle()[GetParam()]; }
  const Mechanism mechanism_ = from_file(GetParam());
};

TEST_P(Oracle, HomeFramesOfEveryJoint) {
  std::size_t n = 0;
  for (std::size_t i = 0; i < mechanism_.limbs.size(); ++i) {
    Transform g;
    for (std::size_t j = 0; j < mechanism_.limbs[i].joints.size(); ++j, ++n) {
      const Joint& joint = mechanism_.limbs[i].joints[j];
      const json& wanted = expected()["joints"][n];
      EXPECT_EQ(wanted["limb"], i + 1);
      EXPECT_EQ(wanted["joint"], j + 1);
      EXPECT_EQ(wanted["name"], joint.name);
      EXPECT_EQ(wanted["type"], joint.motion == Motion::prismatic ? "P" : "R");
      EXPECT_EQ(wanted["actuated"], joint.actuated);
      EXPECT_LE((joint.at_home.p - vector(wanted["point"])).norm(), 1e-14);
      EXPECT_LE((joint.at_home.R.col(2) - vector(wanted["z"])).norm(), 1e-14);
      EXPECT_LE((joint.at_home.R.col(0) - vector(wanted["x"])).norm(), 1e-14);
      g = g * mechanism_.limbs[i].home[j];
      EXPECT_LE((g.p - joint.at_home.p).norm() + (g.R - joint.at_home.R).norm(), 1e-14);
    }
    g = g * mechanism_.limbs[i].home.back();
    EXPECT_LE((g.p - mechanism_.platform.p).norm() + (g.R - mechanism_.platform.R).norm(), 1e-14);
  }
  EXPECT_EQ(n, expected()["joints"].size());
}

TEST_P(Oracle, Mobility) {
  const Mobility found = home_mobility(mechanism_);
  const json& wanted = expected()["mobility"];
  EXPECT_EQ(found.joints, wanted["joints"]);
  EXPECT_EQ(found.actuated, wanted["actuated"]);
  EXPECT_EQ(found.rank, wanted["rank"]);
  EXPECT_EQ(found.loop_equations, wanted["loop_equations"]);
  EXPECT_EQ(found.freedoms, wanted["freedoms"]);
  EXPECT_EQ(found.over_constraints, wanted["over_constraints"]);
  EXPECT_EQ(found.platform_freedoms, wanted["platform_freedoms"]);
  EXPECT_EQ(found.platform_rotates, wanted["platform_rotates"]);
  EXPECT_EQ(found.idle, wanted["idle"]);
  EXPECT_EQ(found.left_when_locked, wanted["left_when_locked"]);
  EXPECT_EQ(found.coordinates_rank, wanted["coordinates_rank"]);
  EXPECT_NEAR(found.above_gap(), wanted["singular_values_at_gap_home"][0].get<double>(), 1e-12);
  EXPECT_EQ(found.below_gap().has_value(), !wanted["singular_values_at_gap_home"][1].is_null());
  EXPECT_LE(found.below_gap().value_or(0.0), 1e-14);
  EXPECT_NO_THROW(check_mobility(mechanism_, found));
  const std::vector<PoseMobility> poses = workspace_mobility(mechanism_);
  EXPECT_NO_THROW(check_mobility(mechanism_, found, poses));
  for (const PoseMobility& pose : poses) {
    ASSERT_EQ(pose.tracked.unreachable, "");
    EXPECT_EQ(pose.mobility.rank, found.rank);
    EXPECT_EQ(pose.mobility.left_when_locked, 0u);
    EXPECT_EQ(pose.mobility.coordinates_rank, found.coordinates_rank);
  }
}

TEST_P(Oracle, MetricPoints) {
  if (expected()["metric_points_from"] != "default") GTEST_SKIP() << "the study names them";
  ASSERT_EQ(mechanism_.points.size(), expected()["metric_points"].size());
  for (std::size_t k = 0; k < mechanism_.points.size(); ++k) {
    EXPECT_LE((mechanism_.points[k] - vector(expected()["metric_points"][k])).norm(), 1e-15);
  }
}

TEST_P(Oracle, DisplacementsAndPlatformAtEveryPose) {
  const Tracker tracker(mechanism_);
  const std::vector<JointDisplacement> names = displacement_names(mechanism_);
  for (const json& wanted : expected()["poses"]) {
    std::vector<double> pose;
    for (const Coordinate& coordinate : mechanism_.coordinates)
      pose.push_back(wanted["pose"][coordinate.name].get<double>());
    const Tracked found = tracker.track(pose);
    ASSERT_EQ(found.unreachable, "");
    ASSERT_EQ(wanted["q"].size(), names.size());
    for (std::size_t k = 0; k < names.size(); ++k) {
      EXPECT_NEAR(found.displacements[k], wanted["q"][names[k].name].get<double>(), 1e-13) << names[k].name;
    }
    EXPECT_LE((found.platform.p - vector(wanted["position"])).norm(), 1e-14);
    for (int row = 0; row < 3; ++row) {
      const Vector3 of_row = found.platform.R.row(row).transpose();
      EXPECT_LE((of_row - vector(wanted["rotation"][static_cast<std::size_t>(row)])).norm(), 1e-13);
    }
  }
}

/// The errors of the mechanism file are those of the oracle's cases.
TEST_P(Oracle, NamesOfErrors) {
  const json& errors = expected()["cases"][0]["errors"];
  EXPECT_EQ(mechanism_.factors.size(), errors.size());
  for (const Factor& factor : mechanism_.factors) EXPECT_TRUE(errors.contains(factor.name)) << factor.name;
}

INSTANTIATE_TEST_SUITE_P(Files, Oracle, testing::Values("rps3", "ups6", "upr2-rpu"), [](const auto& instance) {
  std::string name = instance.param;
  std::erase(name, '-');
  return name;
});

}  // namespace
}  // namespace poesy::file
