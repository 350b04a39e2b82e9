#pragma once

#include <array>
#include <vector>

#include "models/chain/limb.h"

namespace poesy::two_upr_rpu {

/// Structural parameters (Du et al. 2022, Table 4) and the home pose, in m.
struct Geometry {
  double l_A = 0.06;  ///< half the distance A1 A2, and the distance from o_A to A3
  double l_B = 0.15;  ///< half the distance B1 B2, and the distance from o_B to B3
  double c = 0.025;   ///< offset of frame F_3,4 from o_A along the platform's v axis
  double d = 0.115;   ///< outward offset of frames F_1,1 and F_2,1 along x
  double z_0 = -0.2;  ///< z of the platform point o_A at the home configuration
};

/// Pose coordinates: z of the platform point o_A, and rotations about the base's x axis (beta) and the platform's v
/// axis (gamma).
struct Pose {
  double z;      ///< z of o_A in the base frame, m
  double beta;   ///< rotation about the base's x axis, rad
  double gamma;  ///< rotation about the platform's v axis, rad
};

/// The pose of the platform in the base frame: R = Rx(beta) Ry(gamma) (Du et al. 2022, Eq. 12), o_A = (0, -z tan beta,
/// z).
lie::Transform<double> base_T_platform(const Pose& pose);

/// The displacements q_i,j (rad, m) of the four joints j of each of the three limbs i, limb by limb (Du et al. 2022,
/// Eqs. 1-11). The displacements are counted from the home configuration. Angles are computed by atan2 about the
/// joint's axis. From 0 to pi they equal the printed arccos, but lose no digits near 0 and pi. The angles continue past
/// pi if a leg swings past the line of the platform.
std::array<double, 12> joint_displacements(const Geometry& geometry, const Pose& pose);

/// The points A1, A2, A3 (m, platform frame) at which the limbs are joined to the platform.
std::vector<lie::Vector3<double>> platform_joints(const Geometry& geometry);

/// The mechanism as limbs in local product-of-exponentials form (Du et al. 2022, Eqs. 13-23): RRPR, RRPR, RPRR with
/// actuated P. Its loops are the pairs of limbs (2,1), (3,2), (1,3) of Eq. 41.
chain::ParallelChain parallel_chain(const Geometry& geometry);

}  // namespace poesy::two_upr_rpu
