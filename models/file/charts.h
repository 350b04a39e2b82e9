#pragma once

#include <span>
#include <vector>

#include "engine/model/model.h"
#include "models/file/tracking.h"

/// Alternative coordinates for the poses of a mechanism of a file.
namespace poesy::file {

/// Coordinates that determine the pose like the mechanism's own, and the path to a pose from home.
class Chart {
 public:
  /// tracked: the same mechanism, perhaps with another frame of its platform, whose pose in this frame is given as
  /// tracked_T_platform.
  Chart(PoseChart description, const Mechanism& mechanism, const Mechanism& tracked, Given given,
        const Transform& tracked_T_platform);

  const PoseChart& description() const { return description_; }  ///< Names, dimensions and descriptions.

  /// Tracks the straight path in these coordinates [those of the description], SI. All other computations follow the
  /// straight path in the mechanism's own coordinates, so a pose is also unreachable if that path leads to another
  /// working mode.
  Tracked track(std::span<const double> coordinates) const;

 private:
  bool same_displacements(std::span<const double> a, std::span<const double> b) const;

  PoseChart description_;
  Mechanism mechanism_;
  Tracker own_;
  Tracker tracker_;
  Transform tracked_T_platform_;
};

/// The coordinates [mechanism.coordinates] of a pose, SI.
std::vector<double> coordinates_of(const Mechanism& mechanism, const PlatformPose& pose);

/// The charts that any geometry offers. "tip", if the mechanism has a tool and a length among its coordinates: its
/// coordinates with the tool's position instead of P's. "actuators", if it has as many drives as coordinates: the
/// drives' displacements from home. A chart is left out if one of its names belongs to another coordinate of the
/// mechanism.
std::vector<Chart> charts_of(const Mechanism& mechanism);

}  // namespace poesy::file
