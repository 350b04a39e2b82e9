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
    const Eigen::MatrixXd B = motion_columns(assembly_, here_.limbs, root_);
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

  void place(Configuration& at) const {
    at.limbs = limb_states(assembly_, at.bodies, frames_, at.displacements);
    at.open.resize(6 * static_cast<Index>(at.limbs.size()));
    for (std::size_t e = 0; e < at.limbs.size(); ++e) {
      at.open.segment<6>(6 * static_cast<Index>(e)) =
          root_ * lie::log(at.limbs[e].end * at.bodies[assembly_.limbs[e].to].inverse());
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
