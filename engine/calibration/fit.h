#pragma once

#include <functional>
#include <optional>

#include "engine/calibration/expansion.h"
#include "engine/calibration/measurement.h"

namespace poesy::calibration {

/// The directions of errors that are fitted. The fitted numbers theta are the coordinates of the errors along these
/// directions: the errors are F theta.
struct FittedDirections {
  Matrix F;      ///< [all errors x numbers] directions as columns, SI
  Vector scale;  ///< [numbers] tolerance of each number, SI; a scaled number is a number divided by its tolerance
  Vector step;   ///< [numbers] step of each number for finite differences, SI: see difference_steps()
};

/// Prior knowledge of the fitted numbers theta: the fit adds |root theta - centre|^2 to the sum of squares. Without
/// prior knowledge, both members are empty.
struct Prior {
  Matrix root = {};    ///< [rows x numbers] square root of the prior's information matrix
  Vector centre = {};  ///< [rows] root times the prior's mean
};

/// The steps of finite differences along the fitted directions, the columns of F. Each is the largest step that changes
/// no length error by more than 5e-4 of the machine's reach, and no angle error by more than 5e-4 rad.
Vector difference_steps(const ExactMachine& machine, const Matrix& F);

/// The derivatives of the measured values h(F theta, phi). theta are the fitted numbers, and F theta the errors of the
/// machine (FittedDirections). phi are the numbers of the measuring device's frame and of the target (Measurement).
struct Derivatives {
  Matrix errors;  ///< [values x numbers] derivatives with respect to theta
  Matrix places;  ///< [values x places] derivatives with respect to phi
};

/// The measured values as a function of theta, the fitted numbers of the errors, and phi, the numbers of the measuring
/// device's frame and of the target.
class FittedMeasurement {
 public:
  /// All arguments must outlive this object. directions.F has a row for each error.
  FittedMeasurement(const Measurement& measurement, const FittedDirections& directions)
      : measurement_(&measurement), directions_(&directions) {}

  /// [values] The values that a measurement gives at theta and phi, SI; none if a machine is not solved.
  std::optional<Vector> values(const Vector& theta, const Vector& phi) const;
  /// The derivatives at theta and phi, by central differences of fourth order (four exact solves for each fitted number
  /// at each pose). None if a machine is not solved.
  std::optional<Derivatives> derivatives(const Vector& theta, const Vector& phi) const;

 private:
  const Measurement* measurement_;
  const FittedDirections* directions_;
};

/// The matrices of a fit at one estimate. Rows are divided by the standard deviations of the values, columns are
/// multiplied by the scale of the numbers. theta and phi: see Derivatives.
struct ScaledFit {
  Matrix A;  ///< [values x numbers] scaled derivatives with respect to theta
  /// [values x frame_rank] Orthonormal basis of the column space of the derivatives with respect to phi.
  Matrix frame;
  Matrix reduced;          ///< [values x numbers] A minus its projection on `frame`
  Vector singular_values;  ///< [min(values, numbers)] singular values of `reduced`, largest first
  Matrix V;                ///< [numbers x numbers] right singular vectors of `reduced`
  std::size_t rank = 0;    ///< number of singular values above kUnseen times the largest

  /// The rank of the derivatives with respect to phi.
  std::size_t frame_rank() const { return static_cast<std::size_t>(frame.cols()); }
};

/// Directions of theta are not determined by the measurements if their singular value is below this share of the
/// largest.
inline constexpr double kUnseen = 1e-6;

/// The matrices of a fit for these derivatives. sd: [values] standard deviations, SI. scale: [numbers], SI.
ScaledFit scaled_fit(const Derivatives& derivatives, const Vector& sd, const Vector& scale);

/// A nonlinear least-squares problem.
struct FitProblem {
  const Measurement& measurement;      ///< measured values, poses and machine
  const FittedDirections& directions;  ///< directions of errors that are fitted
  Vector sd;                           ///< [values] standard deviations of the values, SI; all equal if unknown
  Prior prior = {};                    ///< prior knowledge of the fitted numbers
  /// Computes the derivatives without solves. Null: they are computed from solves at the estimate, and are exact up to
  /// rounding.
  const Expansion* expansion = nullptr;
};

/// The estimate and its diagnostics.
struct FitResult {
  bool converged = false;   ///< true if the iteration ended because a step was short enough
  bool solved = true;       ///< false if the start or the derivatives cannot be solved; then no other member is valid
  std::size_t steps = 0;    ///< number of steps of the iteration
  Vector theta;             ///< [numbers] fitted numbers of the errors, SI
  Vector phi;               ///< [places] fitted numbers of the frame and the target, SI
  Vector residual;          ///< [values] measured minus fitted values, SI
  Derivatives derivatives;  ///< derivatives at the estimate
  ScaledFit scaled;         ///< scaled matrices at the estimate
  double sum = 0.0;         ///< minimised sum of squares: noise_sum plus the term of the prior
  double noise_sum = 0.0;   ///< sum of (residual / sd)^2 over the measured values
};

/// Finds the minimum of the sum of squares by at most 30 Gauss-Newton steps. A step is halved until the sum does not
/// grow. Without a prior, theta does not move along directions that the measurements do not determine: each step is the
/// shortest one, measured in scaled numbers. Residuals that both theta and phi can explain are attributed to phi.
FitResult fit(const FitProblem& problem);

}  // namespace poesy::calibration
