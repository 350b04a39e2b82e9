#include "models/chain/block_solver.h"

#include <gtest/gtest.h>

#include <Eigen/Eigenvalues>
#include <complex>
#include <limits>

#include "tests/models/chain/block_samples.h"
#include "tests/support/isa.h"

namespace poesy::chain {
namespace {

constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();

/// Samples of the 2UPR-RPU at a few poses and of random chains.
std::vector<BlockSamples> every_chain(std::size_t count) {
  std::mt19937_64 engine(23);
  std::vector<BlockSamples> all;
  for (int n = 0; n < 6; ++n) {
    all.push_back(all_error_samples(random_pose(engine), 0.5, count, engine));
    for (const std::size_t factor : {5u, 20u, 50u, 68u}) {
      all.push_back(single_error_samples(random_pose(engine), factor, 0.2, count, engine));
    }
    using Joints = std::vector<std::size_t>;
    for (const Joints& joints : {Joints{3, 3}, Joints{4, 4, 4}, Joints{3, 4, 5}, Joints{3, 3, 3, 3, 3}, Joints{5, 2}}) {
      for (const PassiveJoints kind : {PassiveJoints::revolute, PassiveJoints::mixed}) {
        all.push_back(random_chain_samples(joints, kind, 0.1, count, engine));
      }
    }
  }
  return all;
}

class EveryKernel : public test::WithIsa {};

TEST_P(EveryKernel, GaussNewtonIsTheReference) {
  std::size_t compared = 0;
  std::size_t total = 0;
  for (const BlockSamples& samples : every_chain(37)) {
    const BlockOutcome found = solve(samples, gauss_newton());
    const BlockOutcome truth = solve_by_reference(samples, gauss_newton());
    for (std::size_t b = 0; b < samples.count; ++b, ++total) {
      // Samples with more iterations may end on either side of the cap.
      if (truth.iterations[b] >= 40) continue;
      ++compared;
      EXPECT_EQ(solved(found.status[b]), solved(truth.status[b]));
      EXPECT_TRUE(solved(truth.status[b]) || found.status[b] == truth.status[b]);
      EXPECT_TRUE(!usable(truth.status[b]) || distance(found, truth, b) <= 1e-12) << distance(found, truth, b);
    }
  }
  EXPECT_GT(compared, total * 9 / 10) << "of " << total;
}

TEST_P(EveryKernel, GaussNewtonStopsAtTheCap) {
  for (const BlockSamples& samples : every_chain(9)) {
    const BlockOutcome found = solve(samples, gauss_newton(2));
    const BlockOutcome truth = solve_by_reference(samples, gauss_newton(2));
    for (std::size_t b = 0; b < samples.count; ++b) {
      EXPECT_EQ(truth.status[b], SolveStatus::iteration_cap);
      EXPECT_EQ(found.status[b], SolveStatus::iteration_cap);
      EXPECT_EQ(found.iterations[b], 2u);
      EXPECT_LE(distance(found, truth, b), 1e-12);
    }
  }
}

TEST_P(EveryKernel, ResponsesAreTheNormsOfTheResiduals) {
  for (const BlockSamples& samples : every_chain(9)) {
    const BlockOutcome found = solve(samples, {});
    const std::size_t pairs = samples.chain.pairs.size();
    for (Eigen::Index b = 0; b < found.responses.cols(); ++b) {
      double angular = 0.0, linear = 0.0, largest = 0.0;
      for (std::size_t n = 0; n < pairs; ++n) {
        const lie::Screw<double> mu = found.delta_mu.col(b).segment<6>(6 * static_cast<Eigen::Index>(n));
        angular += mu.head<3>().norm() / static_cast<double>(pairs);
        linear += mu.tail<3>().norm() / static_cast<double>(pairs);
        largest = std::max(largest, mu.norm());
      }
      EXPECT_DOUBLE_EQ(found.responses(0, b), angular);
      EXPECT_DOUBLE_EQ(found.responses(1, b), linear);
      EXPECT_DOUBLE_EQ(found.responses(2, b), largest);
    }
  }
}

TEST_P(EveryKernel, PerfectPartsDoNotDeform) {
  for (BlockSamples samples : every_chain(9)) {
    samples.errors.assign(samples.chain.frames(), FrameError<double>::Zero());
    samples.values.assign(samples.values.size(), 0.0);
    for (const SolverOptions& options : {SolverOptions{}, gauss_newton()}) {
      const BlockOutcome found = solve(samples, options);
      for (const SolveStatus status : found.status) EXPECT_TRUE(solved(status));
      EXPECT_LE(found.delta_mu.cwiseAbs().maxCoeff(), rounding_level(samples.chain));
    }
  }
}

TEST_P(EveryKernel, ReportsASingularChain) {
  std::mt19937_64 engine(29);
  BlockSamples samples = robot_samples({-0.24, 0.2, -0.3}, std::vector<std::size_t>{3}, 1.0, 11, engine);
  // Two passive joints on the same axis make the equations singular.
  for (Limb& limb : samples.chain.limbs) {
    limb.joints[0] = limb.joints[1] = {JointType::revolute, false};
    limb.home[1] = lie::Transform<double>{};
  }
  const BlockOutcome truth = solve_by_reference(samples, gauss_newton());
  for (const SolverOptions& options : {SolverOptions{}, gauss_newton()}) {
    const BlockOutcome found = solve(samples, options);
    for (std::size_t b = 0; b < samples.count; ++b) {
      EXPECT_EQ(truth.status[b], SolveStatus::singular);
      EXPECT_EQ(found.status[b], SolveStatus::singular) << kStatusNames[static_cast<std::size_t>(found.status[b])];
    }
  }
}

TEST_P(EveryKernel, ReportsNonFiniteErrors) {
  std::mt19937_64 engine(31);
  for (const double nothing : {kNaN, std::numeric_limits<double>::infinity()}) {
    for (BlockSamples samples : {all_error_samples(random_pose(engine), 0.5, 11, engine),
                                 single_error_samples(random_pose(engine), 68, 0.2, 11, engine)}) {
      samples.range = samples.varied.size() == 1 ? 4.0 * kDegree : 0.0;
      samples.values[4] = nothing;
      const BlockOutcome truth = solve_by_reference(samples, gauss_newton());
      for (const SolverOptions& options : {SolverOptions{}, gauss_newton()}) {
        const BlockOutcome found = solve(samples, options);
        for (std::size_t b = 0; b < samples.count; ++b) {
          EXPECT_EQ(truth.status[b] == SolveStatus::non_finite, b == 4);
          EXPECT_EQ(found.status[b] == SolveStatus::non_finite, b == 4);
        }
      }
    }
  }
}

TEST_P(EveryKernel, NewtonIsGaussNewtonWhereThatConverges) {
  std::size_t compared = 0;
  std::size_t total = 0;
  for (const BlockSamples& samples : every_chain(37)) {
    const BlockOutcome found = solve(samples, {});
    const BlockOutcome truth = solve_by_reference(samples, gauss_newton(400));
    for (std::size_t b = 0; b < samples.count; ++b, ++total) {
      if (!solved(truth.status[b])) continue;
      ++compared;
      EXPECT_TRUE(solved(found.status[b]));
      EXPECT_LE(distance(found, truth, b), 1e-11) << truth.iterations[b];
    }
  }
  EXPECT_GT(compared, total * 19 / 20) << "of " << total;
}

double mean_iterations(const BlockOutcome& outcome) {
  return std::accumulate(outcome.iterations.begin(), outcome.iterations.end(), 0.0) /
         static_cast<double>(outcome.iterations.size());
}

TEST_P(EveryKernel, NewtonNeedsFewerIterations) {
  std::mt19937_64 engine(37);
  const BlockSamples samples = all_error_samples({-0.25, 0.1, 0.2}, 0.2, 500, engine);
  EXPECT_LT(mean_iterations(solve(samples, {})), 5.0);
  EXPECT_GT(mean_iterations(solve(samples, gauss_newton())), 10.0);
}

TEST_P(EveryKernel, PredictedStartsChangeNothingButTheCost) {
  std::mt19937_64 engine(41);
  for (std::size_t factor = 0; factor < 71; factor += 3) {
    BlockSamples samples = single_error_samples({-0.25, 0.1, 0.2}, factor, 0.1, 200, engine);
    const BlockOutcome from_nominal = solve(samples, {});
    samples.range = 4.0 * unit_of(samples.varied[0]);
    const BlockOutcome predicted = solve(samples, {});
    EXPECT_GE(mean_iterations(from_nominal), 3.0);
    EXPECT_LT(mean_iterations(predicted), 2.0);
    for (std::size_t b = 0; b < samples.count; ++b) {
      EXPECT_TRUE(solved(predicted.status[b]));
      EXPECT_LE(distance(predicted, from_nominal, b), 1e-13);
    }
  }
}

/// Adds a step of the passive joints to the displacements of all joints.
void move(const ParallelChain& chain, const Eigen::VectorXd& step, std::vector<double>& q) {
  std::size_t joint = 0;
  Eigen::Index passive = 0;
  for (const Limb& limb : chain.limbs) {
    for (const Joint& each : limb.joints) {
      if (!each.actuated) q[joint] += step[passive++];
      ++joint;
    }
  }
}

/// Moves q by damped least squares so that the residual of the limbs becomes the reported one. Returns the largest
/// remaining difference.
double attain(const ParallelChain& chain, std::span<const lie::Transform<double>> frames,
              const Eigen::VectorXd& reported, std::vector<double>& q) {
  double damping = 1e-2;
  Eigen::VectorXd excess = residual(chain, frames, q) - reported;
  for (int n = 0; n < 100 && excess.norm() > 1e-14; ++n) {
    const Eigen::MatrixXd j = jacobian(chain, frames, q);
    Eigen::MatrixXd normal = j.transpose() * j;
    normal.diagonal().array() += damping;
    std::vector<double> there = q;
    move(chain, normal.ldlt().solve(j.transpose() * excess), there);
    const Eigen::VectorXd left = residual(chain, frames, there) - reported;
    const bool closer = left.norm() < excess.norm();
    damping = closer ? std::max(damping / 5.0, 1e-16) : damping * 4.0;
    if (closer) {
      q = there;
      excess = left;
    }
  }
  return excess.cwiseAbs().maxCoeff();
}

/// Joint displacements at which the limbs have the reported residual. The search starts from the nominal displacements,
/// then from random ones.
std::vector<double> displacements_of(const BlockSamples& samples, std::size_t b, const Eigen::VectorXd& reported) {
  const auto frames = frames_of(samples, b);
  std::mt19937_64 engine(71);
  std::vector<double> q = samples.displacements;
  for (int start = 0; start < 100 && attain(samples.chain, frames, reported, q) > 1e-14; ++start) {
    q = samples.displacements;
    const std::vector<double> far = random_displacements(samples.chain.passive_joints(), 0.6, engine);
    move(samples.chain, Eigen::Map<const Eigen::VectorXd>(far.data(), static_cast<Eigen::Index>(far.size())), q);
  }
  return q;
}

/// Expects that the solution found by Newton is a root by definition: its residual can be attained, and J^T delta_mu
/// vanishes there. Returns the joint displacements.
std::vector<double> expect_root(const BlockSamples& samples, std::size_t b, const BlockOutcome& found) {
  const Eigen::VectorXd reported = found.delta_mu.col(static_cast<Eigen::Index>(b));
  const std::vector<double> q = displacements_of(samples, b, reported);
  const auto frames = frames_of(samples, b);
  EXPECT_LE((reported - residual(samples.chain, frames, q)).cwiseAbs().maxCoeff(), 1e-14);
  // The last step is shorter than sqrt(tolerance / 10). The remaining error is a few times its square.
  EXPECT_LE((jacobian(samples.chain, frames, q).transpose() * reported).cwiseAbs().maxCoeff(), 2e-12);
  return q;
}

TEST_P(EveryKernel, NewtonEndsAtAFixedPointOfTheDefinition) {
  for (BlockSamples samples : every_chain(5)) {
    if (samples.varied.size() == 1) samples.range = 4.0 * unit_of(samples.varied[0]);
    const BlockOutcome found = solve(samples, {});
    for (std::size_t b = 0; b < samples.count; ++b) {
      ASSERT_TRUE(solved(found.status[b]));
      expect_root(samples, b, found);
    }
  }
}

/// The derivative of -J^T delta_mu by the passive joints, by finite differences.
Eigen::MatrixXd derivative(const ParallelChain& chain, std::span<const lie::Transform<double>> frames,
                           const std::vector<double>& q) {
  constexpr double kStep = 1e-4;
  const auto size = static_cast<Eigen::Index>(chain.passive_joints());
  const auto gradient_beside = [&](Eigen::Index joint, double step) -> Eigen::VectorXd {
    std::vector<double> there = q;
    move(chain, step * Eigen::VectorXd::Unit(size, joint), there);
    return jacobian(chain, frames, there).transpose() * residual(chain, frames, there);
  };
  Eigen::MatrixXd m(size, size);
  for (Eigen::Index joint = 0; joint < size; ++joint) {
    m.col(joint) = (gradient_beside(joint, -kStep) - gradient_beside(joint, kStep)) / (2.0 * kStep);
  }
  return m;
}

TEST_P(EveryKernel, NewtonProvesWhatGaussNewtonDoesNotFind) {
  std::mt19937_64 engine(59);
  int proven = 0;
  for (const double gamma : {-0.95, 0.9, 1.0}) {
    const BlockSamples samples = all_error_samples({-0.2, 0.3, gamma}, 0.5, 100, engine);
    const BlockOutcome found = solve(samples, {});
    const BlockOutcome published = solve(samples, gauss_newton(400));
    for (std::size_t b = 0; b < samples.count; ++b) {
      if (solved(published.status[b]) || !solved(found.status[b])) continue;
      ++proven;
      const std::vector<double> q = expect_root(samples, b, found);
      const Eigen::MatrixXd m = derivative(samples.chain, frames_of(samples, b), q);
      const Eigen::VectorXcd eigenvalues = m.eigenvalues();
      for (const std::complex<double>& eigenvalue : eigenvalues) EXPECT_GT(eigenvalue.real(), 0.0);
    }
  }
  EXPECT_GT(proven, 30);
}

INSTANTIATE_TEST_SUITE_P(Isa, EveryKernel, testing::ValuesIn(test::kEveryIsa), test::isa_name);

std::vector<BlockSamples> every_chain_with_predictions() {
  std::vector<BlockSamples> all = every_chain(61);
  for (BlockSamples& samples : all) {
    if (samples.varied.size() == 1) samples.range = 4.0 * unit_of(samples.varied[0]);
  }
  return all;
}

TEST(Kernels, WithFusedMultiplyAddAgreeInEveryBit) {
  if (!test::machine_has("avx2") || !test::machine_has("avx512")) GTEST_SKIP() << "needs AVX2 and AVX-512";
  for (const SolverOptions& options : {SolverOptions{}, gauss_newton()}) {
    for (const BlockSamples& samples : every_chain_with_predictions()) {
      const auto solved_with = [&](const char* isa) {
        const test::ForcedIsa forced(isa);
        return solve(samples, options);
      };
      const BlockOutcome four = solved_with("avx2");
      const BlockOutcome eight = solved_with("avx512");
      EXPECT_EQ(four.delta_mu, eight.delta_mu);
      EXPECT_EQ(four.responses, eight.responses);
      EXPECT_EQ(four.status, eight.status);
      EXPECT_EQ(four.iterations, eight.iterations);
    }
  }
}

TEST(Kernels, AgreeWithThePlainOne) {
  // Compares samples that Newton solves in at most 12 iterations. For others, rounding may select another pass of the
  // kernel.
  constexpr std::uint32_t kDirect = 12;
  for (const char* isa : {"avx2", "avx512", "neon"}) {
    if (!test::machine_has(isa)) continue;
    std::size_t compared = 0;
    std::size_t total = 0;
    for (const BlockSamples& samples : every_chain_with_predictions()) {
      const auto solved_with = [&](const char* name) {
        const test::ForcedIsa forced(name);
        return solve(samples, {});
      };
      const BlockOutcome plain = solved_with("plain");
      const BlockOutcome fast = solved_with(isa);
      for (std::size_t b = 0; b < samples.count; ++b, ++total) {
        if (plain.iterations[b] > kDirect || fast.iterations[b] > kDirect) continue;
        ++compared;
        EXPECT_EQ(plain.status[b], fast.status[b]);
        EXPECT_LE(distance(plain, fast, b), 1e-12);
      }
    }
    EXPECT_GT(compared, total * 9 / 10) << isa << " of " << total;
  }
}

}  // namespace
}  // namespace poesy::chain
