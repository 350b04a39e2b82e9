#include "models/two_upr_rpu/kinematics.h"

#include <gtest/gtest.h>

#include <cmath>
#include <random>
#include <span>

namespace poesy::two_upr_rpu {
namespace {

std::vector<Pose> random_poses(std::size_t count) {
  std::mt19937_64 engine(41);
  std::uniform_real_distribution<double> z(-0.30, -0.18), beta(-0.6, 0.6), gamma(-1.0, 1.0);
  std::vector<Pose> poses;
  for (std::size_t n = 0; n < count; ++n) poses.push_back({z(engine), beta(engine), gamma(engine)});
  return poses;
}

TEST(Kinematics, EveryLimbReachesThePlatformAtNominalDisplacements) {
  const Geometry geometry;
  const chain::ParallelChain chain = parallel_chain(geometry);
  for (const Pose& pose : random_poses(500)) {
    const auto q = joint_displacements(geometry, pose);
    const lie::Transform<double> wanted = base_T_platform(pose);
    for (std::size_t i = 0; i < 3; ++i) {
      const chain::Limb& limb = chain.limbs[i];
      const auto reached = chain::forward_kinematics<double>(limb, limb.home, std::span(q).subspan(4 * i, 4),
                                                             [](std::size_t, const lie::Screw<double>&) {});
      EXPECT_LE((reached.R - wanted.R).cwiseAbs().maxCoeff(), 1e-14);
      EXPECT_LE((reached.p - wanted.p).cwiseAbs().maxCoeff(), 1e-14);
    }
  }
}

TEST(Kinematics, PlatformRotationIsThePrintedMatrix) {
  for (const Pose& pose : random_poses(50)) {
    const double cb = std::cos(pose.beta), sb = std::sin(pose.beta);
    const double cg = std::cos(pose.gamma), sg = std::sin(pose.gamma);
    lie::Matrix3<double> printed;  // Eq. 12
    printed << cg, 0, sg, sb * sg, cb, -sb * cg, -cb * sg, sb, cb * cg;
    EXPECT_LE((base_T_platform(pose).R - printed).cwiseAbs().maxCoeff(), 1e-15);
  }
}

TEST(Kinematics, LegLengthsArePrintedEquationTwo) {
  const Geometry g;
  for (const Pose& pose : random_poses(50)) {
    const double cb = std::cos(pose.beta), sb = std::sin(pose.beta);
    const double cg = std::cos(pose.gamma), sg = std::sin(pose.gamma);
    const double y = -pose.z * std::tan(pose.beta);
    const double leg1 = std::hypot(g.l_A * cg - g.l_B, g.l_A * sb * sg + y, -g.l_A * cb * sg + pose.z);
    const double leg2 = std::hypot(-g.l_A * cg + g.l_B, -g.l_A * sb * sg + y, g.l_A * cb * sg + pose.z);
    const double leg3 = std::hypot(g.l_A * cb + y - g.l_B, g.l_A * sb + pose.z);
    const double home = std::hypot(g.l_A - g.l_B, g.z_0);
    const auto q = joint_displacements(g, pose);
    EXPECT_NEAR(q[2], leg1 - home, 1e-15);
    EXPECT_NEAR(q[6], leg2 - home, 1e-15);
    EXPECT_NEAR(q[9], leg3 - home, 1e-15);
  }
}

TEST(Kinematics, AnglesAreThePrintedArccosWithoutPassingLegs) {
  const Geometry g;
  const auto arccos = [](const lie::Vector3<double>& a, const lie::Vector3<double>& b) {
    return std::acos(a.dot(b) / (a.norm() * b.norm()));
  };
  const auto angles = [&](const Pose& pose) {
    const auto [R, p] = base_T_platform(pose);
    const lie::Vector3<double> x(1, 0, 0), y(0, 1, 0), u = R.col(0), v = R.col(1);
    const lie::Vector3<double> leg1 = p + g.l_A * u - g.l_B * x, leg2 = p - g.l_A * u + g.l_B * x,
                               leg3 = p + g.l_A * v - g.l_B * y;
    // Eqs. 4, 5, 7, 8, 9, 10 as printed.
    return std::array{arccos(x, leg1),  -arccos(u, leg1), arccos(x, leg2),
                      arccos(-u, leg2), arccos(-y, leg3), arccos(v, leg3)};
  };
  const auto home = angles({g.z_0, 0.0, 0.0});
  constexpr std::array<std::size_t, 6> joint{1, 3, 5, 7, 8, 10};
  for (Pose pose : random_poses(200)) {
    pose.gamma *= 0.6;
    const auto q = joint_displacements(g, pose);
    const auto printed = angles(pose);
    for (std::size_t k = 0; k < joint.size(); ++k) EXPECT_NEAR(q[joint[k]], printed[k] - home[k], 1e-13);
  }
}

TEST(Kinematics, HomeHasNoDisplacement) {
  for (const double q : joint_displacements({}, {-0.2, 0.0, 0.0})) EXPECT_EQ(q, 0.0);
}

}  // namespace
}  // namespace poesy::two_upr_rpu
