#pragma once

#include <optional>
#include <span>
#include <string>
#include <vector>

#include "models/file/mechanism.h"
#include "models/file/tracking.h"

namespace poesy::file {

/// The mobility of a mechanism at one configuration, from the singular values of its loop Jacobian. Of the limbs that
/// end at the same body, the first places the body, and each further one gives 6 rows: the twist of its end minus that
/// of the first, [omega; v] at the base's origin; in all 6 (limbs - bodies) rows, bodies without the base. Each joint
/// that moves, or all joints of one drive together, have a column. Lengths are in units of the reach. A singular value
/// below the threshold of the mechanism's Precision counts as zero.
struct Mobility {
  std::size_t joints = 0;             ///< number of joints that move
  std::size_t actuated = 0;           ///< number of joints with a drive
  std::size_t drives = 0;             ///< number of drives
  std::size_t loop_equations = 0;     ///< 6 (limbs - bodies)
  std::size_t rank = 0;               ///< of the loop Jacobian
  std::size_t freedoms = 0;           ///< columns - rank
  std::size_t over_constraints = 0;   ///< loop_equations - rank
  std::size_t platform_freedoms = 0;  ///< rank of the platform's twists
  std::size_t platform_rotates = 0;   ///< rank of the platform's angular velocities
  std::size_t idle = 0;               ///< freedoms that do not move the platform
  std::size_t passive_rank = 0;  ///< rank of the passive joints' columns; below loop_equations limbs deform each other
  std::size_t left_when_locked = 0;          ///< freedoms of the passive joints alone
  std::size_t loose = 0;                     ///< part of left_when_locked that moves the platform or another body
  std::string loose_body = {};               ///< the moving body: "the platform", "body 'carriage_1'"
  std::string loose_text = {};               ///< its motion: "the platform turns about (0, 0, 1)"; empty: none
  Place loose_place = {};                    ///< of the joint that moves most in this motion
  std::size_t coordinates_rank = 0;          ///< rank of the pose's coordinates as functions of the joints
  std::vector<double> singular_values = {};  ///< of the loop Jacobian, largest first
  std::string dependent = {};                ///< a coordinate that depends on the others; empty: none

  /// The smallest singular value that counts as nonzero. Precondition: rank > 0.
  double above_gap() const { return singular_values[rank - 1]; }
  /// The largest singular value that counts as zero; empty if there is none.
  std::optional<double> below_gap() const;
};

/// The mobility at these displacements [moving] (rad, m) and this pose of the platform.
Mobility mobility(const Mechanism& mechanism, std::span<const double> displacements, const PlatformPose& pose);

/// The mobility at home.
Mobility home_mobility(const Mechanism& mechanism);

/// The mobility at a pose of the workspace.
struct PoseMobility {
  std::vector<double> pose;  ///< [coordinates], SI
  Tracked tracked;           ///< path to the pose from home
  Mobility mobility = {};    ///< valid if the pose is reached
  double turned = 0.0;       ///< parasitic rotation (rad), the largest; 0 if the pose is not reached
  double moved = 0.0;        ///< parasitic displacement of P (m), the largest; 0 if the pose is not reached

  /// Whether the path ends at the pose.
  bool reached() const { return tracked.unreachable.empty(); }
};

/// The mobility at `count` poses that fill the workspace evenly (Roberts' sequence), reached from home.
std::vector<PoseMobility> workspace_mobility(const Mechanism& mechanism, std::size_t count = 20);

/// Throws InputError if the drives do not hold the platform or hold every joint, or if the coordinates are dependent or
/// not as many as the platform's freedoms. The message names the joint, freedom or coordinate at fault. More drives
/// than freedoms are over-constraints, not mistakes.
void check_mobility(const Mechanism& mechanism, const Mobility& home);

/// Throws InputError if home is a singular configuration: no pose of the workspace is reached, the poses have another
/// number of freedoms, or the drives hold the platform only at home.
void check_mobility(const Mechanism& mechanism, const Mobility& home, std::span<const PoseMobility> poses);

}  // namespace poesy::file
