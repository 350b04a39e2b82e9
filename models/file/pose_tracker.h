#pragma once

#include <cstddef>
#include <deque>
#include <mutex>
#include <span>
#include <utility>
#include <vector>

#include "models/file/tracking.h"

namespace poesy::file {

/// Tracks poses, and remembers the last ones: reachability, solves and pictures of one pose need the same path, one
/// after the other. A result depends only on the mechanism and the pose. Several threads may call track() at once.
class PoseTracker {
 public:
  /// Copies the mechanism.
  explicit PoseTracker(const Mechanism& mechanism) : tracker_(mechanism) {}

  /// Tracks a pose. pose: [mechanism.coordinates] SI.
  Tracked track(std::span<const double> pose) const;

 private:
  static constexpr std::size_t kMostRemembered = 16;  // poses; a few for each of several threads

  using Remembered = std::pair<std::vector<double>, Tracked>;  // a pose and its result

  Tracker tracker_;
  mutable std::mutex mutex_;
  mutable std::deque<Remembered> last_;  // latest first
};

}  // namespace poesy::file
