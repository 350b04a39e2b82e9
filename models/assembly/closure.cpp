#include "models/assembly/closure.h"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <utility>

#include "engine/base/nan.h"
#include "engine/linalg/decompositions.h"
#include "engine/linalg/downhill.h"
#include "models/chain/assembly.h"

namespace poesy::assembly {
namespace {

using Eigen::Index;

/// The descent has come to rest if a step moves bodies by less than this share of the reach.
constexpr double kRest = 1e-8;
constexpr double kClosed = 1e-8;  ///< a mismatch up to this share of the reach counts as rounding

/// The places of bodies and joints, and the remaining mismatch of the limbs.
struct Configuration {
  std::vector<Transform> bodies;
  std::vector<double> displacements;
  std::vector<LimbState> limbs;
  Eigen::VectorXd open;  ///< [6 limbs] mismatch xi of each limb, multiplied by the root W^(1/2) of the metric
};

/// Returns true if a symmetric matrix is positive definite.
bool is_positive(const Eigen::MatrixXd& matrix) { return matrix.allFinite() && linalg::eigenvalues(matrix)[0] > 0.0; }

/// The descent of bodies and joints to the least mismatch, for linalg::comes_to_rest().
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

  /// Returns true if the machine cannot be assembled, by the rule of Closure applied to the present configuration.
  bool bends_away(const Loops& loops) const {
    const Eigen::VectorXd part = loops.taken_away(here_.open);
    std::vector<Screw> r;
    const Matrix6 inverse = linalg::inverse(root_);
    for (std::size_t e = 0; e < here_.limbs.size(); ++e) {
      r.emplace_back(inverse * part.segment<6>(6 * static_cast<Index>(e)));
    }
    const Eigen::MatrixXd weighed = motion_columns(assembly_, here_.limbs, root_) * loops.motions();
    const Eigen::MatrixXd C = bend(assembly_, here_.limbs, r, root_.transpose() * root_);
    return !is_positive(weighed.transpose() * weighed - 2.0 * loops.motions().transpose() * C * loops.motions());
  }

  double try_step(double damping) {
    const Eigen::MatrixXd B = motion_columns(assembly_, here_.limbs, root_);
    Eigen::MatrixXd normal = B.transpose() * B;
    normal.diagonal() *= 1.0 + damping;
    const std::optional<Eigen::VectorXd> step =
        linalg::solve_positive_definite(normal, Eigen::VectorXd(B.transpose() * here_.open));
    tried_ = here_;
    if (!step || !step->allFinite()) return kNaN;
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

bool is_open(const AssemblyModel& model, const Nominal& pose, std::span<const Screw> mismatch) {
  double sum = 0.0;
  for (const Screw& xi : mismatch) sum += xi.dot(pose.W * xi);
  return std::sqrt(sum) > kClosed * model.assembly.reach;
}

bool Closure::is_regular() {
  if (loops_) return loops_->is_regular();
  loops_.emplace(model_->assembly, *pose_, model_->idle);
  if (!loops_->is_regular()) return false;
  const std::vector<std::vector<Screw>> slopes = loops_->determinant_slopes();
  for (const chain::ErrorTerms& terms : model_->terms) {
    nearing_.push_back(0.0);
    for (const chain::ErrorTerm& term : terms) {
      nearing_.back() += slopes[term.limb][term.frame].dot(term_twist(*model_, *pose_, term));
    }
  }
  return true;
}

void Closure::find_nearing(const SampleBlock& samples, std::span<double> nearing) {
  std::ranges::fill(nearing, 0.0);
  if (!may_hold_open() || !is_regular()) return;
  std::vector<double> constant(samples.errors.begin(), samples.errors.end());
  for (const FactorIndex factor : samples.varied) constant[factor.value] = 0.0;
  std::ranges::fill(nearing, std::inner_product(constant.begin(), constant.end(), nearing_.begin(), 0.0));
  for (std::size_t v = 0; v < samples.varied.size(); ++v) {
    const double slope = nearing_[samples.varied[v].value];
    const std::span<const double> values = samples.values.subspan(v * samples.count, samples.count);
    for (std::size_t b = 0; b < samples.count; ++b) nearing[b] += slope * values[b];
  }
}

bool Closure::may_open(double nearing) { return nearing < chain::kNearing; }

SolveStatus Closure::judged(const Solution& found, std::span<const std::vector<Transform>> frames) {
  const bool is_open_at_rest = !may_hold_open() && solved(found.status) && is_open(*model_, *pose_, found.mismatch);
  const bool is_not_assembled = is_open_at_rest || (!solved(found.status) && is_impossible(frames));
  return is_not_assembled ? SolveStatus::not_assembled : found.status;
}

bool Closure::is_impossible(std::span<const std::vector<Transform>> frames) {
  if (!is_regular()) return false;
  Descent descent(model_->assembly, *pose_, frames);
  return linalg::comes_to_rest(descent, kRest) && descent.bends_away(*loops_);
}

}  // namespace poesy::assembly
