#include "models/chain/first_order.h"

#include <gtest/gtest.h>

#include <cmath>

#include "models/chain/loops.h"
#include "models/chain/metric.h"
#include "tests/models/chain/closed_chain.h"

namespace poesy::chain {
namespace {

using Matrix6 = lie::Matrix6<double>;

Matrix6 random_metric(std::mt19937_64& engine) {
  std::vector<lie::Vector3<double>> points;
  for (int n = 0; n < 4; ++n) points.emplace_back(lie::random_screw(1.0, engine).tail<3>());
  return metric_of_points(points);
}

/// ln det(J^T W J), by definition.
double log_of_determinant(const ParallelChain& chain, std::span<const lie::Transform<double>> frames,
                          const std::vector<double>& q, const Matrix6& W) {
  const Eigen::MatrixXd J = jacobian(chain, frames, q);
  Eigen::MatrixXd N = Eigen::MatrixXd::Zero(J.cols(), J.cols());
  for (Eigen::Index n = 0; n < J.rows(); n += 6) N += J.middleRows<6>(n).transpose() * W * J.middleRows<6>(n);
  return std::log(N.determinant());
}

/// With this much of an entry, where the passive joints have given way in proportion.
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
        const double expected = (log_with_error(chain, q, entry, kStep, give, W) -
                                 log_with_error(chain, q, entry, -kStep, give, W)) /
                                (2.0 * kStep);
        EXPECT_NEAR(slopes[frame].dot(first_order.motion(entry)), expected, 1e-5 * (1.0 + std::abs(expected)));
      }
    }
  }
}

}  // namespace
}  // namespace poesy::chain
