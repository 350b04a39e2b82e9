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
  JointType type;        ///< revolute or prismatic
  bool actuated;         ///< false: passive, reacts to errors
  double advance = 0.0;  ///< pitch of a revolute joint, m per rad along its axis; nonzero in a helical joint
  bool fixed = false;    ///< actuated without a drive: a frame between parts that do not move relative to each other
  /// Number of the drive of an actuated joint. Joints with the same number, in any limbs, share one drive, which moves
  /// all of them by the same displacement; 0: the joint has its own drive.
  std::size_t drive = 0;
};

/// A serial limb in local product-of-exponentials form (Du et al. 2022, Eq. 13): n joints between n + 1 fixed
/// frames. home[0] is the first joint's frame seen from the base, home[n] the platform seen from the last joint's
/// frame, home[j] the frame of joint j + 1 seen from the frame of joint j, all at zero displacement.
struct Limb {
  std::vector<Joint> joints;                 ///< [n], base to platform
  std::vector<lie::Transform<double>> home;  ///< [n + 1]
  /// The point about which an angular error of the first and of the last frame turns: true: the point of the first and
  /// of the last joint; false, as published: the origins of base and platform. The axes are always those of base and
  /// platform.
  bool errors_at_joints = false;

  /// Number of fixed frames, n + 1.
  std::size_t frames() const { return home.size(); }
  /// Number of joints that are not actuated.
  std::size_t passive_joints() const;
  /// Factors of fixed frame j, before and behind its error: the frame is before * Delta g * behind, or before * Delta
  /// g^-1 * behind if it is the last one.
  /// @{
  lie::Transform<double> before_error(std::size_t j) const;
  lie::Transform<double> behind_error(std::size_t j) const;
  /// @}
};

/// Two limbs whose platform poses are compared by the residual log(g_k g_i^-1) (Eq. 30). Positions count from 0.
struct LimbPair {
  std::size_t k;  ///< limb with pose g_k
  std::size_t i;  ///< limb with pose g_i
};

/// The pairs of limbs that are compared. For two or three limbs the published cycle (2,1), (3,2), (1,3); for more limbs
/// every pair, so that the order of the limbs does not matter.
std::vector<LimbPair> pairs_of(std::size_t limbs);

/// Limbs that hold one platform, and the pairs in which their poses are compared.
struct ParallelChain {
  std::vector<Limb> limbs;      ///< in the order of displacements
  std::vector<LimbPair> pairs;  ///< in the order of residuals
  /// Number of freedoms of passive joints that do not move the platform, such as the spin of a leg between two
  /// spherical joints.
  std::size_t idle = 0;
  /// Whether errors move the platform and deform nothing. True if the passive joints, without idle freedoms, are as
  /// many as the equations 6 (limbs - 1) of the loops.
  bool meets = false;
  /// Whether perfect limbs have a mismatch because their numbers are rounded; see nominal.h.
  bool rounded = false;

  /// Sums over all limbs.
  /// @{
  std::size_t joints() const;
  std::size_t passive_joints() const;
  std::size_t frames() const;
  /// @}
  /// Position of the limb's first frame among the frames of all limbs.
  std::size_t first_frame(std::size_t limb) const;
  /// Length of the longest limb (m), summed over its fixed frames.
  double reach() const;
};

/// Error of one fixed frame, [omega; v] with angular errors omega (rad) and linear errors v (m) (Eqs. 24-25).
template <class T>
using FrameError = lie::Screw<T>;

/// An entry of a fixed frame's error.
struct FrameEntry {
  std::size_t frame;      ///< position among all frames, limb by limb
  std::size_t component;  ///< position in [omega; v]

  /// Whether they are the same entry.
  bool operator==(const FrameEntry&) const = default;
};

/// Delta g of Eq. 26: rotation exp(omega) and translation v, which is not the exponential of a screw.
template <class T>
lie::Transform<T> error_transform(const FrameError<T>& error) {
  const lie::Vector3<T> omega = error.template head<3>();
  return {lie::exp(omega), error.template tail<3>()};
}

/// Fixed frame j of the limb with its error, g_ij^ge of Eqs. 27-28. The error multiplies from the left; in the last
/// frame its inverse multiplies from the right. With errors_at_joints the error of the first frame is between the
/// translation to the first joint and the rest, and that of the last frame between its rotation and the rest. An error
/// without an angle gives the same bits with either rule.
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

/// Multiplies g by exp(zeta q) of a joint about or along z (Eq. 14). Changes two columns of R, or p.
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

/// The joint's screw [omega; v] in the base frame, Ad(g) zeta (Eqs. 35-39): a column of the spatial Jacobian. g:
/// base_T_joint.
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

/// Pose base_T_platform of the limb (Eq. 28). frames: [n + 1], with or without errors; displacements: [n] (rad, m).
/// on_passive(k, column) receives the spatial Jacobian column of the limb's k-th passive joint.
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
