#pragma once

#include <span>
#include <vector>

#include "engine/model/model.h"
#include "models/file/tracking.h"

/// Charts: alternative coordinates for the poses of a mechanism that a file describes.
namespace poesy::file {

/// Alternative coordinates of a pose. They determine the pose as the mechanism's own coordinates do; track() finds the
/// pose.
class Chart {
 public:
  /// tracked: the mechanism that track() moves; its platform frame may differ from that of `mechanism`.
  /// tracked_T_platform: pose of the platform frame of `mechanism` in the platform frame of `tracked`.
  Chart(PoseChart description, const Mechanism& mechanism, const Mechanism& tracked, Given given,
        const Transform& tracked_T_platform);

  /// The names, dimensions and descriptions of the coordinates.
  const PoseChart& description() const { return description_; }

  /// Follows the path from home to these coordinates (SI) that is straight in the coordinates of this chart. All other
  /// computations follow the path that is straight in the mechanism's own coordinates. If the two paths lead to
  /// different working modes, the pose counts as unreachable.
  Tracked track(std::span<const double> coordinates) const;

 private:
  bool same_displacements(std::span<const double> a, std::span<const double> b) const;

  PoseChart description_;
  Mechanism mechanism_;
  Tracker own_;
  Tracker tracker_;
  Transform tracked_T_platform_;
};

/// [mechanism.coordinates] The coordinates of a pose, SI.
std::vector<double> coordinates_of(const Mechanism& mechanism, const PlatformPose& pose);

/// The charts of a mechanism. The chart "tip" exists if the mechanism has a tool and a length among its coordinates.
/// Its coordinates contain the position of the tool in place of the position of the platform's origin P. The chart
/// "actuators" exists if the mechanism has as many drives as coordinates. Its coordinates are the displacements of the
/// drives from home. A chart is omitted if one of its names belongs to another coordinate of the mechanism.
std::vector<Chart> charts_of(const Mechanism& mechanism);

}  // namespace poesy::file
