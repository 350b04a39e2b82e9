#pragma once

#include <string>
#include <vector>

#include "engine/model/model.h"
#include "models/three_prs/errors.h"
#include "models/three_prs/kinematics.h"

namespace poesy::three_prs {

using ErrorMapping = Eigen::Matrix<double, 6, static_cast<int>(kFactors), Eigen::RowMajor>;

/// G of J [theta; dr] = G eps, [6 x 60], rows as in velocity_jacobian(), columns as in factors(). Differs from Eqs.
/// 16-18 in c, whose components enter all three rows by -w^T R R_i / cos th and the constraint rows by -v^T R R_i: the
/// printed -1 is correct only for the projection w^T dc, and the printed sign in Eq. 17 is wrong.
ErrorMapping error_mapping(const Geometry& geometry, const Configuration& nominal);

/// Rows of Effects.
inline constexpr int kTheta = 0;  ///< rotation of the platform
inline constexpr int kDr = 3;     ///< displacement of P
inline constexpr int kTip = 6;    ///< displacement of the tool tip
inline constexpr int kSwing = 9;  ///< additional swing dphi_i of the rods
inline constexpr int kMotions = 12;
using Effects = Eigen::Matrix<double, kMotions, static_cast<int>(kFactors), Eigen::RowMajor>;

/// The first-order effects of each error, [12 x 60] (rad, m per unit): [theta; dr] = J^-1 G eps in the base frame, the
/// tool tip's displacement dr + theta x R (0, 0, h), and the swing dphi_i of each rod from Eq. 15. Not finite at a
/// singular pose.
Effects first_order_effects(const Geometry& geometry, const Configuration& nominal);

/// The first-order effect of each error on the platform, and its residual after the best correction of the carriages
/// (San et al. 2023, Section 4.2). J of velocity_jacobian() and G of error_mapping() both have the rows drive and
/// constraint. An error has the drive part J^-1 [G_drive; 0] and the constraint part J^-1 [0; G_constraint]; its effect
/// is the sum of both. The residual is the minimum of effect + J^-1 [dq; 0] over all corrections dq of the three
/// carriages.
///
/// The norm of a twist [theta; dr] is the root mean square displacement of the three spherical joints on the platform,
/// sqrt(1/3 sum of |dr + theta x c_i|^2), in m: it combines rotation and displacement without a choice of unit. Not
/// finite at a singular pose.
Separation separation(const Geometry& geometry, const Configuration& nominal);

/// First-order motions of the platform by its carriages, and the best correction.
struct Corrections {
  Eigen::Matrix<double, kMotions, static_cast<int>(kLimbs)> motions;  ///< per unit of each carriage, rows of Effects
  /// The matrix from a displacement x = [theta; dr] to the dq that minimises the norm of x - motions.topRows<6>() dq;
  /// norm as in separation().
  Eigen::Matrix<double, static_cast<int>(kLimbs), 6> best;
};

/// The corrections at a nominal configuration. Not finite at a singular pose.
Corrections corrections(const Geometry& geometry, const Configuration& nominal);

/// The paper's class of each error, [60]: "compensable" for 24 that enter its drive rows, "non-compensable" for 21 that
/// enter its constraint rows, empty for the 9 without effect. The paper's scalar c is c_x, c_y and c_z here, so 30 are
/// compensable.
SeparationDescription separation_description();

}  // namespace poesy::three_prs
