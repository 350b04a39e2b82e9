#include "engine/kinds/allocation/alike_limbs.h"

#include <fmt/format.h>

#include <algorithm>
#include <map>
#include <memory>
#include <set>

#include "engine/model/model.h"

namespace poesy::allocation {
namespace {

/// For each limb (numbers from 1), the types of its joints that are not fixed, in their order: "UPR". A limb
/// has no entry if all its joints are fixed.
using LimbJoints = std::map<std::size_t, std::string>;

LimbJoints joints_of(const Study& study) {
  const auto sketch = build_model(study.mechanism)->sketch({});
  LimbJoints joints;
  if (!sketch) return joints;
  for (std::size_t i = 0; i < sketch->limbs.size(); ++i) {
    for (const SketchedJoint& joint : sketch->limbs[i]) {
      if (joint.type != 'F') joints[i + 1] += joint.type;
    }
  }
  return joints;
}

/// The numbers of the limbs that have errors.
std::set<std::size_t> limbs_with_errors(const ModelDescription& model) {
  std::set<std::size_t> limbs;
  for (const Factor& factor : model.factors) limbs.insert(factor.limb);
  return limbs;
}

}  // namespace

std::string shown_identical_limbs(const Study& study) {
  const std::set<std::size_t> limbs = limbs_with_errors(study.model());
  LimbJoints joints = joints_of(study);
  const bool are_known = !joints.empty();
  std::map<std::string, std::size_t> earlier;
  for (const std::size_t limb : limbs) {
    if (are_known && !joints.contains(limb)) continue;
    const auto [same, is_first] = earlier.try_emplace(joints[limb], limb);
    if (!is_first) return fmt::format("# identical_limbs = [{}, {}]\n", same->second, limb);
  }
  return {};
}

std::string unlike_limbs_text(std::span<const std::size_t> limbs, const Study& study) {
  LimbJoints joints = joints_of(study);
  if (joints.empty() || limbs.empty()) return {};
  const std::size_t first = limbs.front();
  const auto differs = [&](std::size_t limb) { return joints[limb] != joints[first]; };
  const auto other = std::ranges::find_if(limbs, differs);
  if (other == limbs.end()) return {};
  return fmt::format(
      "identical_limbs has limb {} with the joints {} and limb {} with {}, which are not alike; is one "
      "tolerance for both meant?",
      first, joints[first], *other, joints[*other]);
}

}  // namespace poesy::allocation
