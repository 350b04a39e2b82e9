#include "models/chain/assembly.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "engine/base/contract.h"
#include "engine/base/nan.h"
#include "engine/linalg/decompositions.h"
#include "engine/linalg/downhill.h"

namespace poesy::chain {
namespace {

/// A step shorter than this counts as rest. The length of a step is the largest root mean square displacement of the
/// metric's points by the change of a single joint, divided by the reach. Without a metric, the length is the largest
/// norm of a joint's twist (rad, m).
constexpr double kRest = 1e-9;

/// The sum of |delta_mu|_W^2 over all pairs of limbs.
double sum_of_squares(std::span<const double> delta_mu, const lie::Matrix6<double>& W) {
  double sum = 0.0;
  for (std::size_t n = 0; n < delta_mu.size(); n += 6) {
    const Eigen::Map<const lie::Screw<double>> screw(delta_mu.data() + n);
    sum += screw.dot(W * screw);
  }
  return sum;
}

/// Returns true if a matrix is positive definite, after its rows and columns are divided by the square roots of
/// `diagonal`.
bool is_positive(Eigen::MatrixXd matrix, const Eigen::VectorXd& diagonal) {
  const Eigen::VectorXd scale = diagonal.cwiseSqrt().cwiseInverse();
  matrix = scale.asDiagonal() * matrix * scale.asDiagonal();
  return matrix.allFinite() && linalg::eigenvalues(matrix)[0] > 0.0;
}

}  // namespace

/// The descent of the passive joints to the least mismatch of a machine, for linalg::comes_to_rest().
class Assembly::Descent {
 public:
  explicit Descent(Assembly& assembly)
      : assembly_(&assembly), delta_mu_(assembly.delta_mu_.size()), tried_delta_mu_(delta_mu_.size()) {}

  /// Starts at nominal displacements, for limbs with these fixed frames.
  void begin(std::span<const lie::Transform<double>> frames) {
    Assembly& of = *assembly_;
    frames_ = frames;
    q_.assign(of.nominal_.begin(), of.nominal_.end());
    of.loops_.evaluate(frames, q_, delta_mu_);
    columns_.assign(of.loops_.columns().begin(), of.loops_.columns().end());
    of.equations_.hold_idle(columns_, &of.W_);
  }

  double sum_of_squares() const { return chain::sum_of_squares(delta_mu_, assembly_->W_); }
  double tried_sum_of_squares() const { return chain::sum_of_squares(tried_delta_mu_, assembly_->W_); }

  double try_step(double damping) {
    Assembly& of = *assembly_;
    if (!of.equations_.solve(columns_, delta_mu_, &of.W_, damping)) return kNaN;
    tried_.assign(q_.begin(), q_.end());
    double length2 = 0.0;
    for (std::size_t a = 0; a < of.passive_.size(); ++a) {
      const double step = of.equations_.solution()[a];
      tried_[of.passive_[a]] += step;
      length2 = std::max(length2, step * step * columns_[a].dot(of.W_ * columns_[a]));
    }
    of.loops_.evaluate(frames_, tried_, tried_delta_mu_);
    return std::sqrt(length2) / of.reach_;
  }

  void take_step() {
    std::swap(q_, tried_);
    std::swap(delta_mu_, tried_delta_mu_);
    columns_.assign(assembly_->loops_.columns().begin(), assembly_->loops_.columns().end());
  }

  std::span<const double> displacements() const { return q_; }

