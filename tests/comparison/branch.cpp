#include "tests/comparison/branch.h"

#include <Eigen/Cholesky>
#include <Eigen/LU>
#include <algorithm>
#include <optional>

namespace poesy::chain {
namespace {

constexpr double kFirstStep = 1.0 / 64.0;
constexpr double kSmallestStep = 1e-7;
/// Newton's first step must not exceed this change of a passive displacement (rad, m).
constexpr double kLargestMove = 0.01;
constexpr double kRounding = 1e-11;
constexpr int kNewtonSteps = 10;
constexpr double kDifference = 1e-6;

class Follower {
 public:
  Follower(const ParallelChain& chain, std::span<const double> displacements,
           std::span<const FrameError<double>> errors, const lie::Matrix6<double>& W)
      : chain_(chain), errors_(errors), W_(W), all_(displacements.begin(), displacements.end()) {
    for (const Limb& limb : chain.limbs) {
      for (const Joint& joint : limb.joints) passive_.push_back(!joint.actuated);
    }
    nominal_.resize(static_cast<Eigen::Index>(chain.passive_joints()));
    Eigen::Index next = 0;
    for (std::size_t j = 0; j < all_.size(); ++j) {
      if (passive_[j]) nominal_[next++] = all_[j];
    }
  }

  Branch follow() {
    Eigen::VectorXd q = nominal_;
    double share = 0.0;
    double step = kFirstStep;
    while (share < 1.0 && step > kSmallestStep) {
      const double next = std::min(1.0, share + step);
      set_errors(next);
      if (const auto root = newton(q)) {
        q = *root;
        share = next;
        step *= 1.5;
      } else {
        step *= 0.5;
      }
    }
    set_errors(share);
    return {share, evaluate(q).delta_mu, (q - nominal_).cwiseAbs().maxCoeff()};
  }

 private:
  struct Evaluation {
    Eigen::VectorXd delta_mu;
    Eigen::VectorXd gradient;  ///< J^T W delta_mu
  };

  void set_errors(double share) {
    frames_.clear();
    for (const Limb& limb : chain_.limbs) {
      for (std::size_t j = 0; j < limb.frames(); ++j) {
        const FrameError<double> error = share * errors_[frames_.size()];
        frames_.push_back(frame_with_error(limb, j, error));
      }
    }
  }

  Evaluation evaluate(const Eigen::VectorXd& q) {
    Eigen::Index next = 0;
    for (std::size_t j = 0; j < all_.size(); ++j) {
      if (passive_[j]) all_[j] = q[next++];
    }
    std::vector<lie::Transform<double>> poses;
    std::vector<lie::Screw<double>> columns;
    std::size_t frame = 0;
    std::size_t joint = 0;
    for (const Limb& limb : chain_.limbs) {
      const std::span<const lie::Transform<double>> frames = std::span(frames_).subspan(frame, limb.frames());
      const std::span<const double> own = std::span(all_).subspan(joint, limb.joints.size());
      poses.push_back(forward_kinematics<double>(
          limb, frames, own, [&](std::size_t, const lie::Screw<double>& column) { columns.push_back(column); }));
      frame += limb.frames();
      joint += limb.joints.size();
    }
    return with_gradient(poses, columns);
  }

  /// Du et al. 2022, Eqs. 41-43. In the gradient of pair (k, i), joints of limb i count with +1 and joints of limb k
  /// with -1.
  Evaluation with_gradient(const std::vector<lie::Transform<double>>& poses,
                           const std::vector<lie::Screw<double>>& columns) const {
    Evaluation at{Eigen::VectorXd(6 * static_cast<Eigen::Index>(chain_.pairs.size())),
                  Eigen::VectorXd::Zero(nominal_.size())};
    for (std::size_t n = 0; n < chain_.pairs.size(); ++n) {
      const LimbPair& pair = chain_.pairs[n];
      const lie::Screw<double> mu = lie::log(poses[pair.k] * poses[pair.i].inverse());
      at.delta_mu.segment<6>(6 * static_cast<Eigen::Index>(n)) = mu;
      const lie::Screw<double> weighted = W_ * mu;
      std::size_t c = 0;
      for (std::size_t limb = 0; limb < chain_.limbs.size(); ++limb) {
        const double sign = limb == pair.i ? 1.0 : limb == pair.k ? -1.0 : 0.0;
        for (std::size_t joint = 0; joint < chain_.limbs[limb].passive_joints(); ++joint, ++c) {
          at.gradient[static_cast<Eigen::Index>(c)] += sign * columns[c].dot(weighted);
        }
      }
    }
    return at;
  }

  /// The derivative of -J^T W delta_mu, by central differences.
  Eigen::MatrixXd derivative(const Eigen::VectorXd& q) {
    Eigen::MatrixXd m(q.size(), q.size());
    for (Eigen::Index j = 0; j < q.size(); ++j) {
      const Eigen::VectorXd aside = kDifference * Eigen::VectorXd::Unit(q.size(), j);
      m.col(j) = (evaluate(q - aside).gradient - evaluate(q + aside).gradient) / (2.0 * kDifference);
    }
    return m;
  }

  /// The root that Newton finds from `start`. None if a step is more than half the step before it, or if the derivative
  /// is not positive definite.
  std::optional<Eigen::VectorXd> newton(const Eigen::VectorXd& start) {
    Eigen::VectorXd q = start;
    double last = 2.0 * kLargestMove;
    for (int n = 0; n < kNewtonSteps; ++n) {
      const Eigen::MatrixXd m = derivative(q);
      if (Eigen::LLT<Eigen::MatrixXd>(0.5 * (m + m.transpose())).info() != Eigen::Success) return std::nullopt;
      const Eigen::VectorXd step = m.partialPivLu().solve(evaluate(q).gradient);
      const double size = step.cwiseAbs().maxCoeff();
      if (!(size <= 0.5 * last)) return std::nullopt;
      q += step;
      if (size < kRounding) return q;
      last = size;
    }
    return std::nullopt;
  }

  const ParallelChain& chain_;
  std::span<const FrameError<double>> errors_;
  const lie::Matrix6<double>& W_;
  std::vector<double> all_;  ///< displacements of all joints (rad, m)
  std::vector<bool> passive_;
  Eigen::VectorXd nominal_;  ///< nominal displacements of the passive joints (rad, m)
  std::vector<lie::Transform<double>> frames_;
};

}  // namespace

Branch follow_branch(const ParallelChain& chain, std::span<const double> displacements,
                     std::span<const FrameError<double>> errors, const lie::Matrix6<double>& W) {
  return Follower(chain, displacements, errors, W).follow();
}

}  // namespace poesy::chain
