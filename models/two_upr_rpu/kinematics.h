#pragma once

#include <array>
#include <vector>

#include "models/chain/limb.h"

namespace poesy::two_upr_rpu {

/// Structural parameters (Du et al. 2022, Table 4) and the home pose, in m.
struct Geometry {
  double l_A = 0.06;  ///< half of A1 A2, and o_A to A3
  double l_B = 0.15;  ///< half of B1 B2, and o_B to B3
  double c = 0.025;   ///< offset of frame F_3,4 from o_A along the platform's v axis
  double d = 0.115;   ///< offset of frames F_1,1 and F_2,1 outwards along x
  double z_0 = -0.2;  ///< z of the platform at the home configuration
};

/// Pose coordinates: z of o_A, and the rotations about x (beta) and about the platform's v (gamma).
struct Pose {
  double z;      ///< of o_A in the base frame, m
  double beta;   ///< rad
  double gamma;  ///< rad
};

/// base_T_platform: R = Rx(beta) Ry(gamma) (Eq. 12), o_A = (0, -z tan beta, z).
lie::Transform<double> base_T_platform(const Pose& pose);

/// Displacements q_i,j (rad, m) of the four joints of the three limbs from the home configuration (Eqs. 1-11), limb by
/// limb. Angles are computed by atan2 about the joint's axis: equal to the printed arccos in its range, without its
/// loss of digits near 0 and pi, and continued past pi, where a leg swings past the line of the platform.
std::array<double, 12> joint_displacements(const Geometry& geometry, const Pose& pose);

/// The points A1, A2, A3 where the limbs hold the platform, in its frame (m).
std::vector<lie::Vector3<double>> platform_joints(const Geometry& geometry);

/// The mechanism as limbs in local product-of-exponentials form (Eqs. 13-23): RRPR, RRPR, RPRR with actuated P, and the
/// pairs (2,1), (3,2), (1,3) of Eq. 41.
chain::ParallelChain parallel_chain(const Geometry& geometry);

}  // namespace poesy::two_upr_rpu
