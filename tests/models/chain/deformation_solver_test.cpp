#include "models/chain/deformation_solver.h"

#include <gtest/gtest.h>

#include <limits>

#include "models/two_upr_rpu/kinematics.h"
#include "tests/models/chain/closed_chain.h"

namespace poesy::chain {
namespace {

/// A chain of limbs with revolute joints. The platform frames coincide if all displacements are zero.
ParallelChain closed_chain(std::size_t limbs, std::size_t joints, std::mt19937_64& engine) {
  const std::vector<double> zero(limbs * joints, 0.0);
  return closed_chain(std::vector<std::size_t>(limbs, joints), PassiveJoints::revolute, zero, engine);
}

std::vector<lie::Transform<double>> frames_with_random_errors(const ParallelChain& chain, double size,
                                                              std::mt19937_64& engine) {
  std::normal_distribution<double> normal(0.0, size);
  std::vector<lie::Transform<double>> frames;
  for (const Limb& limb : chain.limbs) {
    for (std::size_t j = 0; j < limb.frames(); ++j) {
      FrameError<double> error;
      for (double& value : error) value = normal(engine);
      frames.push_back(frame_with_error(limb, j, error));
    }
  }
  return frames;
}

struct Shape {
  std::size_t limbs;
  std::size_t joints;
};

class AnyChain : public testing::TestWithParam<Shape> {};

TEST_P(AnyChain, EndsAtAFixedPointOfTheDefinition) {
  std::mt19937_64 engine(17);
  for (int n = 0; n < 10; ++n) {
    const ParallelChain chain = closed_chain(GetParam().limbs, GetParam().joints, engine);
    const auto frames = frames_with_random_errors(chain, 1e-3, engine);
    DeformationSolver solve(chain, {});
    std::vector<double> q(chain.joints(), 0.0);
    std::vector<double> delta_mu(6 * chain.pairs.size());
    const Deformation found = solve.solve(frames, q, delta_mu);
    ASSERT_TRUE(solved(found.status)) << kStatusNames[static_cast<std::size_t>(found.status)];
    const Eigen::Map<const Eigen::VectorXd> reported(delta_mu.data(), static_cast<Eigen::Index>(delta_mu.size()));
    EXPECT_LE((reported - residual(chain, frames, q)).cwiseAbs().maxCoeff(), 1e-15);
    EXPECT_LE((jacobian(chain, frames, q).transpose() * reported).cwiseAbs().maxCoeff(), 1e-11);
    EXPECT_GT(reported.norm(), 1e-6) << "an over-constrained chain with errors everywhere must deform";
  }
}

TEST_P(AnyChain, ActuatedJointsStay) {
  std::mt19937_64 engine(19);
  const ParallelChain chain = closed_chain(GetParam().limbs, GetParam().joints, engine);
  const auto frames = frames_with_random_errors(chain, 1e-3, engine);
  std::vector<double> q(chain.joints(), 0.0);
  std::vector<double> delta_mu(6 * chain.pairs.size());
  DeformationSolver(chain, {}).solve(frames, q, delta_mu);
  std::size_t joint = 0;
  for (const Limb& limb : chain.limbs) {
    for (const Joint& each : limb.joints) EXPECT_EQ(each.actuated, q[joint++] == 0.0);
  }
}

INSTANTIATE_TEST_SUITE_P(Shapes, AnyChain, testing::Values(Shape{2, 3}, Shape{3, 3}, Shape{3, 4}, Shape{5, 3}),
                         [](const auto& shape) {
                           return std::to_string(shape.param.limbs) + "_limbs_of_" + std::to_string(shape.param.joints);
                         });

class Scheme1 : public testing::Test {
 protected:
  ParallelChain chain_ = two_upr_rpu::parallel_chain({});
  std::vector<double> q_ = [] {
    const auto nominal = two_upr_rpu::joint_displacements({}, {-0.24, 0.2, -0.3});
    return std::vector<double>(nominal.begin(), nominal.end());
  }();
  std::vector<double> delta_mu_ = std::vector<double>(18);

  std::vector<lie::Transform<double>> frames_with(std::size_t frame, std::size_t component, double value) const {
    std::vector<lie::Transform<double>> frames;
    for (const Limb& limb : chain_.limbs) {
      for (std::size_t j = 0; j < limb.frames(); ++j) {
        FrameError<double> error = FrameError<double>::Zero();
        if (frames.size() == frame) error[static_cast<Eigen::Index>(component)] = value;
        frames.push_back(frame_with_error(limb, j, error));
      }
    }
    return frames;
  }
};

TEST_F(Scheme1, PerfectPartsDoNotDeform) {
  const Deformation found = DeformationSolver(chain_, {}).solve(frames_with(0, 0, 0.0), q_, delta_mu_);
  EXPECT_TRUE(solved(found.status));
  for (const double value : delta_mu_) EXPECT_LE(std::abs(value), 1e-15);
}

TEST_F(Scheme1, ReportsTheIterationCap) {
  SolverOptions options;
  options.max_iterations = 2;
  const Deformation found = DeformationSolver(chain_, options).solve(frames_with(0, 1, 0.02), q_, delta_mu_);
  EXPECT_EQ(found.status, SolveStatus::iteration_cap);
  EXPECT_EQ(found.iterations, 2u);
}

TEST_F(Scheme1, StopsAtTheTolerance) {
  SolverOptions loose;
  loose.tolerance = 1e-6;
  std::vector<double> start = q_;
  const Deformation rough = DeformationSolver(chain_, loose).solve(frames_with(0, 1, 0.02), start, delta_mu_);
  const std::vector<double> rough_residual = delta_mu_;
  const Deformation exact = DeformationSolver(chain_, {}).solve(frames_with(0, 1, 0.02), q_, delta_mu_);
  EXPECT_EQ(rough.status, SolveStatus::converged);
  EXPECT_LT(rough.iterations, exact.iterations);
  for (std::size_t k = 0; k < delta_mu_.size(); ++k) EXPECT_NEAR(rough_residual[k], delta_mu_[k], 1e-5);
}

TEST_F(Scheme1, RecognisesStagnationAtRounding) {
  SolverOptions unreachable;
  unreachable.tolerance = 1e-300;
  unreachable.max_iterations = 500;
  int stagnated = 0;
  for (int n = 1; n <= 40; ++n) {
    std::vector<double> start = q_;
    const Deformation found =
        DeformationSolver(chain_, unreachable).solve(frames_with(1, 0, 1e-3 * n), start, delta_mu_);
    EXPECT_TRUE(solved(found.status));
    EXPECT_LT(found.iterations, 100u);
    if (found.status == SolveStatus::stagnated) ++stagnated;
  }
  EXPECT_GT(stagnated, 20);
}

TEST_F(Scheme1, ReportsNonFiniteErrors) {
  const double nan = std::numeric_limits<double>::quiet_NaN();
  const Deformation found = DeformationSolver(chain_, {}).solve(frames_with(3, 4, nan), q_, delta_mu_);
  EXPECT_EQ(found.status, SolveStatus::non_finite);
}

TEST_F(Scheme1, ReportsASingularChain) {
  // Two passive joints on the same axis make the equations singular.
  for (Limb& limb : chain_.limbs) {
    limb.joints[0] = limb.joints[1] = {JointType::revolute, false};
    limb.home[1] = lie::Transform<double>{};
  }
  const Deformation found = DeformationSolver(chain_, {}).solve(frames_with(0, 1, 0.02), q_, delta_mu_);
  EXPECT_EQ(found.status, SolveStatus::singular);
}

}  // namespace
}  // namespace poesy::chain
