#include "models/two_upr_rpu/kinematics.h"

#include <cmath>
#include <numbers>

namespace poesy::two_upr_rpu {
namespace {

using lie::Axis;
using Vector3 = lie::Vector3<double>;

constexpr double kQuarter = std::numbers::pi / 2.0;

/// The angle from a to b about the normal, in [-pi/2, 3 pi/2). Between 0 and pi it equals the paper's arccos. Unlike
/// arccos, it continues beyond pi and below 0 if a leg swings past the line of the platform.
double angle(const Vector3& a, const Vector3& b, const Vector3& normal) {
  const double turn = std::atan2(normal.dot(a.cross(b)), a.dot(b));
  return turn < -kQuarter ? turn + 4.0 * kQuarter : turn;
}

/// The joint variables as absolute angles and lengths (rad, m). Joint displacements are the differences of these
/// variables from their values at the home pose.
std::array<double, 12> joint_variables(const Geometry& g, const Pose& pose) {
  const lie::Transform<double> platform = base_T_platform(pose);
  const Vector3 x = Vector3::UnitX(), y = Vector3::UnitY();
  const Vector3 u = platform.R.col(0), v = platform.R.col(1);
  // Vectors B_i A_i along the legs, Eq. 2.
  const Vector3 leg1 = platform.p + g.l_A * u - g.l_B * x;
  const Vector3 leg2 = platform.p - g.l_A * u + g.l_B * x;
  const Vector3 leg3 = platform.p + g.l_A * v - g.l_B * y;
  return {pose.beta,            // Eq. 3
          angle(x, leg1, v),    // Eq. 4
          leg1.norm(),          // Eq. 1
          -angle(u, leg1, v),   // Eq. 5
          pose.beta,            // Eq. 6
          angle(x, leg2, v),    // Eq. 7
          leg2.norm(),          // Eq. 1
          angle(-u, leg2, -v),  // Eq. 8
          angle(-y, leg3, x),   // Eq. 9
          leg3.norm(),          // Eq. 1
          angle(v, leg3, -x),   // Eq. 10
          pose.gamma};          // Eq. 11
}

std::array<double, 12> home_variables(const Geometry& geometry) {
  return joint_variables(geometry, {geometry.z_0, 0.0, 0.0});
}

lie::Transform<double> rot(Axis axis, double angle) { return lie::rotation<double>(axis, angle); }
lie::Transform<double> trans(Axis axis, double distance) { return lie::translation<double>(axis, distance); }

/// A UPR limb (Du et al. 2022, Eqs. 15 and 16). side: +1 for the first limb, -1 for the second. angle, length: those of
/// the leg at the home pose (rad, m).
chain::Limb upr_limb(const Geometry& g, double side, double angle, double length) {
  return {{{chain::JointType::revolute, false},
           {chain::JointType::revolute, false},
           {chain::JointType::prismatic, true},
           {chain::JointType::revolute, false}},
          {trans(Axis::x, side * (g.l_B + g.d)) * rot(Axis::y, kQuarter),
           trans(Axis::z, -side * g.d) * rot(Axis::x, -kQuarter) * rot(Axis::z, angle - kQuarter),
           rot(Axis::y, kQuarter), trans(Axis::z, length) * rot(Axis::y, -kQuarter) * rot(Axis::z, kQuarter - angle),
           trans(Axis::y, side * g.l_A) * rot(Axis::y, -kQuarter) * rot(Axis::z, -kQuarter)}};
}

/// The RPU limb (Du et al. 2022, Eq. 17). angle, length: those of the leg at the home pose (rad, m).
chain::Limb rpu_limb(const Geometry& g, double angle, double length) {
  return {{{chain::JointType::revolute, false},
           {chain::JointType::prismatic, true},
           {chain::JointType::revolute, false},
           {chain::JointType::revolute, false}},
          {trans(Axis::y, g.l_B) * rot(Axis::y, kQuarter) * rot(Axis::z, angle - kQuarter), rot(Axis::y, kQuarter),
           trans(Axis::z, length) * rot(Axis::y, -kQuarter) * rot(Axis::z, kQuarter - angle),
           trans(Axis::y, -g.c) * rot(Axis::x, -kQuarter),
           trans(Axis::z, g.c - g.l_A) * rot(Axis::y, -kQuarter) * rot(Axis::z, -kQuarter)}};
}

}  // namespace

lie::Transform<double> base_T_platform(const Pose& pose) {
  lie::Transform<double> platform = rot(Axis::x, pose.beta) * rot(Axis::y, pose.gamma);
  platform.p = Vector3(0.0, -pose.z * std::tan(pose.beta), pose.z);
  return platform;
}

std::array<double, 12> joint_displacements(const Geometry& geometry, const Pose& pose) {
  std::array<double, 12> displacements = joint_variables(geometry, pose);
  const std::array<double, 12> home = home_variables(geometry);
  for (std::size_t k = 0; k < displacements.size(); ++k) displacements[k] -= home[k];
  return displacements;
}

std::vector<Vector3> platform_joints(const Geometry& geometry) {
  const double l = geometry.l_A;
  return {{l, 0.0, 0.0}, {-l, 0.0, 0.0}, {0.0, l, 0.0}};
}

chain::ParallelChain parallel_chain(const Geometry& geometry) {
  const std::array<double, 12> home = home_variables(geometry);
  return {{upr_limb(geometry, 1.0, home[1], home[2]), upr_limb(geometry, -1.0, home[5], home[6]),
           rpu_limb(geometry, home[8], home[9])},
          {{1, 0}, {2, 1}, {0, 2}}};
}

}  // namespace poesy::two_upr_rpu
