#pragma once

#include <string>
#include <vector>

#include "engine/model/model.h"
#include "models/three_prs/errors.h"
#include "models/three_prs/kinematics.h"

namespace poesy::three_prs {

using ErrorMapping = Eigen::Matrix<double, 6, static_cast<int>(kFactors), Eigen::RowMajor>;

/// G of J [theta; dr] = G eps, [6 x 60], rows as in velocity_jacobian, columns as in factors().
/// Differs from Eqs. 16-18 in c, which enters all three rows' components by -w^T R R_i / cos th and the constraint rows
/// by -v^T R R_i: the printed -1 holds for the projection w^T dc alone, and the printed sign in Eq. 17 is wrong.
ErrorMapping error_mapping(const Geometry& geometry, const Configuration& nominal);

/// Rows of Effects.
inline constexpr int kTheta = 0;  ///< rotation of the platform
inline constexpr int kDr = 3;     ///< displacement of P
inline constexpr int kTip = 6;    ///< displacement of the tool tip
inline constexpr int kSwing = 9;  ///< additional swing dphi_i of the rods
inline constexpr int kMotions = 12;
using Effects = Eigen::Matrix<double, kMotions, static_cast<int>(kFactors), Eigen::RowMajor>;

/// What each error does to first order, [12 x 60]: [theta; dr] = J^-1 G eps in the base frame, dr + theta x R (0, 0,
/// h), and what remains of Eq. 15 along the swing of each rod. Not finite at a singular pose.
Effects first_order_effects(const Geometry& geometry, const Configuration& nominal);

/// How each error moves the platform to first order, and what correcting the carriages leaves of it (San et al. 2023,
/// Section 4.2). With J of velocity_jacobian and G of error_mapping, both with rows drive and constraint, an error has
/// the drive part J^-1 [G_drive; 0], the constraint part J^-1 [0; G_constraint], and the sum of both as its effect. The
/// residual is the smallest that effect + J^-1 [dq; 0] becomes, over all corrections dq of the three carriages.
///
/// A twist [theta; dr] is measured by the root mean square displacement of the three spherical joints on the platform,
/// sqrt(1/3 sum of |dr + theta x c_i|^2), in m: so rotation and displacement are comparable, without a choice of unit.
/// Not finite at a singular pose.
Separation separation(const Geometry& geometry, const Configuration& nominal);

/// Motions of the platform by its carriages to first order, and which of them corrects best.
struct Corrections {
  Eigen::Matrix<double, kMotions, static_cast<int>(kLimbs)> motions;  ///< by a unit of each carriage, rows of Effects
  /// From a displacement x = [theta; dr] to the dq with which x - motions.topRows<6>() dq is the smallest, by the
  /// measure of separation().
  Eigen::Matrix<double, static_cast<int>(kLimbs), 6> best;
};

/// At a nominal configuration. Not finite at a singular pose.
Corrections corrections(const Geometry& geometry, const Configuration& nominal);

/// What the paper calls each error, [60]: "compensable" for 24 that enter its drive rows, "non-compensable" for 21 that
/// enter its constraint rows, empty for the 9 without effect. The paper has a scalar c where c_x, c_y and c_z stand
/// here, so 30 are compensable.
SeparationDescription separation_description();

}  // namespace poesy::three_prs
