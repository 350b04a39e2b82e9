#pragma once

#include <random>
#include <string>
#include <vector>

#include "models/assembly/model.h"
#include "tests/models/chain/closed_chain.h"

// Assemblies with random limbs between base and platform. All six errors of every frame are errors of the model.
namespace poesy::assembly {

/// The shapes of random assemblies: the number of joints of each limb, one of which is actuated. All are
/// over-constrained.
inline const std::vector<std::vector<std::size_t>>& limbs_of_random_assemblies() {
  static const std::vector<std::vector<std::size_t>> all{{3, 3}, {4, 4, 4}, {3, 4, 5}, {3, 3, 3, 3, 3}};
  return all;
}

/// A random assembly whose limbs have these numbers of joints. Its metric has four random points on the platform.
inline AssemblyModel random_assembly(const std::vector<std::size_t>& joints, chain::PassiveJoints kind,
                                     std::mt19937_64& engine) {
  std::size_t count = 0;
  for (const std::size_t of_limb : joints) count += of_limb;
  const std::vector<double> q = chain::random_displacements(count, 0.4, engine);
  const chain::ParallelChain chain = chain::closed_chain(joints, kind, q, engine);
  AssemblyModel model;
  model.assembly.bodies.push_back({"base", {}});
  model.assembly.bodies.push_back({"platform", {}});
  for (std::size_t e = 0; e < chain.limbs.size(); ++e) {
    model.assembly.limbs.push_back({.chain = chain.limbs[e], .label = std::to_string(e + 1)});
    model.ranks.push_back(chain.limbs[e].passive_joints());
    for (std::size_t frame = 0; frame < chain.limbs[e].frames(); ++frame) {
      for (std::size_t component = 0; component < 6; ++component) model.terms.push_back({{e, frame, component}});
    }
  }
  for (int n = 0; n < 4; ++n) model.assembly.points.emplace_back(0.2 * lie::random_screw(1.0, engine).tail<3>());
  model.assembly.reach = chain.reach();
  model.pairs = chain::pairs_of(chain.limbs.size());
  model.joint_displacements = [q](std::span<const double>) { return q; };
  return model;
}

}  // namespace poesy::assembly
