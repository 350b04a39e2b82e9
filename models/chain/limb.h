#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include "models/lie/se3.h"

namespace poesy::chain {

enum class JointType {
  revolute,  ///< turns about the local z axis
  prismatic  ///< slides along the local z axis
};

/// A joint with one degree of freedom.
struct Joint {
  JointType type;  ///< revolute or prismatic
  /// True if a drive or a fixed connection holds the joint; false if it is passive and reacts to errors.
  bool actuated;
  double advance = 0.0;  ///< pitch of a helical joint (type revolute), m per rad along its axis; else 0
  bool fixed = false;    ///< true for a fixed frame between two parts: `actuated` is true, but there is no drive
  /// The number of an actuated joint's drive. Joints with the same number, in any limbs, share one drive, which moves
  /// all of them by the same displacement. 0: the joint has a drive of its own.
  std::size_t drive = 0;
};

/// A serial limb in local product-of-exponentials form (Du et al. 2022, Eq. 13): n joints between n + 1 fixed frames.
/// At zero displacement, home[0] is the first joint's frame seen from the base, home[j] is the frame of joint j + 1
/// seen from that of joint j, and home[n] is the platform seen from the last joint's frame.
struct Limb {
  std::vector<Joint> joints;                 ///< [n] joints from base to platform
  std::vector<lie::Transform<double>> home;  ///< [n + 1] fixed frames without errors
  /// The centre about which an angular error of the first or last frame rotates. If true, the centre is the point of
  /// the first or last joint. If false, as published, the centre is the origin of base or platform. The axes of
  /// rotation are those of base and platform in either case.
  bool errors_at_joints = false;

  /// The number of fixed frames: one more than the number of joints.
  std::size_t frames() const { return home.size(); }
  /// The number of joints that are not actuated.
  std::size_t passive_joints() const;
  /// The factors of fixed frame j before and behind its error Delta g. The frame with error is before * Delta g *
  /// behind, or before * Delta g^-1 * behind if it is the last one.
  /// @{
  lie::Transform<double> before_error(std::size_t j) const;
  lie::Transform<double> behind_error(std::size_t j) const;
  /// @}
};

/// Two limbs whose platform poses are compared by the residual log(g_k g_i^-1) (Du et al. 2022, Eq. 30). Indices
/// count from 0.
struct LimbPair {
  std::size_t k;  ///< limb with pose g_k
  std::size_t i;  ///< limb with pose g_i
};

/// The pairs of limbs that are compared: for two limbs (2,1), for three limbs the published cycle (2,1), (3,2), (1,3).
/// For more limbs it is every pair, so that the order of the limbs does not matter.
std::vector<LimbPair> pairs_of(std::size_t limbs);

/// Limbs that carry one platform, and the pairs in which their platform poses are compared.
struct ParallelChain {
  std::vector<Limb> limbs;      ///< limbs; lists of all joints or of all frames go limb by limb, in this order
  std::vector<LimbPair> pairs;  ///< pairs of limbs; lists of residuals go pair by pair, in this order
  /// The number of idle freedoms: motions of passive joints that do not move the platform, such as the spin of a leg
  /// between two spherical joints.
  std::size_t idle = 0;
  /// True if perfect limbs have a mismatch because the numbers of their file are rounded; see models/chain/nominal.h.
  bool rounded = false;

  /// The numbers of joints, passive joints and fixed frames of all limbs together.
  /// @{
  std::size_t joints() const;
  std::size_t passive_joints() const;
  std::size_t frames() const;
  /// @}
  /// The index of the limb's first frame among the frames of all limbs.
  std::size_t first_frame(std::size_t limb) const;
  /// The length of the longest limb (m), summed over its fixed frames.
  double reach() const;
};

/// The error of one fixed frame, [omega; v] with angular errors omega (rad) and linear errors v (m) (Du et al. 2022,
/// Eqs. 24-25).
template <class T>
using FrameError = lie::Screw<T>;

/// A component of a fixed frame's error.
struct FrameEntry {
  std::size_t frame;      ///< index among all frames, limb by limb
  std::size_t component;  ///< index in [omega; v], 0 to 5

