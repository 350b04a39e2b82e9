#pragma once

#include <optional>

#include "models/file/mobility.h"

/// Mechanisms with rounded numbers, for example from CAD, URDF or drawings. Their limbs fit each other only
/// approximately.
namespace poesy::file {

/// The largest response `gap` of perfect limbs that counts as rounding, as a share of the reach.
inline constexpr double kRoundedGap = 1e-4;
/// If the response `gap` of perfect limbs is above kRoundedGap but at most this share of the reach, the error message
/// names the joint whose corrected numbers would close the loops.
inline constexpr double kNamedGap = 1e-2;

/// A mechanism that passed its check: it moves as its coordinates say.
struct Checked {
  Mechanism mechanism;  ///< the mechanism, with the precision of its numbers
  Mobility home;        ///< mobility at home, with this precision
  /// Largest response `gap` of the perfect limbs at home and at the tested poses (m); 0 if the numbers are exact.
  double mismatch = 0.0;
};

/// in_reach: the check requires that some pose of the workspace is reached. as_it_is: it does not.
enum class Workspace { as_it_is, in_reach };

/// Checks a mechanism. The numbers count as exact if it passes check_mobility(), and if no path to the poses of
/// workspace_mobility() ends because loops stay open. Otherwise the check is repeated with a lower precision; if the
/// mechanism passes then, its numbers count as rounded. The rank of such a mechanism is taken at a gap between singular
/// values that are between 1e-6 and 1e-2 of the largest: at the widest gap with which the mechanism moves as its
/// coordinates say. Its loops must close to kRoundedGap of the reach. If the mechanism does not pass as rounded either,
/// the function throws the error of check_mobility(); but if the loops close to kNamedGap, the InputError names the
/// joint whose numbers would close them. If check_mobility() found no error, the numbers count as exact although some
/// loops stay open.
Checked checked(Mechanism mechanism, Workspace workspace);

}  // namespace poesy::file
