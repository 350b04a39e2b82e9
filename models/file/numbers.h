#pragma once

#include <span>

#include "models/file/mechanism.h"
#include "models/file/physical.h"

namespace poesy::file {

/// The numbers that expressions of a file have for these values of its geometry, SI. All throw InputError with the
/// place where an expression has none, or one of another dimension.
class Numbers {
 public:
  /// Both must outlive it.
  Numbers(const MechanismFile& file, std::span<const double> values) : file_(&file), values_(values) {}

  const MechanismFile& file() const { return *file_; }  ///< That has the expressions.

  /// The mechanism's reach (m), by which points are told apart.
  /// @{
  void set_reach(double reach) { reach_ = reach; }
  double reach() const { return reach_; }
  /// @}

  double quantity(const Expression& expression, const Physical& wanted) const;  ///< Of this kind.
  double positive(const Expression& expression, const Physical& wanted) const;  ///< Greater than 0.
  double length(const Expression& expression) const;                            ///< m
  Vector3 point(const Triple& triple) const;                                    ///< m
  Vector3 vector(const Triple& triple, const Physical& wanted) const;           ///< Each entry of this kind.
  /// Of unit length. Throws where the entries have several dimensions or are all zero.
  Vector3 direction(const Triple& triple) const;
  /// Axes of a frame with this z, and x made perpendicular to it.
  lie::Matrix3<double> axes(const Triple& x, const Triple& z) const;

  bool same(const Vector3& a, const Vector3& b) const;  ///< Whether they are one point.

 private:
  const MechanismFile* file_;
  std::span<const double> values_;
  double reach_ = 1.0;
};

/// Up to which angle directions count as parallel, rad.
inline constexpr double kParallel = 1e-6;

bool parallel(const Vector3& a, const Vector3& b);  ///< Of unit length.

/// The rotation of a frame with these axes, perpendicular unit vectors.
lie::Matrix3<double> frame_of(const Vector3& x, const Vector3& z);

/// What of a direction is perpendicular to z, of unit length.
Vector3 perpendicular(const Vector3& direction, const Vector3& z);

/// Where the k-th of things alike is, seen from the first.
Transform turned(const Copies& copies, std::size_t k);

}  // namespace poesy::file
