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
  JointType type;        ///< how it moves
  bool actuated;         ///< else passive: it gives way to errors
  double advance = 0.0;  ///< of a revolute joint: m per rad along its axis; not zero in a helical joint
  bool fixed = false;    ///< actuated, but by no drive: a frame between parts that do not move against each other
  /// Of an actuated joint: those of one number, in any limbs, have one drive, which moves all by the same displacement;
  /// 0: a drive of its own.
  std::size_t drive = 0;
};

/// A serial limb in local product-of-exponentials form (Du et al. 2022, Eq. 13): n joints between n + 1 fixed
/// frames. home[0] is the first joint's frame seen from the base, home[n] the platform seen from the last joint's
/// frame, home[j] the frame of joint j + 1 seen from the frame of joint j, all at zero displacement.
struct Limb {
  std::vector<Joint> joints;                 ///< [n], base to platform
  std::vector<lie::Transform<double>> home;  ///< [n + 1]
  /// Where an angle of the first and of the last frame's error turns: about the first and the last joint's point, or,
  /// as published, about the origins of base and platform. The axes are the base's and the platform's in any case.
  bool errors_at_joints = false;

  /// N + 1.
  std::size_t frames() const { return home.size(); }
  /// Those that are not actuated.
  std::size_t passive_joints() const;
  /// Fixed frame j as before * Delta g * behind, or before * Delta g^-1 * behind for the last one: what is before the
  /// error, and what is behind.
  /// @{
  lie::Transform<double> before_error(std::size_t j) const;
  lie::Transform<double> behind_error(std::size_t j) const;
  /// @}
};

/// Two limbs whose platform poses are compared: residual log(g_k g_i^-1) (Eq. 30). Positions count from 0.
struct LimbPair {
  std::size_t k;  ///< the limb that is compared, g_k
  std::size_t i;  ///< the limb it is compared with, g_i
};

/// Which limbs are compared: those in turn, (2,1), (3,2), (1,3), of two or three limbs, as published; every two of
/// more, so that the order of the limbs does not matter.
std::vector<LimbPair> pairs_of(std::size_t limbs);

/// Limbs that hold one platform, and the pairs in which their poses are compared.
struct ParallelChain {
  std::vector<Limb> limbs;      ///< in the order in which displacements stand
  std::vector<LimbPair> pairs;  ///< in the order in which residuals stand
  /// Freedoms of passive joints that move no platform, as the spin of a leg between two spherical joints.
  std::size_t idle = 0;
  /// Whether errors move the platform and deform nothing: as many passive joints, but for idle freedoms, as the limbs
  /// have ways to disagree.
  bool meets = false;
  /// Whether perfect limbs keep a mismatch, because their numbers are rounded; see nominal.h.
  bool rounded = false;

  /// Of all limbs together.
  /// @{
  std::size_t joints() const;
  std::size_t passive_joints() const;
  std::size_t frames() const;
  /// @}
  /// Where the limb's frames begin among those of all limbs.
  std::size_t first_frame(std::size_t limb) const;
  /// The longest a limb is, in m, summed over its fixed frames.
  double reach() const;
};

/// Error of one fixed frame: [omega; v] with omega the angular and v the linear errors (Eqs. 24-25).
template <class T>
using FrameError = lie::Screw<T>;

/// An entry of a fixed frame's error.
struct FrameEntry {
  std::size_t frame;      ///< among all frames, limb by limb
  std::size_t component;  ///< of [omega; v]

  /// Whether they are the same entry.
  bool operator==(const FrameEntry&) const = default;
};

/// Delta g of Eq. 26: rotation exp(omega) and translation v as they stand, which is not the exponential of a screw.
template <class T>
lie::Transform<T> error_transform(const FrameError<T>& error) {
  const lie::Vector3<T> omega = error.template head<3>();
  return {lie::exp(omega), error.template tail<3>()};
}

/// Fixed frame j of the limb with its error, g_ij^ge of Eqs. 27-28: the error multiplies from the left, but for the
/// last frame, where its inverse multiplies from the right; with errors_at_joints between the translation to the first
/// joint and the rest, and between the rotation of the last frame and the rest. Where it stands is all one for an error
/// without an angle, which then has the same bits.
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

/// g * exp(zeta q) for a joint about or along z (Eq. 14): touches two columns of R, or p.
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

/// The joint's screw in the base frame when g is its own frame: Ad(g) zeta (Eqs. 35-39), a column of the spatial
/// Jacobian.
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

/// Platform pose by the limb (Eq. 28). frames: [n + 1], with or without errors; displacements: [n] (rad, m).
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
