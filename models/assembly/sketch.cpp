#include "models/assembly/sketch.h"

#include "models/chain/sketch.h"

namespace poesy::assembly {
namespace {

SketchVector sketched(const Vector3& vector) { return {vector.x(), vector.y(), vector.z()}; }

/// The motions in a column of `effects`: those of all limbs' ends if limbs are paired, else only that of the platform.
std::vector<Screw> ends_of(const AssemblyModel& model, const Nominal& pose, const Balance& effects,
                           Eigen::Index column) {
  const Screw platform = effects.twists.block<6, 1>(6 * static_cast<Eigen::Index>(kPlatform), column);
  if (model.pairs.empty()) return {platform};
  std::vector<Screw> motions;
  for (std::size_t e = 0; e < pose.limbs.size(); ++e) {
    const Screw wrench = effects.wrenches.block<6, 1>(6 * static_cast<Eigen::Index>(e), column);
    motions.emplace_back(platform + pose.compliance[e] * wrench);
  }
  return motions;
}

void add_errors(Sketch& sketch, const AssemblyModel& model, const Nominal& pose) {
  const FirstOrder first_order(model.assembly, pose, model.ranks);
  const Eigen::MatrixXd alone = error_twists(model, pose);
  const Balance effects = first_order.effect(alone);
  for (std::size_t f = 0; f < model.terms.size(); ++f) {
    const auto column = static_cast<Eigen::Index>(f);
    sketch.errors.push_back(chain::sketched_error(sketch, model.terms[f]));
    if (!first_order.is_regular()) continue;
    sketch.errors.back().motions =
        chain::sketched_motions(ends_of(model, pose, effects, column), alone.col(column).norm());
  }
}

}  // namespace

void place(Sketch& sketch, const AssemblyModel& model, std::span<const double> displacements) {
  const Nominal pose = nominal(model.assembly, displacements);
  sketch.frames.clear();
  for (std::size_t e = 0; e < pose.limbs.size(); ++e) {
    const Limb& limb = model.assembly.limbs[e];
    chain::LimbFrames frames{pose.limbs[e].before, {pose.bodies[limb.from]}};
    frames.after.insert(frames.after.end(), pose.limbs[e].after.begin(), pose.limbs[e].after.end());
    frames.after.push_back(pose.limbs[e].end);
    chain::place_limb(sketch, frames, limb.chain.errors_at_joints);
  }
  for (std::size_t b = 0; b < sketch.bodies.size(); ++b) sketch.bodies[b].origin = sketched(pose.bodies[b].p);
  const Transform& platform = pose.bodies[kPlatform];
  sketch.platform = sketched(platform.p);
  sketch.tool.clear();
  if (model.assembly.tool) sketch.tool.push_back(sketched(platform.p + platform.R * *model.assembly.tool));
  sketch.errors.clear();
  add_errors(sketch, model, pose);
}

}  // namespace poesy::assembly