 private:
  Assembly* assembly_;
  std::span<const lie::Transform<double>> frames_;
  std::vector<double> q_;
  std::vector<double> tried_;
  std::vector<double> delta_mu_;
  std::vector<double> tried_delta_mu_;
  std::vector<lie::Screw<double>> columns_;
};

Assembly::Assembly(const ParallelChain& chain)
    : chain_(&chain),
      first_order_(chain),
      equations_(chain),
      loops_(chain),
      passive_(passive_positions(chain)),
      delta_mu_(6 * chain.pairs.size()),
      part_(delta_mu_.size()),
      pull_(chain.limbs.size()),
      slopes_(chain.frames()),
      descent_(std::make_unique<Descent>(*this)) {}

Assembly::~Assembly() = default;

void Assembly::prepare(std::span<const double> displacements, const Metric* metric) {
  POESY_EXPECTS(displacements.size() == chain_->joints());
  const lie::Matrix6<double> W = metric == nullptr ? lie::Matrix6<double>(lie::Matrix6<double>::Identity()) : metric->W;
  if (std::ranges::equal(displacements, nominal_) && W == W_) return;
  nominal_.assign(displacements.begin(), displacements.end());
  W_ = W;
  reach_ = metric == nullptr ? 1.0 : metric->reach;
  is_asked_ = false;
}

/// Returns true if the perfect mechanism is not singular. If so, sets first_order_ and slopes_.
bool Assembly::is_regular() {
  if (is_asked_) return !is_singular_;
  is_asked_ = true;
  is_singular_ = !first_order_.prepare(nominal_, &W_);
  if (!is_singular_) first_order_.determinant_slopes(slopes_);
  return !is_singular_;
}

double Assembly::nearing(const FrameEntry& entry) {
  return is_regular() ? slopes_[entry.frame].dot(first_order_.motion(entry)) : 0.0;
}

bool Assembly::is_impossible(std::span<const lie::Transform<double>> frames) {
  if (!is_regular()) return false;
  descent_->begin(frames);
  return linalg::comes_to_rest(*descent_, kRest) && is_open(frames, descent_->displacements());
}

/// Returns true if the loops cannot close near these displacements of the joints, at which the mismatch is least.
bool Assembly::is_open(std::span<const lie::Transform<double>> frames, std::span<const double> displacements) {
  loops_.evaluate(frames, displacements, delta_mu_);
  first_order_.taken_away(delta_mu_, part_);
  equations_.hold_idle(loops_.columns(), &W_);
  const Eigen::MatrixXd N = equations_.matrix(loops_.columns(), &W_);
  return !is_positive(N - 2.0 * bend(part_), N.diagonal());
}

/// The symmetric part of the matrix C(delta_mu) that the comment of the class Assembly describes.
Eigen::MatrixXd Assembly::bend(std::span<const double> delta_mu) {
  using Screw = lie::Screw<double>;
  const std::span<const Screw> columns = loops_.columns();
  const auto limb = [&](std::size_t joint) { return first_order_.limb_of_joint(joint); };
  std::ranges::fill(pull_, Screw::Zero());
  const auto size = static_cast<Eigen::Index>(columns.size());
  Eigen::MatrixXd C = Eigen::MatrixXd::Zero(size, size);
  for (std::size_t n = 0; n < chain_->pairs.size(); ++n) {
    const auto [k, i] = chain_->pairs[n];
    const Screw mu = Eigen::Map<const Screw>(delta_mu.data() + 6 * n);
    pull_[i] += W_ * mu;
    pull_[k] -= W_ * mu;
    for (std::size_t b = 0; b < columns.size(); ++b) {
      if (limb(b) != i && limb(b) != k) continue;
      const double half = limb(b) == i ? 0.5 : -0.5;
      const Screw once = lie::bracket(mu, columns[b]);
      const Screw twice = lie::bracket(mu, Screw(once / 12.0 + half * columns[b]));
      const Screw weighed = W_ * twice;
      for (std::size_t a = 0; a < columns.size(); ++a) {
        if (limb(a) != i && limb(a) != k) continue;
        const double product = columns[a].dot(weighed);
        C(static_cast<Eigen::Index>(a), static_cast<Eigen::Index>(b)) += limb(a) == limb(b) ? product : -product;
      }
    }
  }
  for (std::size_t a = 0; a < columns.size(); ++a) {
    for (std::size_t b = 0; b < a; ++b) {
      if (limb(a) != limb(b)) continue;
      C(static_cast<Eigen::Index>(a), static_cast<Eigen::Index>(b)) -=
          lie::bracket(columns[b], columns[a]).dot(pull_[limb(a)]);
    }
  }
  return 0.5 * (C + C.transpose());
}

}  // namespace poesy::chain
