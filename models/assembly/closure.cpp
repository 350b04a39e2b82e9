#include "models/assembly/closure.h"

#include <cmath>
#include <utility>

#include "engine/base/nan.h"
#include "engine/linalg/decompositions.h"
#include "engine/linalg/downhill.h"

namespace poesy::assembly {
namespace {

using Eigen::Index;

constexpr double kRest = 1e-10;   ///< a step that moves bodies by less, over the reach, is rest
constexpr double kClosed = 1e-8;  ///< a mismatch up to this, over the reach, is closed

/// Where bodies and joints are, and what is left open there.
struct Configuration {
  std::vector<Transform> bodies;
  std::vector<double> displacements;
  std::vector<LimbState> limbs;
  Eigen::VectorXd open;  ///< [6 limbs] W^(1/2) xi
};

/// See linalg::comes_to_rest().
class Descent {
 public:
  Descent(const Assembly& assembly, const Nominal& pose, std::span<const std::vector<Transform>> frames)
      : assembly_(assembly), frames_(frames), root_(linalg::cholesky_root(pose.W)) {
    here_.bodies = pose.bodies;
    here_.displacements = pose.displacements;
    place(here_);
  }

  double sum_of_squares() const { return here_.open.squaredNorm(); }
  double tried_sum_of_squares() const { return tried_.open.squaredNorm(); }
  void take_step() { here_ = tried_; }

  double try_step(double damping) {
    const Eigen::MatrixXd B = matrix();
    Eigen::MatrixXd normal = B.transpose() * B;
    normal.diagonal() *= 1.0 + damping;
    const std::optional<Eigen::VectorXd> step =
        linalg::solve_positive_definite(normal, Eigen::VectorXd(B.transpose() * here_.open));
    tried_ = here_;
    if (!step) return kNaN;
    double length = 0.0;
    const Index joints = step->size() - 6 * bodies();
    for (Index b = 0; b < bodies(); ++b) {
      const Screw twist = step->segment<6>(joints + 6 * b);
      length = std::max(length, (root_ * twist).norm());
      Transform& body = tried_.bodies[static_cast<std::size_t>(b) + 1];
      body = lie::exp(twist) * body;
    }
    Index k = 0;
    std::size_t joint = 0;
    for (const Limb& limb : assembly_.limbs) {
      for (const chain::Joint& one : limb.chain.joints) {
        if (!one.actuated) tried_.displacements[joint] += (*step)[k++];
        ++joint;
      }
    }
    place(tried_);
    return length / assembly_.reach;
  }

 private:
  Index bodies() const { return static_cast<Index>(assembly_.bodies.size()) - 1; }

  /// W^(1/2) times the columns of joints and bodies: [6 limbs x unknowns], with B x = V_b - V_a - J dq.
  Eigen::MatrixXd matrix() const {
    Index joints = 0;
    for (const LimbState& limb : here_.limbs) joints += limb.passive.cols();
    const auto limbs = static_cast<Index>(here_.limbs.size());
    Eigen::MatrixXd B = Eigen::MatrixXd::Zero(6 * limbs, joints + 6 * bodies());
    Index column = 0;
    for (Index e = 0; e < limbs; ++e) {
      const Limb& limb = assembly_.limbs[static_cast<std::size_t>(e)];
      const auto& passive = here_.limbs[static_cast<std::size_t>(e)].passive;
      B.block(6 * e, column, 6, passive.cols()) = -root_ * passive;
      column += passive.cols();
      const auto touch = [&](std::size_t body, double sign) {
        if (body != kBase) B.block<6, 6>(6 * e, joints + 6 * (static_cast<Index>(body) - 1)) = sign * root_;
      };
      touch(limb.from, -1.0);
      touch(limb.to, 1.0);
    }
    return B;
  }

  void place(Configuration& at) const {
    at.limbs.clear();
    at.open.resize(6 * static_cast<Index>(assembly_.limbs.size()));
    std::span<const double> displacements = at.displacements;
    for (std::size_t e = 0; e < assembly_.limbs.size(); ++e) {
      const Limb& limb = assembly_.limbs[e];
      const std::size_t joints = limb.chain.joints.size();
      at.limbs.push_back(limb_state(limb, at.bodies[limb.from], frames_[e], displacements.first(joints)));
      at.open.segment<6>(6 * static_cast<Index>(e)) =
          root_ * lie::log(at.limbs.back().end * at.bodies[limb.to].inverse());
      displacements = displacements.subspan(joints);
    }
  }

  const Assembly& assembly_;
  std::span<const std::vector<Transform>> frames_;
  Matrix6 root_;
  Configuration here_;
  Configuration tried_;
};

}  // namespace

bool Closure::is_open(const Nominal& pose, std::span<const Screw> mismatch) const {
  double sum = 0.0;
  for (const Screw& xi : mismatch) sum += xi.dot(pose.W * xi);
  return std::sqrt(sum) > kClosed * assembly_->reach;
}

bool Closure::is_impossible(const Nominal& pose, std::span<const std::vector<Transform>> frames) const {
  Descent descent(*assembly_, pose, frames);
  return linalg::comes_to_rest(descent, kRest) && std::sqrt(descent.sum_of_squares()) > kClosed * assembly_->reach;
}

}  // namespace poesy::assembly
