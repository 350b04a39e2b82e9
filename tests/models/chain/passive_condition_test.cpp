#include "models/chain/passive_condition.h"

#include <gtest/gtest.h>

#include <Eigen/SVD>
#include <cmath>

#include "tests/models/chain/closed_chain.h"
#include "tests/models/chain/random_chain.h"
#include "tests/support/names.h"

namespace poesy::chain {
namespace {

std::vector<lie::Transform<double>> home_frames(const ParallelChain& chain) {
  std::vector<lie::Transform<double>> frames;
  for (const Limb& limb : chain.limbs) frames.insert(frames.end(), limb.home.begin(), limb.home.end());
  return frames;
}

/// The condition number of the Jacobian from its definition. Columns of prismatic joints are multiplied by the reach,
/// rows of translations are divided by it.
double condition_by_differences(const ParallelChain& chain, const std::vector<double>& q) {
  Eigen::MatrixXd j = jacobian(chain, home_frames(chain), q);
  for (Eigen::Index pair = 0; pair < j.rows() / 6; ++pair) j.middleRows(6 * pair + 3, 3) /= chain.reach();
  Eigen::Index column = 0;
  for (const Limb& limb : chain.limbs) {
    for (const Joint& joint : limb.joints) {
      if (joint.actuated) continue;
      if (joint.type == JointType::prismatic) j.col(column) *= chain.reach();
      ++column;
    }
  }
  const Eigen::VectorXd values = j.jacobiSvd().singularValues();
  return values.maxCoeff() / values.minCoeff();
}

ParallelChain scaled(ParallelChain chain, double factor) {
  for (Limb& limb : chain.limbs) {
    for (auto& frame : limb.home) frame.p *= factor;
  }
  return chain;
}

/// The displacements q for a chain that is 1000 times larger: those of prismatic joints grow.
std::vector<double> longer(const ParallelChain& chain, std::vector<double> q) {
  std::size_t joint = 0;
  for (const Limb& limb : chain.limbs) {
    for (const Joint& each : limb.joints) {
      if (each.type == JointType::prismatic) q[joint] *= 1000.0;
      ++joint;
    }
  }
  return q;
}

class PassiveCondition : public testing::TestWithParam<PassiveJoints> {};

TEST_P(PassiveCondition, IsThatOfTheJacobianByDifferences) {
  std::mt19937_64 engine(11);
  for (int n = 0; n < 50; ++n) {
    const std::vector<std::size_t> joints{4, 4, 4};
    const std::vector<double> q = random_displacements(12, 0.8, engine);
    const ParallelChain chain = closed_chain(joints, GetParam(), q, engine);
    const double expected = condition_by_differences(chain, q);
    if (expected > 1e4) continue;  // beyond the digits of finite differences
    EXPECT_NEAR(passive_condition(chain, q) / expected, 1.0, 1e-5) << expected;
  }
}

TEST_P(PassiveCondition, DoesNotDependOnTheUnitOfLength) {
  std::mt19937_64 engine(12);
  const std::vector<std::size_t> joints{4, 4, 4};
  const std::vector<double> q = random_displacements(12, 0.8, engine);
  const ParallelChain chain = closed_chain(joints, GetParam(), q, engine);
  const double expected = passive_condition(chain, q);
  EXPECT_NEAR(passive_condition(scaled(chain, 1000.0), longer(chain, q)) / expected, 1.0, 1e-10);
}

INSTANTIATE_TEST_SUITE_P(Joints, PassiveCondition, testing::Values(PassiveJoints::revolute, PassiveJoints::mixed),
                         test::named({"Revolute", "Mixed"}));

TEST(PassiveConditionOf, TwoPassiveJointsOnOneAxisIsInfinite) {
  std::mt19937_64 engine(13);
  const std::vector<double> q(12, 0.0);
  ParallelChain chain = closed_chain(std::vector<std::size_t>{4, 4, 4}, PassiveJoints::revolute, q, engine);
  chain.limbs[0].joints[0] = chain.limbs[0].joints[1] = {JointType::revolute, false};
  chain.limbs[0].home[1] = lie::Transform<double>{};
  EXPECT_EQ(passive_condition(chain, q), std::numeric_limits<double>::infinity());
}

}  // namespace
}  // namespace poesy::chain
