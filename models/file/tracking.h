#pragma once

#include <span>
#include <string>
#include <vector>

#include "models/file/mechanism.h"

namespace poesy::file {

/// Up to which a loop counts as closed: in rad, and as a share of the reach.
inline constexpr double kClosed = 1e-12;

/// The displacements [moving] with those of prismatic joints times a factor.
std::vector<double> scaled_displacements(const Mechanism& mechanism, std::span<const double> displacements,
                                         double factor);

/// A pose, or how far the way there went.
struct Tracked {
  std::vector<double> displacements;  ///< [moving], limb by limb, from home (rad, m); at the end of the way
  PlatformPose pose;                  ///< of the platform there
  Transform platform;                 ///< base_T_platform there
  double share;                       ///< of the way from home; 1: the pose is reached
  std::string unreachable;            ///< why the way ended; empty: the pose is reached
};

/// Nominal joint displacements at a pose. Tracked from home along the straight line in the coordinates, by Newton's
/// method on all joints and the platform's other coordinates, in steps that are halved until Newton converges at once:
/// so the limbs stay in the working mode of home. Steps are of least norm in the rank that the mechanism has at home,
/// so redundant loop equations do no harm. Of all displacements at a pose those are taken whose squares (rad, and
/// lengths in units of the reach) have the least sum nearby, so that idle freedoms do not depend on the way. A result
/// depends on nothing but the mechanism and the pose.
class Tracker {
 public:
  /// The mechanism is copied.
  explicit Tracker(const Mechanism& mechanism);

  /// coordinates: [mechanism.coordinates], SI. Physics never throws.
  Tracked track(std::span<const double> coordinates) const;

 private:
  struct State;
  struct System;
  enum class Ending { closed, slow, open, restless };

  System system(const State& state) const;
  Ending close(State& state) const;
  bool settle(State& state) const;
  std::string why(const State& state, Ending ending, double share) const;

  Mechanism unit_;                       ///< lengths in units of the reach
  double reach_;                         ///< m
  std::vector<std::size_t> free_;        ///< components of the platform's pose that are no coordinates
  std::vector<std::size_t> limb_ranks_;  ///< of each limb's own columns at home
};

}  // namespace poesy::file
