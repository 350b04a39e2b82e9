#pragma once

#include <string>
#include <vector>

#include "engine/model/model.h"
#include "models/three_prs/errors.h"
#include "models/three_prs/kinematics.h"

namespace poesy::three_prs {

using ErrorMapping = Eigen::Matrix<double, 6, static_cast<int>(kFactors), Eigen::RowMajor>;

/// The matrix G [6 x 60] of J [theta; dr] = G eps. Its rows are those of velocity_jacobian(), its columns the errors
/// eps in the order of factors(). G differs from Eqs. 16-18 of San et al. 2023 in the columns of c. All three
/// components of c enter the drive row of their limb by -w^T R R_i / cos th and its constraint row by -v^T R R_i. The
/// printed -1 is correct only for the projection w^T dc, and the printed sign in Eq. 17 is wrong.
ErrorMapping error_mapping(const Geometry& geometry, const Configuration& nominal);

/// The rows of the matrix Effects at which these effects begin; three rows each.
inline constexpr int kTheta = 0;  ///< rotation of the platform
inline constexpr int kDr = 3;     ///< displacement of P
inline constexpr int kTip = 6;    ///< displacement of the tool tip
inline constexpr int kSwing = 9;  ///< additional swing dphi_i of the rods
inline constexpr int kMotions = 12;
using Effects = Eigen::Matrix<double, kMotions, static_cast<int>(kFactors), Eigen::RowMajor>;

/// [12 x 60] The first-order effects of each error (rad, m per unit of the error). The rows are [theta; dr] = J^-1 G
/// eps in the base frame, the displacement of the tool tip dr + theta x R (0, 0, h), and the swing dphi_i of each rod
/// from Eq. 15 of San et al. 2023. Not finite at a singular pose.
Effects first_order_effects(const Geometry& geometry, const Configuration& nominal);

/// The first-order effect of each error on the platform, and its residual after the best correction by the carriages
/// (San et al. 2023, Section 4.2). The rows of J (velocity_jacobian()) and G (error_mapping()) are the three drive rows
/// and the three constraint rows. So an error has a drive part J^-1 [G_drive; 0] and a constraint part J^-1 [0;
/// G_constraint], and its effect is their sum. The residual is the least norm of effect + J^-1 [dq; 0] over all
/// corrections dq of the three carriages.
///
/// The norm of a twist [theta; dr] is the root mean square displacement of the three spherical joints on the platform,
/// sqrt(1/3 sum of |dr + theta x c_i|^2), in m. This norm combines rotation and displacement without a choice of unit.
/// Not finite at a singular pose.
Separation separation(const Geometry& geometry, const Configuration& nominal);

/// The first-order motions of the platform by its carriages, and the best correction of a displacement.
struct Corrections {
  /// [12 x 3] Motion per displacement of each carriage (rad/m, m/m), rows as in Effects.
  Eigen::Matrix<double, kMotions, static_cast<int>(kLimbs)> motions;
  /// [3 x 6] The matrix that maps a displacement x = [theta; dr] to the correction dq that minimises the norm of x -
  /// motions.topRows<6>() dq. The norm is that of separation().
  Eigen::Matrix<double, static_cast<int>(kLimbs), 6> best;
};

/// The corrections at a nominal configuration. Not finite at a singular pose.
Corrections corrections(const Geometry& geometry, const Configuration& nominal);

/// The description of separation(), with the paper's class of each of the 60 errors. "compensable": the 30 errors that
/// enter the drive rows (24 in the paper, whose scalar c is c_x, c_y and c_z here). "non-compensable": the 21 errors
/// that enter the constraint rows. Empty: the 9 errors without effect.
SeparationDescription separation_description();

}  // namespace poesy::three_prs
