#pragma once

#include "models/lie/so3.h"

namespace poesy::lie {

/// A screw [omega; v], angular part first (Du et al. 2022, Eq. A1).
template <class T>
using Screw = Eigen::Matrix<T, 6, 1>;
template <class T>
using Matrix6 = Eigen::Matrix<T, 6, 6>;

/// A rigid motion x -> R x + p. A transform with a name such as base_T_platform maps platform coordinates to base
/// coordinates.
template <class T>
struct Transform {
  /// The rotation matrix.
  Matrix3<T> R = Matrix3<T>::Identity();
  /// The translation vector.
  Vector3<T> p = Vector3<T>::Zero();

  /// The inverse motion x -> R^T (x - p).
  Transform inverse() const { return {R.transpose(), -(R.transpose() * p)}; }
  /// The product a b: first the motion b, then a.
  friend Transform operator*(const Transform& a, const Transform& b) { return {a.R * b.R, a.R * b.p + a.p}; }
};

/// The motion exp(screw) (Du et al. 2022, Eqs. A2, A4), accurate at every angle.
template <class T>
Transform<T> exp(const Screw<T>& screw) {
  const Vector3<T> w = screw.template head<3>();
  const Vector3<T> v = screw.template tail<3>();
  return {exp(w), left_jacobian(w) * v};
}

/// The screw of a motion g, with a rotation angle of at most pi: exp(log(g)) = g. The function equals Eq. A6 of Du et
/// al. 2022, except at small angles, where the printed equation is 0/0.
template <class T>
Screw<T> log(const Transform<T>& g) {
  const Vector3<T> w = log(g.R);
  Screw<T> screw;
  screw.template head<3>() = w;
  screw.template tail<3>() = left_jacobian_inverse(w) * g.p;
  return screw;
}

/// The adjoint Ad(g), which transforms a screw from the frame of g to the frame in which g is expressed (Du et al.
/// 2022, Eq. A8).
template <class T>
Matrix6<T> adjoint(const Transform<T>& g) {
  Matrix6<T> ad = Matrix6<T>::Zero();
  ad.template topLeftCorner<3, 3>() = g.R;
  ad.template bottomRightCorner<3, 3>() = g.R;
  ad.template bottomLeftCorner<3, 3>() = hat(g.p) * g.R;
  return ad;
}

/// The Lie bracket [a, b]: the derivative of Ad(exp(t a)) b at t = 0.
template <class T>
Screw<T> bracket(const Screw<T>& a, const Screw<T>& b) {
  const Vector3<T> wa = a.template head<3>(), va = a.template tail<3>();
  const Vector3<T> wb = b.template head<3>(), vb = b.template tail<3>();
  Screw<T> c;
  c.template head<3>() = wa.cross(wb);
  c.template tail<3>() = wa.cross(vb) + va.cross(wb);
  return c;
}

/// The wrench [moment; force] whose product with every twist a equals the product of `wrench` with the bracket [a, b].
template <class T>
Screw<T> wrench_of_bracket(const Screw<T>& wrench, const Screw<T>& b) {
  const Vector3<T> moment = wrench.template head<3>(), force = wrench.template tail<3>();
  const Vector3<T> wb = b.template head<3>(), vb = b.template tail<3>();
  Screw<T> c;
  c.template head<3>() = wb.cross(moment) + vb.cross(force);
  c.template tail<3>() = wb.cross(force);
  return c;
}

enum class Axis { x, y, z };

/// Rotation by an angle (rad) about a coordinate axis.
template <class T>
Transform<T> rotation(Axis axis, T angle) {
  Vector3<T> w = Vector3<T>::Zero();
  w[static_cast<int>(axis)] = angle;
  return {exp(w), Vector3<T>::Zero()};
}

/// Translation by a distance (m) along a coordinate axis.
template <class T>
Transform<T> translation(Axis axis, T distance) {
  Transform<T> g;
  g.p[static_cast<int>(axis)] = distance;
  return g;
}

}  // namespace poesy::lie
