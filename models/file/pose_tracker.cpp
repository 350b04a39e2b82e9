#include "models/file/pose_tracker.h"

#include <algorithm>
#include <bit>
#include <cstdint>

namespace poesy::file {
namespace {

/// Returns true if two numbers are equal in every bit. 0 and -0 differ, because the signs of zeros in a result may
/// depend on them.
bool same_bits(double a, double b) { return std::bit_cast<std::uint64_t>(a) == std::bit_cast<std::uint64_t>(b); }

}  // namespace

Tracked PoseTracker::track(std::span<const double> pose) const {
  {
    const std::lock_guard lock(mutex_);
    const auto known = std::ranges::find_if(
        last_, [&](const Remembered& one) { return std::ranges::equal(one.first, pose, same_bits); });
    if (known != last_.end()) return known->second;
  }
  Tracked tracked = tracker_.track(pose);
  const std::lock_guard lock(mutex_);
  last_.emplace_front(std::vector<double>(pose.begin(), pose.end()), tracked);
  if (last_.size() > kMostRemembered) last_.pop_back();
  return tracked;
}

}  // namespace poesy::file
