#include "models/chain/first_order.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "models/chain/loops.h"
#include "models/chain/metric.h"
#include "models/chain/residual_space.h"
#include "tests/models/chain/block_samples.h"

namespace poesy::chain {
namespace {

using Matrix6 = lie::Matrix6<double>;

Matrix6 random_metric(std::mt19937_64& engine) {
  std::vector<lie::Vector3<double>> points;
  for (int n = 0; n < 4; ++n) points.emplace_back(lie::random_screw(1.0, engine).tail<3>());
  return metric_of_points(points);
}

/// ln det(J^T W J), by its definition. W: the metric of each pair.
double log_of_determinant(const ParallelChain& chain, std::span<const lie::Transform<double>> frames,
                          const std::vector<double>& q, const Matrix6& W) {
  const Eigen::MatrixXd J = jacobian(chain, frames, q);
  Eigen::MatrixXd N = Eigen::MatrixXd::Zero(J.cols(), J.cols());
  for (Eigen::Index n = 0; n < J.rows(); n += 6) N += J.middleRows<6>(n).transpose() * W * J.middleRows<6>(n);
  return std::log(N.determinant());
}

/// ln det(J^T W J) with this error of one frame entry. The passive joints are moved by error x give.
double log_with_error(const ParallelChain& chain, const std::vector<double>& nominal, const FrameEntry& entry,
                      double error, const std::vector<double>& give, const Matrix6& W) {
  std::vector<lie::Transform<double>> frames;
  for (const Limb& limb : chain.limbs) {
    for (std::size_t j = 0; j < limb.frames(); ++j) {
      FrameError<double> of_frame = FrameError<double>::Zero();
      if (frames.size() == entry.frame) of_frame[static_cast<Eigen::Index>(entry.component)] = error;
      frames.push_back(frame_with_error(limb, j, of_frame));
    }
  }
  std::vector<double> q = nominal;
  const std::vector<std::size_t> passive = passive_positions(chain);
  for (std::size_t a = 0; a < passive.size(); ++a) q[passive[a]] += error * give[a];
  return log_of_determinant(chain, frames, q, W);
}

TEST(DeterminantSlopes, AreDifferencesOfTheLogarithm) {
  std::mt19937_64 engine(11);
  using Joints = std::vector<std::size_t>;
  for (const Joints& joints : {Joints{3, 3, 3}, Joints{4, 4, 4}, Joints{3, 4, 5}, Joints{3, 3, 3, 3}}) {
    std::size_t all = 0;
    for (const std::size_t count : joints) all += count;
    const std::vector<double> q = random_displacements(all, 0.5, engine);
    const ParallelChain chain = closed_chain(joints, PassiveJoints::mixed, q, engine);
    const Matrix6 W = random_metric(engine);
    FirstOrder first_order(chain);
    ASSERT_TRUE(first_order.prepare(q, &W));
    std::vector<lie::Screw<double>> slopes(chain.frames());
    first_order.determinant_slopes(slopes);
    std::vector<double> delta_mu(6 * chain.pairs.size());
    std::vector<double> give(chain.passive_joints());
    for (std::size_t frame = 0; frame < chain.frames(); ++frame) {
      for (std::size_t component = 0; component < 6; ++component) {
        constexpr double kStep = 1e-4;
        const FrameEntry entry{frame, component};
        first_order.effect(entry, delta_mu, give);
        const double expected =
            (log_with_error(chain, q, entry, kStep, give, W) - log_with_error(chain, q, entry, -kStep, give, W)) /
            (2.0 * kStep);
        EXPECT_NEAR(slopes[frame].dot(first_order.motion(entry)), expected, 1e-5 * (1.0 + std::abs(expected)));
      }
    }
  }
}

/// Samples of the 2UPR-RPU and of random chains. size: standard deviation of the errors (mm or deg).
std::vector<BlockSamples> every_chain(std::size_t count, double size) {
  std::mt19937_64 engine(7);
  std::vector<BlockSamples> all;
  for (int n = 0; n < 5; ++n) {
    all.push_back(all_error_samples(random_pose(engine), size, count, engine));
    using Joints = std::vector<std::size_t>;
    for (const Joints& joints : {Joints{3, 3}, Joints{4, 4, 4}, Joints{3, 4, 5}, Joints{3, 3, 3, 3, 3}}) {
      all.push_back(random_chain_samples(joints, PassiveJoints::mixed, size / 5.0, count, engine));
    }
  }
  return all;
}

/// Compares the first-order effects with finite differences of solves.
TEST(FirstOrderOfAChain, IsTheDerivativeOfTheSolution) {
  constexpr double kStep = 1e-5;
  for (BlockSamples samples : every_chain(1, 0.0)) {
    FirstOrder first_order(samples.chain);
    ASSERT_TRUE(first_order.prepare(samples.displacements, nullptr));
    DeformationSolver solver(samples.chain, gauss_newton());
    const std::size_t rows = 6 * samples.chain.pairs.size();
    const auto solved_at = [&](std::size_t v, double value) {
      std::ranges::fill(samples.values, 0.0);
      samples.values[v] = value;
      std::vector<double> q = samples.displacements;
      Eigen::VectorXd mu(static_cast<Eigen::Index>(rows));
      solver.solve(frames_of(samples, 0), q, {mu.data(), rows});
      return mu;
    };
    for (std::size_t v = 0; v < samples.varied.size(); v += 3) {
      Eigen::VectorXd effect(static_cast<Eigen::Index>(rows));
      std::vector<double> displacements(samples.chain.passive_joints());
      first_order.effect(samples.varied[v], {effect.data(), rows}, displacements);
      const Eigen::VectorXd truth = (solved_at(v, kStep) - solved_at(v, -kStep)) / (2.0 * kStep);
      EXPECT_LE((effect - truth).cwiseAbs().maxCoeff(), 1e-7) << "entry " << v;
    }
  }
}

/// Example: the 2UPR-RPU has twelve independent mismatches and nine passive joints, so three mismatches remain; it is
/// over-constrained three times.
TEST(FirstOrderOfAChain, HasACoordinateForEachConstraintTooMany) {
  for (const BlockSamples& samples : every_chain(1, 0.0)) {
    FirstOrder first_order(samples.chain);
    ASSERT_TRUE(first_order.prepare(samples.displacements, nullptr));
    ResidualSpace space(samples.chain);
    space.prepare(first_order);
    ASSERT_EQ(space.dimensions(), 6 * (samples.chain.limbs.size() - 1) - samples.chain.passive_joints());
    Eigen::VectorXd effect(static_cast<Eigen::Index>(6 * samples.chain.pairs.size()));
    std::vector<double> displacements(samples.chain.passive_joints());
    for (const FrameEntry& entry : samples.varied) {
      Eigen::VectorXd y = Eigen::VectorXd::Zero(static_cast<Eigen::Index>(space.dimensions()));
      space.add(first_order, entry, 1.0, {y.data(), space.dimensions()});
      first_order.effect(entry, {effect.data(), static_cast<std::size_t>(effect.size())}, displacements);
      EXPECT_LE((space.delta_mu() * y - effect).cwiseAbs().maxCoeff(), 1e-11 * (1.0 + effect.norm()));
      EXPECT_NEAR(y.norm(), effect.norm(), 1e-11 * (1.0 + effect.norm()));
    }
  }
}

TEST(FirstOrderOfAChain, IsWhatTheEvaluatorOfSmallErrorsGives) {
  for (const BlockSamples& samples : every_chain(5, 1e-6)) {
    BlockSolver linear(samples.chain, {}, Fidelity::first_order);
    prepare(linear, samples);
    const BlockOutcome mapped = solve(linear, samples);
    const BlockOutcome exact = solve(samples, {});
    for (std::size_t b = 0; b < samples.count; ++b) {
      EXPECT_EQ(mapped.status[b], SolveStatus::converged);
      EXPECT_LE(distance(mapped, exact, b), 1e-4 * exact.delta_mu.col(static_cast<Eigen::Index>(b)).norm());
    }
  }
}

}  // namespace
}  // namespace poesy::chain
