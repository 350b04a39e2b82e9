#pragma once

#include <optional>

#include "models/file/mobility.h"

/// Mechanisms whose numbers are rounded, as those of CAD, URDF and drawings are: limbs that are meant to fit each other
/// do so to some digits only.
namespace poesy::file {

/// Up to which share of the reach the limbs' gap counts as rounding.
inline constexpr double kRoundedGap = 1e-4;
/// Up to which share of it the message says which joint's numbers would close the loops.
inline constexpr double kNamedGap = 1e-2;

/// A mechanism that moves as its coordinates say.
struct Checked {
  Mechanism mechanism;    ///< with the precision of its numbers
  Mobility home;          ///< by it
  double mismatch = 0.0;  ///< m: the largest gap of its perfect limbs at home and where they were tried; 0: exact
};

/// Whether some of the workspace must be in reach.
enum class Workspace { as_it_is, in_reach };

/// Takes numbers as exact where they are: the mechanism passes check_mobility(), and no way to the poses of
/// workspace_mobility() ends because loops stay open. Else takes them as rounded, where that makes a mechanism that
/// passes: the rank is then where the gap between singular values is widest, of those between 1e-6 and 1e-2 of the
/// largest that lets the mechanism move as its coordinates say; and loops close to kRoundedGap of the reach. Throws
/// what the exact check says where both fail, and InputError that names the joint whose numbers would close the loops
/// where these close to kNamedGap.
Checked checked(Mechanism mechanism, Workspace workspace);

}  // namespace poesy::file
