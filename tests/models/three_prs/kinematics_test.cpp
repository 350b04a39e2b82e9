#include "models/three_prs/kinematics.h"

#include <gtest/gtest.h>

#include <Eigen/LU>
#include <cmath>
#include <numbers>

#include "models/three_prs/error_mapping.h"
#include "tests/models/three_prs/reference.h"

namespace poesy::three_prs {
namespace {

using nlohmann::json;

TEST(Oracle, InverseKinematics) {
  ASSERT_EQ(oracle().at("ik").size(), 7u);
  for (const json& reference : oracle().at("ik")) {
    const Configuration at =
        configuration({}, {reference.at("alpha"), reference.at("beta"), kMm * double(reference.at("z"))});
    EXPECT_NEAR(at.platform.p.x() / kMm, reference.at("x").get<double>(), 1e-9);
    EXPECT_NEAR(at.platform.p.y() / kMm, reference.at("y").get<double>(), 1e-9);
    const double gamma = std::atan2(-at.platform.R(0, 1), at.platform.R(0, 0));
    EXPECT_NEAR(gamma, reference.at("gamma").get<double>(), 1e-14);
    for (std::size_t i = 0; i < kLimbs; ++i) {
      EXPECT_NEAR(at.limbs[i].q / kMm, reference.at("q")[i].get<double>(), 1e-9);
      EXPECT_NEAR(at.limbs[i].swing, reference.at("theta")[i].get<double>(), 1e-14);
    }
  }
}

Configuration oracle_configuration(const json& reference) {
  const json& pose = reference.at("pose_for_J");
  return configuration({}, {pose[0], pose[1], kMm * double(pose[2])});
}

/// Compares an entry of a matrix with a relative tolerance of 1e-9.
void expect_entry(double found, double expected) { EXPECT_NEAR(found, expected, 1e-9 * std::abs(expected) + 1e-14); }

TEST(Oracle, VelocityJacobianAndErrorMapping) {
  const json& reference = oracle();
  const Configuration at = oracle_configuration(reference);
  const lie::Matrix6<double> J = velocity_jacobian(at);
  const ErrorMapping G = error_mapping({}, at);
  const Effects M = first_order_effects({}, at);
  const std::vector<Factor> list = factors();
  for (std::size_t r = 0; r < 6; ++r) {
    const auto row = static_cast<Eigen::Index>(r);
    for (std::size_t k = 0; k < 6; ++k) {
      expect_entry(J(row, static_cast<Eigen::Index>(k)), double(reference.at("J")[r][k]) * (k < 3 ? kMm : 1.0));
    }
    for (std::size_t f = 0; f < kFactors; ++f) {
      const auto column = static_cast<Eigen::Index>(f);
      const double source_unit = list[f].dimension == Dimension::length ? kMm : 1.0;
      expect_entry(G(row, column), double(reference.at("G")[r][f]) * kMm / source_unit);
      expect_entry(M(row, column), double(reference.at("M")[r][f]) * (r < 3 ? 1.0 : kMm) / source_unit);
    }
  }
  EXPECT_NEAR(J.determinant() / (kMm * kMm * kMm) / double(reference.at("detJ")), 1.0, 1e-12);
}

TEST(Oracle, PosesOfTheTip) {
  ASSERT_EQ(oracle().at("tip").size(), 6u);
  for (const json& reference : oracle().at("tip")) {
    Geometry geometry;
    geometry.h = kMm * double(reference.at("h"));
    const lie::Vector3<double> tip(kMm * double(reference.at("tip")[0]), kMm * double(reference.at("tip")[1]),
                                   kMm * double(reference.at("tip")[2]));
    const Pose pose = pose_of_tip(geometry, tip).value();
    EXPECT_NEAR(pose.alpha, reference.at("alpha").get<double>(), 1e-12);
    EXPECT_NEAR(pose.beta, reference.at("beta").get<double>(), 1e-12);
    EXPECT_NEAR(pose.z / kMm, reference.at("zP").get<double>(), 1e-9);
    const Configuration at = configuration(geometry, pose);
    for (std::size_t i = 0; i < kLimbs; ++i) EXPECT_NEAR(at.limbs[i].q / kMm, reference.at("q")[i].get<double>(), 1e-9);
    EXPECT_LE((at.platform.p + tool(geometry, at.platform.R) - tip).norm(), 1e-15);
  }
}

TEST(PoseOfTip, TrajectoryNeedsALongEnoughTool) {
  // The tip can follow the circle 30 (cos pi t, sin pi t) mm only if h is at least 70.4 mm.
  Geometry geometry;
  for (const auto& [h, exists] : {std::pair(0.0705, true), std::pair(0.0703, false)}) {
    geometry.h = h;
    bool all = true;
    for (int k = 0; k < 360; ++k) {
      const double angle = k * std::numbers::pi / 180.0;
      all = all && pose_of_tip(geometry, {0.03 * std::cos(angle), 0.03 * std::sin(angle), 0.8}).has_value();
    }
    EXPECT_EQ(all, exists) << h;
  }
}

TEST(PoseOfTip, FindsTiltsOf40Degrees) {
  const Geometry g;
  for (const std::vector<double>& pose : random_poses(2000, 9)) {
    const lie::Transform<double> platform = base_T_platform(g, {2.0 * pose[0], 2.0 * pose[1], pose[2]});
    const lie::Vector3<double> tip = platform.p + tool(g, platform.R);
    const auto found = pose_of_tip(g, tip);
    ASSERT_TRUE(found) << 2.0 * pose[0] << ' ' << 2.0 * pose[1];
    const lie::Transform<double> there = base_T_platform(g, *found);
    EXPECT_LE((there.p + tool(g, there.R) - tip).norm(), 2e-15);
  }
}

lie::Vector3<double> carriages(const Geometry& geometry, const Pose& pose) {
  const Configuration at = configuration(geometry, pose);
  return {at.limbs[0].q, at.limbs[1].q, at.limbs[2].q};
}

TEST(PoseOfCarriages, UndoesInverseKinematics) {
  for (const std::vector<double>& pose : random_poses(2000, 6)) {
    const Pose wanted{1.5 * pose[0], 1.5 * pose[1], pose[2]};  // also beyond the default workspace
    const Pose found = pose_of_carriages({}, carriages({}, wanted)).value();
    EXPECT_NEAR(found.alpha, wanted.alpha, 1e-12);
    EXPECT_NEAR(found.beta, wanted.beta, 1e-12);
    EXPECT_NEAR(found.z, wanted.z, 1e-12);
  }
}

TEST(PoseOfCarriages, LevelCarriagesHoldAnUprightPlatformBelow) {
  const Geometry g;
  const Pose pose = pose_of_carriages(g, {0.1, 0.1, 0.1}).value();
  EXPECT_NEAR(pose.alpha, 0.0, 1e-15);
  EXPECT_NEAR(pose.beta, 0.0, 1e-15);
  EXPECT_NEAR(pose.z, 0.1 + std::sqrt(g.l * g.l - (g.a - g.c) * (g.a - g.c)), 1e-15);
}

TEST(PoseOfCarriages, IsNothingWhereTheRodsDoNotReach) {
  // The joints of the platform are at most 2 c apart and no rod is longer than l.
  for (const double apart : {2.0, 5.0, 1e3}) EXPECT_FALSE(pose_of_carriages({}, {0.0, 0.0, apart})) << apart;
  EXPECT_FALSE(pose_of_carriages({}, {0.0, 0.9, 0.0}));
}

/// By a dense grid over all tilts, a pose exists for 14.3 % of such carriage heights: 286 of 2000.
TEST(PoseOfCarriages, FindsWhatThereIs) {
  std::mt19937_64 engine(7);
  std::uniform_real_distribution<double> height(-0.2, 0.7);
  std::size_t found = 0;
  for (int k = 0; k < 2000; ++k) {
    const lie::Vector3<double> q{height(engine), height(engine), height(engine)};
    const auto pose = pose_of_carriages({}, q);
    if (!pose) continue;
    ++found;
    EXPECT_LE((carriages({}, *pose) - q).norm(), 3e-15);
  }
  EXPECT_GT(found, 260u);
}

TEST(VelocityJacobian, IsTheDerivativeOfInverseKinematics) {
  // Fourth-order differences.
  constexpr double kStep = 1e-3;
  constexpr std::array kOffsets{-2.0, -1.0, 1.0, 2.0};
  constexpr std::array kWeights{1.0 / 12.0, -2.0 / 3.0, 2.0 / 3.0, -1.0 / 12.0};
  for (const std::vector<double>& pose : random_poses(50, 1)) {
    const Configuration here = configuration({}, {pose[0], pose[1], pose[2]});
    for (std::size_t k = 0; k < 3; ++k) {
      lie::Screw<double> twist = lie::Screw<double>::Zero();
      lie::Screw<double> rates = lie::Screw<double>::Zero();
      for (std::size_t n = 0; n < kOffsets.size(); ++n) {
        std::vector<double> moved = pose;
        moved[k] += kOffsets[n] * kStep;
        const double weight = kWeights[n] / kStep;
        const Configuration at = configuration({}, {moved[0], moved[1], moved[2]});
        twist.head<3>() += weight * lie::log(lie::Matrix3<double>(at.platform.R * here.platform.R.transpose()));
        twist.tail<3>() += weight * at.platform.p;
        for (std::size_t i = 0; i < kLimbs; ++i) rates[static_cast<Eigen::Index>(i)] += weight * at.limbs[i].q;
      }
      EXPECT_LE((velocity_jacobian(here) * twist - rates).norm(), 1e-8 * rates.norm());
    }
  }
}

TEST(Configuration, LimbsCloseTheirLoops) {
  const Geometry g;
  for (const std::vector<double>& pose : random_poses(200, 2)) {
    const Configuration at = configuration(g, {pose[0], pose[1], pose[2]});
    for (std::size_t i = 0; i < kLimbs; ++i) {
      const LimbConfiguration& limb = at.limbs[i];
      const lie::Vector3<double> carriage = base_R_limb(i) * lie::Vector3<double>(g.a, 0.0, limb.q);
      EXPECT_LE((at.platform.p + limb.c - carriage - g.l * limb.w).norm(), 1e-15);
    }
  }
}

TEST(Condition, IsInfiniteAtASingularPose) {
  Geometry geometry;
  EXPECT_LT(condition(geometry, configuration(geometry, {0.1, -0.2, 0.7})), 20.0);
  // The rods are horizontal: the platform can move while the carriages stand still.
  geometry.l = geometry.a - geometry.c;
  EXPECT_EQ(condition(geometry, configuration(geometry, {0.0, 0.0, 0.7})), std::numeric_limits<double>::infinity());
}

}  // namespace
}  // namespace poesy::three_prs
