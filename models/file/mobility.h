#pragma once

#include <optional>
#include <span>
#include <string>
#include <vector>

#include "models/file/mechanism.h"
#include "models/file/tracking.h"

namespace poesy::file {

/// The mobility of a mechanism in one configuration, from the singular values of its loop Jacobian. Of the limbs that
/// end at the same body, one places the body (placing_limbs()). Each further limb gives 6 rows: the twist of its end
/// minus that of the placing limb's end, [omega; v] at the base's origin. That makes 6 (limbs - bodies) rows, where
/// bodies do not include the base. Each joint that moves has a column, and all joints of one drive have a column
/// together. Lengths are in units of the reach. A singular value below the threshold of the mechanism's Precision
/// counts as zero.
struct Mobility {
  std::size_t joints = 0;             ///< number of joints that move
  std::size_t actuated = 0;           ///< number of joints with a drive
  std::size_t drives = 0;             ///< number of drives
  std::size_t loop_equations = 0;     ///< 6 (limbs - bodies)
  std::size_t rank = 0;               ///< rank of the loop Jacobian
  std::size_t freedoms = 0;           ///< number of freedoms: columns - rank
  std::size_t over_constraints = 0;   ///< number of over-constraints: loop_equations - rank
  std::size_t platform_freedoms = 0;  ///< rank of the platform's twists
  std::size_t platform_rotates = 0;   ///< rank of the platform's angular velocities
  std::size_t idle = 0;               ///< number of freedoms that do not move the platform
  /// Rank of the passive joints' columns; if it is below loop_equations, limbs deform each other.
  std::size_t passive_rank = 0;
  std::size_t left_when_locked = 0;  ///< number of freedoms of the passive joints while all drives are held
  /// Number of the freedoms left_when_locked that move the body loose_body; 0 if none moves a body.
  std::size_t loose = 0;
  /// First body that moves while all drives are held: "the platform", "body 'carriage_1'".
  std::string loose_body = {};
  /// The motion of loose_body in words: "joint 'A' of limb 2 is loose, and the platform turns about (0, 0, 1)"; empty
  /// if no body moves.
  std::string loose_text = {};
  Place loose_place = {};                    ///< place of the joint that moves most in the motion of loose_text
  std::size_t coordinates_rank = 0;          ///< rank of the pose coordinates as functions of the joints
  std::vector<double> singular_values = {};  ///< singular values of the loop Jacobian, largest first
  /// Name of a coordinate that depends on the others; empty if there is none.
  std::string dependent = {};

  /// The smallest singular value that counts as nonzero. Precondition: rank > 0.
  double above_gap() const { return singular_values[rank - 1]; }
  /// The largest singular value that counts as zero; empty if there is none.
  std::optional<double> below_gap() const;
};

/// The mobility for these displacements of all joints that move (rad, m) and this pose of the platform.
Mobility mobility(const Mechanism& mechanism, std::span<const double> displacements, const PlatformPose& pose);

/// The mobility at home.
Mobility home_mobility(const Mechanism& mechanism);

/// The mobility at a pose of the workspace.
struct PoseMobility {
  std::vector<double> pose;  ///< [coordinates] pose, SI
  Tracked tracked;           ///< result of tracking the path from home to the pose
  Mobility mobility = {};    ///< mobility at the pose; valid only if the pose is reached
  double turned = 0.0;       ///< angle of the parasitic rotation (rad); 0 if the pose is not reached
  double moved = 0.0;        ///< length of the parasitic displacement of P (m); 0 if the pose is not reached

  /// Returns true if the path ends at the pose.
  bool reached() const { return tracked.unreachable.empty(); }
};

/// The mobility at `count` poses that fill the workspace evenly (Roberts' sequence). The path from home to each pose is
/// tracked.
std::vector<PoseMobility> workspace_mobility(const Mechanism& mechanism, std::size_t count = 20);

/// Throws InputError if the platform cannot move, if the drives do not hold the platform and all other bodies, if they
/// hold every joint, or if the coordinates are dependent or not as many as the platform's freedoms. The message names
/// the joint, freedom or coordinate at fault. More drives than freedoms are over-constraints, not mistakes.
void check_mobility(const Mechanism& mechanism, const Mobility& home);

/// Throws InputError if none of these poses is reached from home, if the mechanism has another number of freedoms at a
/// reached pose than at home, so that home is singular, or if the drives do not hold all bodies at a reached pose.
/// poses: from workspace_mobility(); if empty, nothing is checked.
void check_mobility(const Mechanism& mechanism, const Mobility& home, std::span<const PoseMobility> poses);

}  // namespace poesy::file
