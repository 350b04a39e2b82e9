#pragma once

#include <span>

#include "models/file/mechanism.h"
#include "models/file/physical.h"

namespace poesy::file {

/// Evaluates the expressions of a file for values of its geometry, in SI. All functions throw InputError with the place
/// in the file if an expression has no value, or a dimension that is not the wanted one.
class Numbers {
 public:
  /// values: those of file.geometry, SI. Both arguments must outlive this object.
  Numbers(const MechanismFile& file, std::span<const double> values) : file_(&file), values_(values) {}

  const MechanismFile& file() const { return *file_; }  ///< The file of the expressions.

  /// The reach of the mechanism (m). Two points count as equal if their distance is a very small share of it.
  /// @{
  void set_reach(double reach) { reach_ = reach; }
  double reach() const { return reach_; }
  /// @}

  /// The SI value of an expression for this quantity.
  double quantity(const Expression& expression, const Physical& wanted) const;
  /// The SI value for this quantity; throws unless it is positive.
  double positive(const Expression& expression, const Physical& wanted) const;
  double length(const Expression& expression) const;  ///< The SI value of a length (m).
  /// The value of an expression of any dimension.
  Value value(const Expression& expression) const;
  Vector3 point(const Triple& triple) const;                           ///< A point (m).
  Vector3 vector(const Triple& triple, const Physical& wanted) const;  ///< A vector with entries of this quantity.
  /// A direction as a unit vector. Throws if its entries have different dimensions or are all zero.
  Vector3 direction(const Triple& triple) const;
  /// The rotation matrix of a frame with this axis z. Its axis x is the given direction x, made perpendicular to z.
  lie::Matrix3<double> axes(const Triple& x, const Triple& z) const;

  bool same(const Vector3& a, const Vector3& b) const;  ///< Returns true if two points are equal up to rounding.

 private:
  const MechanismFile* file_;
  std::span<const double> values_;
  double reach_ = 1.0;
};

/// Two lines count as parallel if the angle between them is at most this (rad).
inline constexpr double kParallel = 1e-6;

bool parallel(const Vector3& a, const Vector3& b);  ///< Returns true if two unit vectors are parallel or opposite.

/// The rotation matrix of a frame whose axes x and z are these perpendicular unit vectors.
lie::Matrix3<double> frame_of(const Vector3& x, const Vector3& z);

/// The part of a direction that is perpendicular to z, scaled to unit length.
Vector3 perpendicular(const Vector3& direction, const Vector3& z);

/// The rigid motion from the first copy (k = 0) to copy k, in the base frame.
Transform turned(const Copies& copies, std::size_t k);

}  // namespace poesy::file
