#pragma once

#include <array>
#include <optional>

#include "models/lie/se3.h"
#include "models/three_prs/sources.h"

namespace poesy::three_prs {

/// Structural parameters (San et al. 2023, Table 1), in m. z points down, from the rails to the platform.
struct Geometry {
  double a = 0.25;    ///< radius of the circle on which the three rails stand; the paper calls it inscribed
  double c = 0.135;   ///< radius of the circle of the platform's spherical joints; the paper calls it inscribed
  double l = 0.57;    ///< rod length, from the revolute to the spherical joint
  double rail = 0.5;  ///< travel of each carriage: 0 <= q <= rail
  double h = 0.1717;  ///< distance of the tool tip below P, along the platform's z axis; not printed in the paper
};

/// Pose coordinates: the tilts alpha, beta (rad) of R = Rx(alpha) Ry(beta) Rz(gamma) (San et al. 2023, Eq. 1), and the
/// z coordinate of P (m). The coordinates x, y and gamma follow from them (Eq. 6).
struct Pose {
  double alpha;  ///< rotation about the base's x axis, rad
  double beta;   ///< rotation about the platform's y axis after alpha, rad
  double z;      ///< z of P in the base frame, m
};

/// One limb at a nominal pose. The limb's frame {O_i} is the base frame rotated about z by 0, 120 or 240 deg.
struct LimbConfiguration {
  double q;  ///< displacement of the carriage along the rail, downwards from the rail's upper end, m
  /// The swing th_i: rotation of the rod about the limb's y axis, measured from the direction of the rail, rad.
  double swing;
  lie::Vector3<double> c;  ///< c_i: from P to the spherical joint, base frame, m
  lie::Vector3<double> w;  ///< unit vector along the rod, base frame
  lie::Vector3<double> v;  ///< unit vector along the revolute joint's axis, base frame
};

/// The mechanism at a nominal pose.
struct Configuration {
  /// The pose base_T_platform: rotation R of Eq. 1 and position r = (x, y, z) of P.
  lie::Transform<double> platform;
  std::array<LimbConfiguration, kLimbs> limbs;  ///< the limbs in order
};

/// The rotation R_i from limb i's frame to the base frame. limb: i, counted from 0.
lie::Matrix3<double> base_R_limb(std::size_t limb);

/// The pose of the platform with its parasitic motion x, y, gamma (San et al. 2023, Eqs. 1, 6). Precondition: |alpha|,
/// |beta| < 90 deg.
lie::Transform<double> base_T_platform(const Geometry& geometry, const Pose& pose);

/// Inverse kinematics (San et al. 2023, Eqs. 2-8, where B_3z is q_3, misprinted as q_2). If a rod is too short for the
/// pose, q and swing of its limb are NaN.
Configuration configuration(const Geometry& geometry, const Pose& pose);

/// [6 x 6] The Jacobian J of San et al. 2023, Eqs. 10-13. Its rows are drive 1, 2, 3 and constraint 1, 2, 3; its
/// columns are the platform's twist [omega; v] at P in the base frame. J [omega; v] = (q_1', q_2', q_3', 0, 0, 0); the
/// paper misprints the rates on the left.
lie::Matrix6<double> velocity_jacobian(const Configuration& nominal);

/// The condition number of the velocity Jacobian J (velocity_jacobian()). Rotations are scaled to displacements of the
/// spherical joints by the radius c, so the number has no unit. Infinite at a singular pose.
double condition(const Geometry& geometry, const Configuration& nominal);

/// The vector from P to the tool tip in the base frame, R (0, 0, h), m.
lie::Vector3<double> tool(const Geometry& geometry, const lie::Matrix3<double>& R);

/// The pose whose tool tip is at this point (m, base frame), to rounding. None if no such pose exists near the upright
/// pose with tilts between -90 and 90 deg. Does not check whether the limbs reach the pose.
std::optional<Pose> pose_of_tip(const Geometry& geometry, const lie::Vector3<double>& tip);

/// Forward kinematics: the pose for these displacements q of the carriages (m), to rounding, with the platform's joints
/// below their carriages. Newton's method starts at the upright pose. None if no such pose exists near the upright pose
/// with tilts between -90 and 90 deg. Does not check the length of the rails.
std::optional<Pose> pose_of_carriages(const Geometry& geometry, const lie::Vector3<double>& q);

}  // namespace poesy::three_prs
