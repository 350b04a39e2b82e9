#pragma once

#include <optional>
#include <span>
#include <string>
#include <vector>

#include "models/file/mechanism.h"
#include "models/file/tracking.h"

namespace poesy::file {

/// How a mechanism can move at one configuration, by the singular values of its loop Jacobian: 6 (limbs - bodies) rows,
/// bodies without the base, the twists of a limb's end less those of the first limb that ends at the same body, at the
/// base's origin, and a column for each motion: of a joint
/// that moves, or of all joints of one drive together; lengths are in units of the reach. Below which share of the
/// largest a singular value counts as zero, the mechanism's Precision says.
struct Mobility {
  std::size_t joints = 0;             ///< that move
  std::size_t actuated = 0;           ///< of them
  std::size_t drives = 0;             ///< that move these
  std::size_t loop_equations = 0;     ///< 6 (limbs - bodies)
  std::size_t rank = 0;               ///< of the loop Jacobian
  std::size_t freedoms = 0;           ///< motions - rank
  std::size_t over_constraints = 0;   ///< loop_equations - rank
  std::size_t platform_freedoms = 0;  ///< of its twists
  std::size_t platform_rotates = 0;   ///< of its angular velocities
  std::size_t idle = 0;               ///< freedoms that leave the platform where it is
  std::size_t passive_rank = 0;       ///< of the passive joints' columns; below loop_equations limbs deform each other
  std::size_t left_when_locked = 0;   ///< freedoms of the passive joints alone
  std::size_t loose = 0;              ///< of them, that move the platform, or another body that the platform does not
  std::string loose_body = {};        ///< which: "the platform", "body 'carriage_1'"
  std::string loose_text = {};        ///< which: "the platform turns about (0, 0, 1)"; empty: none
  Place loose_place = {};             ///< of the joint that moves most then
  std::size_t coordinates_rank = 0;   ///< of the pose's coordinates as functions of the joints
  std::vector<double> singular_values = {};  ///< of the loop Jacobian, largest first
  std::string dependent = {};                ///< a coordinate that follows from the others; empty: none

  /// The smallest singular value that counts. Precondition: rank > 0.
  double above_gap() const { return singular_values[rank - 1]; }
  /// The largest that does not; empty where all count.
  std::optional<double> below_gap() const;
};

/// At these displacements [moving] (rad, m), where the platform has this pose.
Mobility mobility(const Mechanism& mechanism, std::span<const double> displacements, const PlatformPose& pose);

/// At home.
Mobility home_mobility(const Mechanism& mechanism);

/// Mobility at a pose of the workspace.
struct PoseMobility {
  std::vector<double> pose;  ///< [coordinates], SI
  Tracked tracked;           ///< the way there from home
  Mobility mobility = {};    ///< where it is reached
  double turned = 0.0;       ///< rad: the largest rotation besides the coordinates; 0 where it is not reached
  double moved = 0.0;        ///< m: likewise of P's place

  /// Whether the mechanism comes there.
  bool reached() const { return tracked.unreachable.empty(); }
};

/// At `count` poses that fill the workspace evenly (Roberts' sequence), reached from home.
std::vector<PoseMobility> workspace_mobility(const Mechanism& mechanism, std::size_t count = 20);

/// Throws InputError where drives do not hold the platform or hold every joint, or where coordinates are not
/// independent or not as many as the platform's freedoms: with the joint, freedom or coordinate that is to blame. More
/// drives than freedoms are over-constraints, not mistakes.
void check_mobility(const Mechanism& mechanism, const Mobility& home);

/// Throws InputError where home is a special configuration: no pose of the workspace is reached, home has another
/// number of freedoms than they have, or drives hold the platform at home alone.
void check_mobility(const Mechanism& mechanism, const Mobility& home, std::span<const PoseMobility> poses);

}  // namespace poesy::file
