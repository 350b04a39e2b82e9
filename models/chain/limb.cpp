#include "models/chain/limb.h"

#include <algorithm>
#include <numeric>

namespace poesy::chain {
namespace {

template <class Count>
std::size_t sum_over(const std::vector<Limb>& limbs, Count count) {
  return std::accumulate(limbs.begin(), limbs.end(), std::size_t{0},
                         [&](std::size_t sum, const Limb& limb) { return sum + count(limb); });
}

}  // namespace

std::vector<LimbPair> pairs_of(std::size_t limbs) {
  if (limbs == 2) return {{1, 0}};
  if (limbs == 3) return {{1, 0}, {2, 1}, {0, 2}};
  std::vector<LimbPair> pairs;
  for (std::size_t k = 1; k < limbs; ++k) {
    for (std::size_t i = 0; i < k; ++i) pairs.push_back({k, i});
  }
  return pairs;
}

std::size_t Limb::passive_joints() const {
  return static_cast<std::size_t>(
      std::count_if(joints.begin(), joints.end(), [](const Joint& joint) { return !joint.actuated; }));
}

lie::Transform<double> Limb::before_error(std::size_t j) const {
  const bool is_last = j + 1 == frames();
  if (errors_at_joints && is_last) return {home[j].R, lie::Vector3<double>::Zero()};
  if (errors_at_joints && j == 0) return {lie::Matrix3<double>::Identity(), home[j].p};
  return is_last ? home[j] : lie::Transform<double>();
}

lie::Transform<double> Limb::behind_error(std::size_t j) const {
  const bool is_last = j + 1 == frames();
  if (errors_at_joints && is_last) return {lie::Matrix3<double>::Identity(), home[j].R.transpose() * home[j].p};
  if (errors_at_joints && j == 0) return {home[j].R, lie::Vector3<double>::Zero()};
  return is_last ? lie::Transform<double>() : home[j];
}

std::size_t ParallelChain::joints() const {
  return sum_over(limbs, [](const Limb& limb) { return limb.joints.size(); });
}

std::size_t ParallelChain::passive_joints() const {
  return sum_over(limbs, [](const Limb& limb) { return limb.passive_joints(); });
}

std::size_t ParallelChain::frames() const {
  return sum_over(limbs, [](const Limb& limb) { return limb.frames(); });
}

std::size_t ParallelChain::first_frame(std::size_t limb) const {
  std::size_t first = 0;
  for (std::size_t i = 0; i < limb; ++i) first += limbs[i].frames();
  return first;
}

double ParallelChain::reach() const {
  double longest = 0.0;
  for (const Limb& limb : limbs) {
    double length = 0.0;
    for (const auto& frame : limb.home) length += frame.p.norm();
    longest = std::max(longest, length);
  }
  return longest;
}

}  // namespace poesy::chain
