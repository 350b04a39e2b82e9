#pragma once

#include <span>

#include "models/file/mechanism.h"
#include "models/file/physical.h"

namespace poesy::file {

/// Evaluates the expressions of a file for values of its geometry, in SI. All functions throw InputError with the place
/// in the file if an expression has no value or another dimension.
class Numbers {
 public:
  /// values: of file.geometry, SI. Both arguments must outlive the object.
  Numbers(const MechanismFile& file, std::span<const double> values) : file_(&file), values_(values) {}

  const MechanismFile& file() const { return *file_; }  ///< The file of the expressions.

  /// The mechanism's reach (m), the scale at which two points count as equal.
  /// @{
  void set_reach(double reach) { reach_ = reach; }
  double reach() const { return reach_; }
  /// @}

  double quantity(const Expression& expression, const Physical& wanted) const;  ///< SI value of this quantity.
  double positive(const Expression& expression, const Physical& wanted) const;  ///< The same, checked to be positive.
  double length(const Expression& expression) const;                            ///< SI value of a length (m).
  Value value(const Expression& expression) const;                              ///< A value of any dimension.
  Vector3 point(const Triple& triple) const;                                    ///< A point (m).
  Vector3 vector(const Triple& triple, const Physical& wanted) const;  ///< A vector with entries of this quantity.
  /// A direction as a unit vector. Throws if its entries have different dimensions or are all zero.
  Vector3 direction(const Triple& triple) const;
  /// The rotation of a frame with this z axis; x is made perpendicular to z.
  lie::Matrix3<double> axes(const Triple& x, const Triple& z) const;

  bool same(const Vector3& a, const Vector3& b) const;  ///< Whether two points are the same.

 private:
  const MechanismFile* file_;
  std::span<const double> values_;
  double reach_ = 1.0;
};

/// Directions count as parallel below this angle (rad).
inline constexpr double kParallel = 1e-6;

bool parallel(const Vector3& a, const Vector3& b);  ///< Whether two unit vectors are parallel.

/// The rotation of a frame with these axes, which are perpendicular unit vectors.
lie::Matrix3<double> frame_of(const Vector3& x, const Vector3& z);

/// The part of a direction perpendicular to z, as a unit vector.
Vector3 perpendicular(const Vector3& direction, const Vector3& z);

/// The motion from the first copy to copy k, in the base frame.
Transform turned(const Copies& copies, std::size_t k);

}  // namespace poesy::file