  /// Returns true if both name the same component of the same frame.
  bool operator==(const FrameEntry&) const = default;
};

/// The motion Delta g of a frame's error (Du et al. 2022, Eq. 26): rotation exp(omega) and translation v. Delta g is
/// not the exponential of a screw.
template <class T>
lie::Transform<T> error_transform(const FrameError<T>& error) {
  const lie::Vector3<T> omega = error.template head<3>();
  return {lie::exp(omega), error.template tail<3>()};
}

/// Fixed frame j of the limb with its error, g_ij^ge of Du et al. 2022, Eqs. 27-28. The error multiplies the frame from
/// the left; in the last frame, its inverse multiplies the frame from the right. Limb::errors_at_joints changes this
/// for angular errors of the first and the last frame: the error then is between translation and rotation of the frame,
/// at the joint. An error without an angle gives the same frame, to the last bit, whether errors_at_joints is set or
/// not.
template <class T>
lie::Transform<T> frame_with_error(const Limb& limb, std::size_t j, const FrameError<T>& error) {
  const auto cast = [](const lie::Transform<double>& g) {
    return lie::Transform<T>{g.R.template cast<T>(), g.p.template cast<T>()};
  };
  const bool is_last = j + 1 == limb.frames();
  const lie::Transform<T> delta = error_transform(error);
  const bool turns = !(error.template head<3>().array() == T(0)).all();
  if (limb.errors_at_joints && turns && (j == 0 || is_last)) {
    return cast(limb.before_error(j)) * (is_last ? delta.inverse() : delta) * cast(limb.behind_error(j));
  }
  const lie::Transform<T> home = cast(limb.home[j]);
  return is_last ? home * delta.inverse() : delta * home;
}

/// Multiplies g by exp(zeta q) for a joint about or along z with displacement q (rad, m; Eq. 14). This changes two
/// columns of g.R, or g.p.
template <class T>
void move_joint(const Joint& joint, T displacement, lie::Transform<T>& g) {
  using std::cos;
  using std::sin;
  if (joint.advance != 0.0) g.p += T(joint.advance) * displacement * g.R.col(2);
  if (joint.type == JointType::prismatic) {
    g.p += displacement * g.R.col(2);
    return;
  }
  const T c = cos(displacement);
  const T s = sin(displacement);
  const lie::Vector3<T> x = g.R.col(0);
  g.R.col(0) = c * x + s * g.R.col(1);
  g.R.col(1) = c * g.R.col(1) - s * x;
}

/// The screw [omega; v] of a joint in the base frame, Ad(g) zeta (Du et al. 2022, Eqs. 35-39). It is a column of the
/// spatial Jacobian. g: base_T_joint.
template <class T>
lie::Screw<T> spatial_column(const Joint& joint, const lie::Transform<T>& g) {
  const lie::Vector3<T> axis = g.R.col(2);
  lie::Screw<T> column;
  if (joint.type == JointType::prismatic) {
    column << lie::Vector3<T>::Zero(), axis;
  } else {
    column << axis, g.p.cross(axis) + T(joint.advance) * axis;
  }
  return column;
}

/// The pose base_T_platform of the limb (Du et al. 2022, Eq. 28). frames: the limb's fixed frames, with or without
/// errors. displacements: those of the limb's joints (rad, m). on_passive(k, column) receives the spatial Jacobian
/// column of the limb's k-th passive joint.
template <class T, class OnPassive>
lie::Transform<T> forward_kinematics(const Limb& limb, std::span<const lie::Transform<T>> frames,
                                     std::span<const T> displacements, OnPassive&& on_passive) {
  lie::Transform<T> g = frames[0];
  std::size_t passive = 0;
  for (std::size_t j = 0; j < limb.joints.size(); ++j) {
    const Joint& joint = limb.joints[j];
    if (!joint.actuated) on_passive(passive++, spatial_column(joint, g));
    move_joint(joint, displacements[j], g);
    g = g * frames[j + 1];
  }
  return g;
}

}  // namespace poesy::chain
