#include "models/chain/first_order.h"

#include <algorithm>

#include "engine/base/contract.h"

namespace poesy::chain {

FirstOrder::FirstOrder(const ParallelChain& chain)
    : chain_(&chain), no_mismatch_(6 * chain.pairs.size(), 0.0), pull_(chain.limbs.size()), equations_(chain) {
  for (std::size_t i = 0; i < chain.limbs.size(); ++i) {
    limb_of_frame_.insert(limb_of_frame_.end(), chain.limbs[i].frames(), i);
    limb_of_joint_.insert(limb_of_joint_.end(), chain.limbs[i].passive_joints(), i);
  }
  from_error_.resize(limb_of_frame_.size());
  columns_.resize(limb_of_joint_.size());
}

bool FirstOrder::prepare(std::span<const double> displacements, const lie::Matrix6<double>* W) {
  POESY_EXPECTS(displacements.size() == chain_->joints());
  std::size_t frame = 0;
  std::size_t joint = 0;
  std::size_t column = 0;
  for (const Limb& limb : chain_->limbs) {
    lie::Transform<double> g;
    for (std::size_t j = 0; j < limb.joints.size(); ++j, ++joint) {
      from_error_[frame++] = lie::adjoint(j == 0 ? limb.before_error(j) : g);
      g = g * limb.home[j];
      if (!limb.joints[j].actuated) columns_[column++] = spatial_column(limb.joints[j], g);
      move_joint(limb.joints[j], displacements[joint], g);
    }
    // In the last frame the inverse of the error multiplies from the right, so before_error() of this frame comes
    // before the inverse.
    from_error_[frame++] = -lie::adjoint(g * limb.before_error(limb.joints.size()));
  }
  W_ = W == nullptr ? lie::Matrix6<double>(lie::Matrix6<double>::Identity()) : *W;
  equations_.hold_idle(columns_, W);
  return equations_.solve(columns_, no_mismatch_, W);
}

void FirstOrder::effect(const FrameEntry& entry, std::span<double> delta_mu, std::span<double> displacements) {
  POESY_EXPECTS(delta_mu.size() == 6 * chain_->pairs.size() && displacements.size() == columns_.size());
  std::ranges::fill(delta_mu, 0.0);
  add_motion(limb_of_frame_[entry.frame], motion(entry), delta_mu);
  equations_.solve_again(delta_mu);
  std::ranges::copy(equations_.solution(), displacements.begin());
  for (std::size_t a = 0; a < columns_.size(); ++a) {
    add_motion(limb_of_joint_[a], displacements[a] * columns_[a], delta_mu);
  }
}

void FirstOrder::taken_away(std::span<const double> delta_mu, std::span<double> part) {
  POESY_EXPECTS(delta_mu.size() == 6 * chain_->pairs.size() && part.size() == delta_mu.size());
  equations_.solve_again(delta_mu);
  std::ranges::fill(part, 0.0);
  for (std::size_t a = 0; a < columns_.size(); ++a) {
    add_motion(limb_of_joint_[a], -equations_.solution()[a] * columns_[a], part);
  }
}

lie::Screw<double> FirstOrder::sum_of_motions(const FrameEntry& entry, std::span<const double> displacements) const {
  POESY_EXPECTS(displacements.size() == columns_.size());
  lie::Screw<double> sum = motion(entry);
  for (std::size_t a = 0; a < columns_.size(); ++a) sum += displacements[a] * columns_[a];
  return sum;
}

/// Computes pull_: for each limb, the sum over its pairs of W times the mismatch that these displacements cause.
void FirstOrder::pull_of(std::span<const double> displacements) {
  mismatch_.assign(no_mismatch_.size(), 0.0);
  for (std::size_t a = 0; a < columns_.size(); ++a) {
    add_motion(limb_of_joint_[a], displacements[a] * columns_[a], mismatch_);
  }
  std::ranges::fill(pull_, lie::Screw<double>::Zero());
  for (std::size_t n = 0; n < chain_->pairs.size(); ++n) {
    const lie::Screw<double> weighed = W_ * Eigen::Map<const lie::Screw<double>>(mismatch_.data() + 6 * n);
    pull_[chain_->pairs[n].k] += weighed;
    pull_[chain_->pairs[n].i] -= weighed;
  }
}

/// With N = J^T W J, d ln det N = trace(N^-1 dN) = 2 sum over a of D_a . dc_a. Here c_a is the column of the passive
/// joint a. The wrench D_a is the entry of pull_ for the limb of joint a, after pull_of(column a of N^-1). A motion m
/// of the part before a joint changes the joint's column c by [m, c].
void FirstOrder::determinant_slopes(std::span<lie::Screw<double>> slopes) {
  using Screw = lie::Screw<double>;
  POESY_EXPECTS(slopes.size() == limb_of_frame_.size());
  std::ranges::fill(slopes, Screw::Zero());
  by_joint_.resize(columns_.size());
  std::size_t a = columns_.size();
  unit_.assign(a, 0.0);
  for (std::size_t i = chain_->limbs.size(); i-- > 0;) {
    const Limb& limb = chain_->limbs[i];
    Screw behind = Screw::Zero();
    for (std::size_t j = limb.joints.size(); j-- > 0;) {
      if (!limb.joints[j].actuated) {
        --a;
        by_joint_[a] = behind.dot(columns_[a]);
        unit_[a] = 1.0;
        equations_.solve_for(unit_);
        unit_[a] = 0.0;
        pull_of(equations_.solution());
        behind += 2.0 * lie::wrench_of_bracket(pull_[i], columns_[a]);
      }
      slopes[chain_->first_frame(i) + j] = behind;
    }
  }
  equations_.solve_for(by_joint_);
  pull_of(equations_.solution());
  for (std::size_t f = 0; f < slopes.size(); ++f) slopes[f] -= pull_[limb_of_frame_[f]];
}

/// Changes the residuals delta_mu of the pairs (k, i) by a motion of a limb's platform: adds it if the limb is limb k
/// of the pair, and subtracts it if the limb is limb i.
void FirstOrder::add_motion(std::size_t limb, const lie::Screw<double>& motion, std::span<double> delta_mu) const {
  for (std::size_t n = 0; n < chain_->pairs.size(); ++n) {
    Eigen::Map<lie::Screw<double>> mu(delta_mu.data() + 6 * n);
    if (chain_->pairs[n].k == limb) mu += motion;
    if (chain_->pairs[n].i == limb) mu -= motion;
  }
}

}  // namespace poesy::chain
