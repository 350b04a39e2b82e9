#include "models/chain/platform_motion.h"

namespace poesy::chain {
namespace {

using Vector3 = lie::Vector3<double>;

}  // namespace

lie::Screw<double> mean_motion(const ParallelChain& chain, std::span<const lie::Transform<double>> frames,
                               std::span<const double> displacements, const lie::Transform<double>& nominal) {
  lie::Screw<double> mean = lie::Screw<double>::Zero();
  for (const Limb& limb : chain.limbs) {
    const std::size_t joints = limb.joints.size();
    const auto pose = forward_kinematics<double>(limb, frames.first(joints + 1), displacements.first(joints),
                                                 [](std::size_t, const lie::Screw<double>&) {});
    mean += lie::log(pose * nominal.inverse()) / static_cast<double>(chain.limbs.size());
    frames = frames.subspan(joints + 1);
    displacements = displacements.subspan(joints);
  }
  return mean;
}

std::vector<double> platform_displacement(const lie::Screw<double>& xi, const PlatformPoints& points, bool is_linear) {
  const Vector3 theta = xi.head<3>();
  const auto moved = [&](const Vector3& point) -> Vector3 {
    const Vector3 linear = theta.cross(point) + xi.tail<3>();
    return is_linear ? linear : Vector3(lie::left_jacobian<double>(theta) * linear);
  };
  const Vector3 origin = moved(points.platform.p);
  std::vector<double> rows{origin.x(), origin.y(), origin.z(),    theta.x(),
                           theta.y(),  theta.z(),  origin.norm(), theta.norm()};
  if (!points.tool) return rows;
  const Vector3 tool = moved(*points.tool);
  rows.insert(rows.end(), {tool.x(), tool.y(), tool.z(), tool.norm()});
  return rows;
}

}  // namespace poesy::chain
