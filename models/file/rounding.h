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

/// A mechanism that passed the check of checked(): its drives hold it, and its coordinates are independent and as many
/// as the freedoms of its platform.
struct Checked {
  Mechanism mechanism;  ///< the mechanism, with the precision of its numbers
  Mobility home;        ///< mobility at home, with this precision
  /// Largest response `gap` of the perfect limbs at home and at the tested poses (m); 0 if the numbers are exact.
  double mismatch = 0.0;
};

/// Whether checked() also checks the mobility at poses of the workspace, of which at least one must be reached
/// (in_reach), or only at home (as_it_is).
enum class Workspace { as_it_is, in_reach };

/// Checks a mechanism. The numbers count as exact if the mechanism passes check_mobility(), and if no path to the poses
/// of workspace_mobility() ends because loops stay open. Otherwise the check is repeated with a lower precision; if the
/// mechanism passes then, its numbers count as rounded. The rank of such a mechanism is taken at a gap between two
/// consecutive singular values. The larger one must be above 1e-6 of the largest singular value, and the smaller one at
/// most 1e-2 of it. The gap is the widest with which the mechanism passes check_mobility(). The loops must close to
/// kRoundedGap of the reach. If the mechanism does not pass as rounded either, the function throws the error of
/// check_mobility(); but if the loops close to kNamedGap, the InputError names the joint whose numbers would close
/// them. If check_mobility() found no error, the numbers count as exact although some loops stay open. A branched
/// mechanism with stiffness is never treated as rounded if check_mobility() finds an error; then this error is thrown.
Checked checked(Mechanism mechanism, Workspace workspace);

}  // namespace poesy::file
