#pragma once

#include <cstddef>
#include <deque>
#include <mutex>
#include <span>
#include <utility>
#include <vector>

#include "models/file/tracking.h"

namespace poesy::file {

/// Tracks poses, and remembers the results for the last poses, because the check whether a pose is reachable, its
/// solves and its picture all need the same result. A result depends only on the mechanism and the pose. Several
/// threads may call track() at once.
class PoseTracker {
 public:
  /// Copies the mechanism.
  explicit PoseTracker(const Mechanism& mechanism) : tracker_(mechanism) {}

  /// Tracks a pose. pose: [mechanism.coordinates] SI.
  Tracked track(std::span<const double> pose) const;

 private:
  // Largest number of remembered poses: a few for each of several threads.
  static constexpr std::size_t kMostRemembered = 16;

  using Remembered = std::pair<std::vector<double>, Tracked>;  // a pose and its result

  Tracker tracker_;
  mutable std::mutex mutex_;
  mutable std::deque<Remembered> last_;  // results for the last poses, the latest first
};

}  // namespace poesy::file
