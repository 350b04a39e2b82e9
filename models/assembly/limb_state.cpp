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

std::vector<LimbState> limb_states(const Assembly& assembly, std::span<const Transform> bodies,
                                   std::span<const std::vector<Transform>> frames,
                                   std::span<const double> displacements) {
  std::vector<LimbState> states;
  states.reserve(assembly.limbs.size());
  for (std::size_t e = 0; e < assembly.limbs.size(); ++e) {
    const Limb& limb = assembly.limbs[e];
    const std::size_t joints = limb.chain.joints.size();
    states.push_back(limb_state(limb, bodies[limb.from], frames[e], displacements.first(joints)));
    displacements = displacements.subspan(joints);
  }
  return states;
}

Eigen::MatrixXd motion_columns(const Assembly& assembly, std::span<const LimbState> limbs, const Matrix6& root) {
  using Eigen::Index;
  Index joints = 0;
  for (const LimbState& limb : limbs) joints += limb.passive.cols();
  const auto rows = 6 * static_cast<Index>(limbs.size());
  Eigen::MatrixXd B = Eigen::MatrixXd::Zero(rows, joints + 6 * static_cast<Index>(assembly.bodies.size() - 1));
  Index column = 0;
  for (std::size_t e = 0; e < limbs.size(); ++e) {
    const Index row = 6 * static_cast<Index>(e);
    const Index passive = limbs[e].passive.cols();
    B.block(row, column, 6, passive) = -root * limbs[e].passive;
    column += passive;
    const auto touch = [&](std::size_t body, double sign) {
      if (body != kBase) B.block<6, 6>(row, joints + 6 * static_cast<Index>(body - 1)) = sign * root;
    };
    touch(assembly.limbs[e].from, -1.0);
    touch(assembly.limbs[e].to, 1.0);
  }
  return B;
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
