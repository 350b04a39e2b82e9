#include "models/chain/loops.h"

namespace poesy::chain {

Loops::Loops(const ParallelChain& chain)
    : chain_(&chain), poses_(chain.limbs.size()), columns_(chain.passive_joints()) {}

void Loops::evaluate(std::span<const lie::Transform<double>> frames, std::span<const double> displacements,
                     std::span<double> delta_mu) {
  std::size_t frame = 0;
  std::size_t joint = 0;
  std::size_t column = 0;
  for (std::size_t i = 0; i < chain_->limbs.size(); ++i) {
    const Limb& limb = chain_->limbs[i];
    const std::size_t joints = limb.joints.size();
    poses_[i] = forward_kinematics<double>(
        limb, frames.subspan(frame, joints + 1), displacements.subspan(joint, joints),
        [&](std::size_t k, const lie::Screw<double>& screw) { columns_[column + k] = screw; });
    frame += joints + 1;
    joint += joints;
    column += limb.passive_joints();
  }
  for (std::size_t n = 0; n < chain_->pairs.size(); ++n) {
    const LimbPair& pair = chain_->pairs[n];
    Eigen::Map<lie::Screw<double>>(delta_mu.data() + 6 * n) = lie::log(poses_[pair.k] * poses_[pair.i].inverse());
  }
}

std::vector<std::size_t> passive_positions(const ParallelChain& chain) {
  std::vector<std::size_t> positions;
  std::size_t joint = 0;
  for (const Limb& limb : chain.limbs) {
    for (const Joint& each : limb.joints) {
      if (!each.actuated) positions.push_back(joint);
      ++joint;
    }
  }
  return positions;
}

}  // namespace poesy::chain
