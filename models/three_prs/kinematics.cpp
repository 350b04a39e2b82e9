#include "models/three_prs/kinematics.h"

#include <cmath>
#include <limits>
#include <numbers>

#include "engine/linalg/decompositions.h"

namespace poesy::three_prs {
namespace {

using Vector3 = lie::Vector3<double>;
using Matrix3 = lie::Matrix3<double>;
using Matrix6 = lie::Matrix6<double>;

LimbConfiguration limb_configuration(const Geometry& g, const lie::Transform<double>& platform, std::size_t limb) {
  const Matrix3 R_i = base_R_limb(limb);
  const Vector3 c = g.c * (platform.R * R_i.col(0));
  const Vector3 joint = R_i.transpose() * (platform.p + c);
  const double outwards = joint.x() - g.a;
  const double down = std::sqrt(g.l * g.l - outwards * outwards);
  const double swing = std::atan2(outwards, down);
  return {joint.z() - down, swing, c, R_i * Vector3(std::sin(swing), 0.0, std::cos(swing)), R_i.col(1)};
}

bool is_tilt(double angle) { return std::abs(angle) < std::numbers::pi / 2.0; }

/// [6 x 6] The matrix that multiplies a twist of the platform: the constraint rows of J, then three rows that give the
/// tip's velocity.
Matrix6 tip_jacobian(const Geometry& geometry, const Configuration& at) {
  Matrix6 rows;
  rows.topRows<3>() = velocity_jacobian(at).bottomRows<3>();
  rows.bottomLeftCorner<3, 3>() = -lie::hat<double>(tool(geometry, at.platform.R));
  rows.bottomRightCorner<3, 3>().setIdentity();
  return rows;
}

/// The rates of alpha, beta and gamma if the platform turns by omega: omega = e_x alpha' + Rx e_y beta' + R e_z gamma'.
Vector3 angle_rates(const Pose& pose, const Matrix3& R, const Vector3& omega) {
  Matrix3 axes;
  axes << Vector3::UnitX(), Vector3(0.0, std::cos(pose.alpha), std::sin(pose.alpha)), R.col(2);
  return linalg::solve(axes, omega);
}

/// The pose after a small twist of the platform that its constraints allow.
Pose moved(const Pose& pose, const Matrix3& R, const lie::Screw<double>& twist) {
  const Vector3 rates = angle_rates(pose, R, twist.head<3>());
  return {pose.alpha + rates[0], pose.beta + rates[1], pose.z + twist[5]};
}

Vector3 carriages(const Configuration& at) { return {at.limbs[0].q, at.limbs[1].q, at.limbs[2].q}; }

/// Returns true if a point is so far away that squares of its distance may overflow, or that rounding there exceeds the
/// size of the mechanism. Nearer points that the limbs do not reach are rejected by the model, with the reason.
bool is_far(const Geometry& g, const Vector3& place) {
  constexpr double kReaches = 1e6;
  const double reach = g.rail + g.a + g.l + g.c + g.h;
  return !(place.cwiseAbs().maxCoeff() <= kReaches * reach);
}

/// The upright pose at the mean height of carriages with displacements q (m) along their rails.
Pose upright(const Geometry& g, const Vector3& q) {
  return {0.0, 0.0, q.mean() + std::sqrt(g.l * g.l - (g.c - g.a) * (g.c - g.a))};
}

}  // namespace

Matrix3 base_R_limb(std::size_t limb) {
  constexpr std::array kCosine{1.0, -0.5, -0.5};
  constexpr std::array kSine{0.0, 0.5 * std::numbers::sqrt3, -0.5 * std::numbers::sqrt3};
  Matrix3 R;
  R << kCosine[limb], -kSine[limb], 0.0, kSine[limb], kCosine[limb], 0.0, 0.0, 0.0, 1.0;
  return R;
}

lie::Transform<double> base_T_platform(const Geometry& geometry, const Pose& pose) {
  const double ca = std::cos(pose.alpha), sa = std::sin(pose.alpha);
  const double cb = std::cos(pose.beta), sb = std::sin(pose.beta);
  const double gamma = -std::atan(sa * sb / (ca + cb));
  const double cg = std::cos(gamma), sg = std::sin(gamma);
  lie::Transform<double> platform;
  platform.R << cb * cg, -cb * sg, sb,                                         //
      sa * sb * cg + ca * sg, -sa * sb * sg + ca * cg, -sa * cb,               //
      -ca * sb * cg + sa * sg, ca * sb * sg + sa * cg, ca * cb;                //
  platform.p = Vector3(0.5 * geometry.c * (cb * cg + sa * sb * sg - ca * cg),  //
                       -geometry.c * (sa * sb * cg + ca * sg), pose.z);
  return platform;
}

Configuration configuration(const Geometry& geometry, const Pose& pose) {
  Configuration nominal;
  nominal.platform = base_T_platform(geometry, pose);
  for (std::size_t i = 0; i < kLimbs; ++i) nominal.limbs[i] = limb_configuration(geometry, nominal.platform, i);
  return nominal;
}

Matrix6 velocity_jacobian(const Configuration& nominal) {
  Matrix6 J;
  for (std::size_t i = 0; i < kLimbs; ++i) {
    const LimbConfiguration& limb = nominal.limbs[i];
    const auto row = static_cast<Eigen::Index>(i);
    J.row(row) << (limb.c.cross(limb.w) / limb.w.z()).transpose(), (limb.w / limb.w.z()).transpose();
    J.row(row + 3) << limb.c.cross(limb.v).transpose(), limb.v.transpose();
  }
  return J;
}

double condition(const Geometry& geometry, const Configuration& nominal) {
  Matrix6 J = velocity_jacobian(nominal);
  J.leftCols<3>() /= geometry.c;
  const Eigen::VectorXd values = linalg::singular_values(J);
  const double largest = values[0];
  const double smallest = values[5];
  const double rounding = 6.0 * std::numeric_limits<double>::epsilon();
  return smallest > rounding * largest ? largest / smallest : std::numeric_limits<double>::infinity();
}

Vector3 tool(const Geometry& geometry, const Matrix3& R) { return geometry.h * R.col(2); }

std::optional<Pose> pose_of_tip(const Geometry& geometry, const Vector3& tip) {
  constexpr int kIterations = 50;
  if (is_far(geometry, tip)) return std::nullopt;
  const double rounding = 8.0 * std::numeric_limits<double>::epsilon() * std::max(1.0, tip.norm());
  Pose pose{0.0, 0.0, tip.z() - geometry.h};
  for (int iteration = 0; iteration < kIterations; ++iteration) {
    const Configuration at = configuration(geometry, pose);
    const Vector3 missing = tip - at.platform.p - tool(geometry, at.platform.R);
    if (missing.norm() <= rounding) return pose;
    lie::Screw<double> wanted = lie::Screw<double>::Zero();
    wanted.tail<3>() = missing;
    const lie::Screw<double> twist = linalg::solve(tip_jacobian(geometry, at), wanted);
    pose = moved(pose, at.platform.R, twist);
    if (!is_tilt(pose.alpha) || !is_tilt(pose.beta)) return std::nullopt;
  }
  return std::nullopt;
}

std::optional<Pose> pose_of_carriages(const Geometry& geometry, const Vector3& q) {
  constexpr int kIterations = 50;
  constexpr double kShortest = 1.0 / 1024.0;
  if (is_far(geometry, q)) return std::nullopt;
  const double rounding = 8.0 * std::numeric_limits<double>::epsilon() * std::max(1.0, q.norm());
  Pose pose = upright(geometry, q);
  Configuration at = configuration(geometry, pose);
  for (int iteration = 0; iteration < kIterations; ++iteration) {
    const Vector3 missing = q - carriages(at);
    if (missing.norm() <= rounding) return pose;
    lie::Screw<double> wanted = lie::Screw<double>::Zero();
    wanted.head<3>() = missing;
    const lie::Screw<double> twist = linalg::solve(velocity_jacobian(at), wanted);
    // A full step may lead away from the solution, or to a pose at which a rod is too short. Then a shorter step is
    // taken.
    bool nearer = false;
    for (double share = 1.0; share >= kShortest && !nearer; share *= 0.5) {
      const Pose next = moved(pose, at.platform.R, share * twist);
      if (!is_tilt(next.alpha) || !is_tilt(next.beta)) continue;
      const Configuration there = configuration(geometry, next);
      if (!((q - carriages(there)).norm() < missing.norm())) continue;
      pose = next;
      at = there;
      nearer = true;
    }
    if (!nearer) return std::nullopt;
  }
  return std::nullopt;
}

}  // namespace poesy::three_prs
