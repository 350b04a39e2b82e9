#include "models/assembly/assembly.h"

#include <algorithm>

namespace poesy::assembly {

bool Load::acts_on(const std::vector<Body>& bodies) const {
  const bool has_weight =
      !gravity.isZero(0.0) && std::ranges::any_of(bodies, [](const Body& one) { return one.mass > 0.0; });
  return has_weight || !force.isZero(0.0) || !moment.isZero(0.0);
}

std::size_t Assembly::joints() const { return first_joint(limbs.size()); }

std::size_t Assembly::first_joint(std::size_t limb) const {
  std::size_t first = 0;
  for (std::size_t e = 0; e < limb; ++e) first += limbs[e].chain.joints.size();
  return first;
}

}  // namespace poesy::assembly
