#pragma once

#include <span>
#include <vector>

#include "engine/model/model.h"
#include "models/file/tracking.h"

/// Other coordinates in which a mechanism of a file takes poses.
namespace poesy::file {

/// Coordinates that determine the pose as the mechanism's own do, and the way to them from home.
class Chart {
 public:
  /// tracked: the same mechanism, perhaps with another frame of the platform, in which its own has this place.
  Chart(PoseChart description, const Mechanism& mechanism, const Mechanism& tracked, Given given,
        const Transform& tracked_T_platform);

  const PoseChart& description() const { return description_; }  ///< Names, dimensions and words.

  /// The way straight in these coordinates [those of the description], SI. A pose that is reached so in another working
  /// mode than straight in the mechanism's own coordinates, by which everything else is solved, is unreachable too.
  Tracked track(std::span<const double> coordinates) const;

 private:
  bool same_displacements(std::span<const double> a, std::span<const double> b) const;

  PoseChart description_;
  Mechanism mechanism_;
  Tracker own_;
  Tracker tracker_;
  Transform tracked_T_platform_;
};

/// The pose [mechanism.coordinates], SI.
std::vector<double> coordinates_of(const Mechanism& mechanism, const PlatformPose& pose);

/// What a mechanism offers, whatever its geometry: "tip", where it has a tool and a length among its coordinates: its
/// coordinates with the tool's place instead of P's; "actuators", where it has as many drives as coordinates: their
/// displacements from home. A chart of which a name belongs to another coordinate of the mechanism is left out.
std::vector<Chart> charts_of(const Mechanism& mechanism);

}  // namespace poesy::file
