#pragma once

#include <optional>

#include "models/file/mobility.h"

/// Mechanisms with rounded numbers, as from CAD, URDF or drawings: the limbs fit each other only to some digits.
namespace poesy::file {

/// The largest gap of the limbs, as a share of the reach, that counts as rounding.
inline constexpr double kRoundedGap = 1e-4;
/// Up to this share of the reach the message names the joint whose numbers would close the loops.
inline constexpr double kNamedGap = 1e-2;

/// A mechanism that moves as its coordinates say.
struct Checked {
  Mechanism mechanism;    ///< with the precision of its numbers
  Mobility home;          ///< by this precision
  double mismatch = 0.0;  ///< m: largest gap of the perfect limbs at home and at the tested poses; 0: exact
};

/// Whether the check requires that a part of the workspace is reached.
enum class Workspace { as_it_is, in_reach };

/// Treats the numbers as exact if the mechanism passes check_mobility() and no path to the poses of
/// workspace_mobility() ends because loops stay open. Otherwise treats them as rounded, if the mechanism passes then.
/// The rank is at the widest gap between singular values, between 1e-6 and 1e-2 of the largest, that lets the mechanism
/// move as its coordinates say; loops must close to kRoundedGap of the reach. If both fail, throws the error of the
/// exact check, or, if the loops close to kNamedGap, an InputError that names the joint whose numbers would close them.
Checked checked(Mechanism mechanism, Workspace workspace);

}  // namespace poesy::file
