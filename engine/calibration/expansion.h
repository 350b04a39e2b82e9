#pragma once

#include <array>
#include <vector>

#include "engine/calibration/measurement.h"

namespace poesy::calibration {

struct FittedDirections;
struct Derivatives;

/// The displacements at the poses of a measurement as polynomials of second degree in theta, the fitted numbers of the
/// errors (FittedDirections). The coefficients are differences of exact solves around zero errors. They are computed
/// once, and then give derivatives at any estimate of any machine without a further solve. The relative error of such a
/// derivative is about the square of the ratio of the errors to the lengths of the mechanism.
class Expansion {
 public:
  /// Solves k^2 + k + 1 machines at each pose, for k fitted numbers. Throws std::invalid_argument if a machine is not
  /// solved; what() is a clause about the mechanism.
  Expansion(const Measurement& measurement, const FittedDirections& directions);

  /// [poses] The displacements at zero errors.
  const std::vector<Displacement>& without_errors() const { return without_errors_; }

  /// The derivatives of the measured values at the estimates theta of the errors and phi of the places (Derivatives).
  /// displacements: [poses] exact displacements of the machine at theta.
  Derivatives derivatives(const Measurement& measurement, const Vector& theta,
                          const std::vector<Displacement>& displacements, const Vector& phi) const;

 private:
  /// The polynomials at one pose: rotation vector (rad) and displacement of P (m) as functions of theta.
  struct AtPose {
    Matrix slope;                     ///< [6 x numbers] first derivatives at theta = 0
    std::array<Matrix, 6> curvature;  ///< [numbers x numbers] second derivatives of each function at theta = 0
  };

  std::vector<Displacement> without_errors_;
  std::vector<AtPose> poses_;
};

}  // namespace poesy::calibration
