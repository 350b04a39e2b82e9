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

/// By finite differences of the limbs' poses: columns of prismatic joints times the unit of length, rows of
/// translations divided by it.
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

/// Displacements of a chain that is a thousand times as large.
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
    if (expected > 1e4) continue;  // differences have no more digits
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

/// Points of the platform, in its frame.
const std::vector<lie::Vector3<double>> kPoints{{0.2, 0.0, 0.1}, {-0.1, 0.3, 0.0}, {0.0, -0.2, -0.1}};

double condition_by_metric(const ParallelChain& chain, std::span<const double> q,
                           const std::vector<lie::Vector3<double>>& points) {
  const Metric metric = platform_metric(chain, points, q);
  return passive_condition(chain, q, &metric);
}

TEST_P(PassiveCondition, ByMetricIsOfThePoints) {
  std::mt19937_64 engine(15);
  for (int n = 0; n < 50; ++n) {
    const std::vector<double> q = random_displacements(12, 0.8, engine);
    const ParallelChain chain = closed_chain(std::vector<std::size_t>{4, 4, 4}, GetParam(), q, engine);
    const Eigen::MatrixXd j = jacobian(chain, home_frames(chain), q);
    const lie::Transform<double> platform = platform_pose(chain.limbs[0], chain.limbs[0].home, std::span(q).first(4));
    Eigen::MatrixXd moved = Eigen::MatrixXd::Zero(j.rows() / 6 * 9, j.cols());  // the points, for each pair
    for (Eigen::Index pair = 0; pair < j.rows() / 6; ++pair) {
      for (Eigen::Index a = 0; a < 3; ++a) {
        const lie::Vector3<double> point = platform.R * kPoints[static_cast<std::size_t>(a)] + platform.p;
        moved.middleRows(9 * pair + 3 * a, 3) =
            j.middleRows(6 * pair + 3, 3) - lie::hat<double>(point) * j.middleRows(6 * pair, 3);
      }
    }
    for (Eigen::Index column = 0; column < j.cols(); ++column) moved.col(column) /= moved.col(column).norm();
    const Eigen::VectorXd values = moved.jacobiSvd().singularValues();
    const double expected = values.maxCoeff() / values.minCoeff();
    if (expected > 1e4) continue;  // differences have no more digits
    EXPECT_NEAR(condition_by_metric(chain, q, kPoints) / expected, 1.0, 1e-5) << expected;
  }
}

TEST_P(PassiveCondition, ByMetricHasNoUnitNorFrame) {
  std::mt19937_64 engine(16);
  const std::vector<double> q = random_displacements(12, 0.8, engine);
  const ParallelChain chain = closed_chain(std::vector<std::size_t>{4, 4, 4}, GetParam(), q, engine);
  const double expected = condition_by_metric(chain, q, kPoints);

  std::vector<lie::Vector3<double>> larger_points = kPoints;
  for (lie::Vector3<double>& point : larger_points) point *= 1000.0;
  EXPECT_NEAR(condition_by_metric(scaled(chain, 1000.0), longer(chain, q), larger_points) / expected, 1.0, 1e-9);

  ParallelChain moved = chain;
  const lie::Transform<double> move = lie::exp(lie::random_screw(2.0, engine));
  for (Limb& limb : moved.limbs) limb.home[0] = move * limb.home[0];
  EXPECT_NEAR(condition_by_metric(moved, q, kPoints) / expected, 1.0, 1e-9);
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
