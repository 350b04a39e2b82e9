#include "models/two_upr_rpu/kinematics.h"

#include <cmath>
#include <numbers>

namespace poesy::two_upr_rpu {
namespace {

using lie::Axis;
using Vector3 = lie::Vector3<double>;

double angle_between(const Vector3& a, const Vector3& b) { return std::atan2(a.cross(b).norm(), a.dot(b)); }

/// Leg vectors B_i A_i (Eq. 2), A_1 A_2 and the platform's v axis, in the base frame.
struct Vectors {
  std::array<Vector3, 3> leg;
  Vector3 a1_a2;
  Vector3 v;
};

Vectors vectors(const Geometry& g, const Pose& pose) {
  const lie::Transform<double> platform = base_T_platform(pose);
  const Vector3 u = platform.R.col(0);
  const Vector3 v = platform.R.col(1);
  return {{platform.p + g.l_A * u - Vector3(g.l_B, 0.0, 0.0), platform.p - g.l_A * u + Vector3(g.l_B, 0.0, 0.0),
           platform.p + g.l_A * v - Vector3(0.0, g.l_B, 0.0)},
          -2.0 * g.l_A * u,
          v};
}

/// The joint variables as absolute angles and lengths; displacements are their differences from home.
std::array<double, 12> joint_variables(const Geometry& geometry, const Pose& pose) {
  const Vectors w = vectors(geometry, pose);
  const Vector3 x = Vector3::UnitX();
  const Vector3 y = Vector3::UnitY();
  return {pose.beta,                           // Eq. 3
          angle_between(x, w.leg[0]),          // Eq. 4
          w.leg[0].norm(),                     // Eq. 1
          -angle_between(-w.a1_a2, w.leg[0]),  // Eq. 5
          pose.beta,                           // Eq. 6
          angle_between(x, w.leg[1]),          // Eq. 7
          w.leg[1].norm(),                     // Eq. 1
          angle_between(w.a1_a2, w.leg[1]),    // Eq. 8
          angle_between(-y, w.leg[2]),         // Eq. 9
          w.leg[2].norm(),                     // Eq. 1
          angle_between(w.v, w.leg[2]),        // Eq. 10
          pose.gamma};                         // Eq. 11
}

std::array<double, 12> home_variables(const Geometry& geometry) {
  return joint_variables(geometry, {geometry.z_0, 0.0, 0.0});
}

constexpr double kQuarter = std::numbers::pi / 2.0;

lie::Transform<double> rot(Axis axis, double angle) { return lie::rotation<double>(axis, angle); }
lie::Transform<double> trans(Axis axis, double distance) { return lie::translation<double>(axis, distance); }

/// Eqs. 15 and 16: side is +1 for the first limb, -1 for the second; angle and length at home.
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

/// Eq. 17.
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

chain::ParallelChain parallel_chain(const Geometry& geometry) {
  const std::array<double, 12> home = home_variables(geometry);
  return {{upr_limb(geometry, 1.0, home[1], home[2]), upr_limb(geometry, -1.0, home[5], home[6]),
           rpu_limb(geometry, home[8], home[9])},
          {{1, 0}, {2, 1}, {0, 2}}};
}

}  // namespace poesy::two_upr_rpu
