#include "models/chain/deformation_solver.h"

#include <gtest/gtest.h>

#include <limits>

#include "models/two_upr_rpu/kinematics.h"
#include "tests/models/chain/random_chain.h"

namespace poesy::chain {
namespace {

/// Limbs whose platform frames coincide at displacement zero: the last frame of each is chosen so.
ParallelChain closed_chain(std::size_t limbs, std::size_t joints, std::mt19937_64& engine) {
  ParallelChain chain;
  const lie::Transform<double> platform = lie::exp(lie::random_screw(0.5, engine));
  for (std::size_t i = 0; i < limbs; ++i) {
    Limb limb = random_limb(joints, engine);
    for (Joint& joint : limb.joints) joint = {JointType::revolute, false};
    limb.joints[i % joints].actuated = true;
    limb.home.back() = lie::Transform<double>{};
    const std::vector<double> zero(joints, 0.0);
    limb.home.back() = platform_pose(limb, limb.home, zero).inverse() * platform;
    chain.limbs.push_back(limb);
  }
  for (std::size_t i = 0; i < limbs && (limbs > 2 || i == 0); ++i) chain.pairs.push_back({(i + 1) % limbs, i});
  return chain;
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

/// The residual of all pairs, computed without the solver.
Eigen::VectorXd residual(const ParallelChain& chain, std::span<const lie::Transform<double>> frames,
                         std::span<const double> q) {
  std::vector<lie::Transform<double>> poses;
  std::size_t frame = 0;
  std::size_t joint = 0;
  for (const Limb& limb : chain.limbs) {
    poses.push_back(platform_pose(limb, frames.subspan(frame, limb.frames()), q.subspan(joint, limb.joints.size())));
    frame += limb.frames();
    joint += limb.joints.size();
  }
  Eigen::VectorXd all(6 * static_cast<Eigen::Index>(chain.pairs.size()));
  for (std::size_t n = 0; n < chain.pairs.size(); ++n) {
    all.segment<6>(6 * static_cast<Eigen::Index>(n)) =
        lie::log(poses[chain.pairs[n].k] * poses[chain.pairs[n].i].inverse());
  }
  return all;
}

/// J of Eq. 43 by its definition: a passive joint's spatial motion enters pair (k, i) with + in limb i and - in limb k.
Eigen::MatrixXd jacobian(const ParallelChain& chain, std::span<const lie::Transform<double>> frames,
                         std::vector<double> q) {
  Eigen::MatrixXd j = Eigen::MatrixXd::Zero(6 * static_cast<Eigen::Index>(chain.pairs.size()),
                                            static_cast<Eigen::Index>(chain.passive_joints()));
  std::size_t frame = 0;
  std::size_t joint = 0;
  Eigen::Index column = 0;
  for (std::size_t i = 0; i < chain.limbs.size(); ++i) {
    const Limb& limb = chain.limbs[i];
    const auto own = frames.subspan(frame, limb.frames());
    for (std::size_t k = 0; k < limb.joints.size(); ++k) {
      if (limb.joints[k].actuated) continue;
      const double h = 1e-5;
      const double at = q[joint + k];
      const auto pose_at = [&](double value) {
        q[joint + k] = value;
        return platform_pose(limb, own, std::span<const double>(q).subspan(joint, limb.joints.size()));
      };
      const lie::Screw<double> motion = lie::log(pose_at(at + h) * pose_at(at - h).inverse()) / (2 * h);
      q[joint + k] = at;
      for (std::size_t n = 0; n < chain.pairs.size(); ++n) {
        const auto row = 6 * static_cast<Eigen::Index>(n);
        if (chain.pairs[n].i == i) j.block<6, 1>(row, column) += motion;
        if (chain.pairs[n].k == i) j.block<6, 1>(row, column) -= motion;
      }
      ++column;
    }
    frame += limb.frames();
    joint += limb.joints.size();
  }
  return j;
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
  // Two passive joints on one axis cannot be told apart.
  for (Limb& limb : chain_.limbs) {
    limb.joints[0] = limb.joints[1] = {JointType::revolute, false};
    limb.home[1] = lie::Transform<double>{};
  }
  const Deformation found = DeformationSolver(chain_, {}).solve(frames_with(0, 1, 0.02), q_, delta_mu_);
  EXPECT_EQ(found.status, SolveStatus::singular);
}

}  // namespace
}  // namespace poesy::chain
