#pragma once

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

}  // namespace poesy::three_prs
