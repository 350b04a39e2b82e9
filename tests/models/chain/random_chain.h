#pragma once

#include <random>

#include "models/chain/limb.h"
#include "tests/models/lie/samples.h"

namespace poesy::chain {

/// A random limb. Its joints are revolute or prismatic, passive or actuated.
inline Limb random_limb(std::size_t joints, std::mt19937_64& engine) {
  Limb limb;
  for (std::size_t j = 0; j < joints; ++j) {
    limb.joints.push_back({j % 3 == 1 ? JointType::prismatic : JointType::revolute, j % 4 == 2});
    limb.home.push_back(lie::exp(lie::random_screw(1.0, engine)));
  }
  limb.home.push_back(lie::exp(lie::random_screw(1.0, engine)));
  return limb;
}

inline std::vector<double> random_displacements(std::size_t count, double size, std::mt19937_64& engine) {
  std::uniform_real_distribution<double> uniform(-size, size);
  std::vector<double> q(count);
  for (double& value : q) value = uniform(engine);
  return q;
}

/// The platform pose of a limb, without its Jacobian.
inline lie::Transform<double> platform_pose(const Limb& limb, std::span<const lie::Transform<double>> frames,
                                            std::span<const double> q) {
  return forward_kinematics<double>(limb, frames, q, [](std::size_t, const lie::Screw<double>&) {});
}

}  // namespace poesy::chain
