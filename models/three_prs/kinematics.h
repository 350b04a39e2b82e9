#pragma once

#include <array>
#include <optional>

#include "models/lie/se3.h"
#include "models/three_prs/sources.h"

namespace poesy::three_prs {

/// Structural parameters (San et al. 2023, Table 1), in m. z points down, from the rails to the platform.
struct Geometry {
  double a = 0.25;    ///< radius of the circle on which the three rails stand; "inscribed" in the text
  double c = 0.135;   ///< radius of the circle of the spherical joints on the platform; "inscribed" in the text
  double l = 0.57;    ///< rod length, from the revolute to the spherical joint
  double rail = 0.5;  ///< travel of each carriage: 0 <= q <= rail
  double h = 0.1717;  ///< tool tip below P along the platform's z axis; not printed in the paper
};

/// Pose coordinates: the tilts alpha, beta (rad) of R = Rx(alpha) Ry(beta) Rz(gamma) (Eq. 1) and the z of P (m). x, y
/// and gamma follow from them (Eq. 6).
struct Pose {
  double alpha;  ///< rotation about the base's x axis, rad
  double beta;   ///< rotation about the platform's y axis after alpha, rad
  double z;      ///< of P in the base frame, m
};

/// One limb at a nominal pose. The limb's frame {O_i} is the base frame turned about z by 0, 120, 240 deg.
struct LimbConfiguration {
  double q;                ///< carriage along the rail, downwards from its upper end, m
  double swing;            ///< th_i, rotation of the rod about the limb's y axis from the rail's direction, rad
  lie::Vector3<double> c;  ///< from P to the spherical joint, base frame, m
  lie::Vector3<double> w;  ///< unit vector along the rod, base frame
  lie::Vector3<double> v;  ///< unit vector along the revolute joint, base frame
};

/// The mechanism at a pose.
struct Configuration {
  lie::Transform<double> platform;              ///< base_T_platform: R of Eq. 1, r = (x, y, z)
  std::array<LimbConfiguration, kLimbs> limbs;  ///< one after the other
};

/// R_i: rotation from limb i's frame to the base frame, i counted from 0.
lie::Matrix3<double> base_R_limb(std::size_t limb);

/// Pose of the platform with its parasitic motion x, y, gamma (Eqs. 1, 6). |alpha|, |beta| < 90 deg.
lie::Transform<double> base_T_platform(const Geometry& geometry, const Pose& pose);

/// Inverse kinematics (Eqs. 2-8; B_3z is q_3, misprinted as q_2). If a rod is too short, q and swing of its limb are
/// NaN.
Configuration configuration(const Geometry& geometry, const Pose& pose);

/// J of Eqs. 10-13, [6 x 6]: rows drive 1, 2, 3, constraint 1, 2, 3, columns [omega; v] of the platform at P in the
/// base frame. J [omega; v] = (q_1', q_2', q_3', 0, 0, 0); the paper misprints the rates on the left.
lie::Matrix6<double> velocity_jacobian(const Configuration& nominal);

/// The condition number of J. Rotations are measured by the displacement of the spherical joints, omega times c, so
/// that it has no unit. Infinity at a singular pose.
double condition(const Geometry& geometry, const Configuration& nominal);

/// From P to the tool tip in the base frame: R (0, 0, h).
lie::Vector3<double> tool(const Geometry& geometry, const lie::Matrix3<double>& R);

/// The pose whose tool tip is at this point of the base frame (m), to rounding. None if no such pose exists between -90
/// and 90 deg near the upright pose. Does not check whether the limbs reach it.
std::optional<Pose> pose_of_tip(const Geometry& geometry, const lie::Vector3<double>& tip);

/// Forward kinematics: the pose with the carriages at these q (m), to rounding, by Newton from the upright pose, with
/// the platform's joints below their carriages. None if no such pose exists between -90 and 90 deg near the upright
/// pose. Does not check the length of the rails.
std::optional<Pose> pose_of_carriages(const Geometry& geometry, const lie::Vector3<double>& q);

}  // namespace poesy::three_prs
