#include "models/chain/limb.h"

#include <gtest/gtest.h>

#include "tests/models/chain/random_chain.h"

namespace poesy::chain {
namespace {

double difference(const lie::Transform<double>& a, const lie::Transform<double>& b) {
  return std::max((a.R - b.R).cwiseAbs().maxCoeff(), (a.p - b.p).cwiseAbs().maxCoeff());
}

lie::Screw<double> joint_screw(JointType type) { return lie::Screw<double>::Unit(type == JointType::revolute ? 2 : 5); }

TEST(Limb, ForwardKinematicsIsTheProductOfExponentials) {
  std::mt19937_64 engine(3);
  for (const std::size_t joints : {1u, 2u, 4u, 7u}) {
    const Limb limb = random_limb(joints, engine);
    const std::vector<double> q = random_displacements(joints, 2.0, engine);
    lie::Transform<double> product = limb.home[0];  // Du et al. 2022, Eq. 13, factor by factor
    for (std::size_t j = 0; j < joints; ++j) {
      product = product * lie::exp(lie::Screw<double>(q[j] * joint_screw(limb.joints[j].type))) * limb.home[j + 1];
    }
    EXPECT_LE(difference(platform_pose(limb, limb.home, q), product), 1e-14);
  }
}

TEST(Limb, SpatialJacobianMatchesFiniteDifferences) {
  std::mt19937_64 engine(5);
  for (const std::size_t joints : {2u, 4u, 6u}) {
    const Limb limb = random_limb(joints, engine);
    std::vector<double> q = random_displacements(joints, 1.5, engine);
    std::vector<lie::Screw<double>> columns(limb.passive_joints());
    forward_kinematics<double>(limb, limb.home, q,
                               [&](std::size_t k, const lie::Screw<double>& column) { columns[k] = column; });
    std::size_t passive = 0;
    for (std::size_t j = 0; j < joints; ++j) {
      if (limb.joints[j].actuated) continue;
      const double h = 1e-5;
      const double at = q[j];
      q[j] = at + h;
      const lie::Transform<double> ahead = platform_pose(limb, limb.home, q);
      q[j] = at - h;
      const lie::Transform<double> behind = platform_pose(limb, limb.home, q);
      q[j] = at;
      const lie::Screw<double> slope = lie::log(ahead * behind.inverse()) / (2 * h);
      EXPECT_LE((columns[passive++] - slope).norm(), 1e-9);
    }
    EXPECT_EQ(passive, limb.passive_joints());
  }
}

TEST(Limb, ErrorMultipliesFromTheLeftButAtTheLastFrame) {
  std::mt19937_64 engine(9);
  const Limb limb = random_limb(3, engine);
  FrameError<double> error;
  error << 0.02, -0.01, 0.03, 0.001, 0.002, -0.003;
  const lie::Transform<double> delta{lie::exp(lie::Vector3<double>(error.head<3>())), error.tail<3>()};
  EXPECT_LE(difference(frame_with_error(limb, 1, error), delta * limb.home[1]), 1e-15);
  EXPECT_LE(difference(frame_with_error(limb, 3, error) * delta, limb.home[3]), 1e-15);
  const FrameError<double> none = FrameError<double>::Zero();
  EXPECT_LE(difference(frame_with_error(limb, 2, none), limb.home[2]), 0.0);
}

}  // namespace
}  // namespace poesy::chain
