#include "models/assembly/limb_state.h"

namespace poesy::assembly {

LimbState limb_state(const Limb& limb, const Transform& from, std::span<const Transform> frames,
                     std::span<const double> displacements) {
  const std::vector<chain::Joint>& joints = limb.chain.joints;
  LimbState state;
  state.before.reserve(joints.size());
  state.after.reserve(joints.size());
  state.passive.resize(6, static_cast<Eigen::Index>(limb.chain.passive_joints()));
  Eigen::Index column = 0;
  Transform g = from * frames[0];
  for (std::size_t j = 0; j < joints.size(); ++j) {
    state.before.push_back(g);
    if (!joints[j].actuated) state.passive.col(column++) = chain::spatial_column(joints[j], g);
    chain::move_joint(joints[j], displacements[j], g);
    state.after.push_back(g);
    g = g * frames[j + 1];
  }
  state.end = g;
  return state;
}

Screw error_twist(const Limb& limb, const Transform& from, const LimbState& state, std::size_t frame,
                  std::size_t component) {
  const bool is_last = frame + 1 == limb.chain.frames();
  const Transform& behind = frame == 0 ? from : state.after[frame - 1];
  const Matrix6 ad = lie::adjoint(behind * limb.chain.before_error(frame));
  const Screw twist = ad.col(static_cast<Eigen::Index>(component));
  return is_last ? Screw(-twist) : twist;
}

}  // namespace poesy::assembly
