#pragma once

#include <functional>
#include <optional>

#include "engine/calibration/measurement.h"

namespace poesy::calibration {

/// The errors that are fitted: k numbers theta with the errors e = F theta.
struct FittedDirections {
  Matrix F;      ///< [all errors x k], SI
  Vector scale;  ///< [k] d: what counts as one of each number, its tolerance, SI
  Vector step;   ///< [k] step of differences, SI: see difference_steps()
};

/// What is known of the fitted numbers: |root theta - centre|^2 is added to the sum of squares. Empty: nothing.
struct Prior {
  Matrix root = {};    ///< [p x k]
  Vector centre = {};  ///< [p]
};

/// The steps of differences for columns F: the largest with which no error moves by more than kStep of the machine's
/// reach, or by kStep rad.
Vector difference_steps(const ExactMachine& machine, const Matrix& F);

/// The derivatives of h, by central differences of exact solves with four points.
struct Derivatives {
  Matrix errors;  ///< [m x k] by theta
  Matrix places;  ///< [m x places] by phi
};

/// A measurement as a function of what is fitted.
class FittedMeasurement {
 public:
  /// All arguments must outlive it. directions.F has a row for each error.
  FittedMeasurement(const Measurement& measurement, const FittedDirections& directions)
      : measurement_(&measurement), directions_(&directions) {}

  /// h(F theta, phi), [m]; none if a machine is not solved.
  std::optional<Vector> values(const Vector& theta, const Vector& phi) const;
  /// The derivatives there; none if a machine is not solved.
  std::optional<Derivatives> derivatives(const Vector& theta, const Vector& phi) const;

 private:
  const Measurement* measurement_;
  const FittedDirections* directions_;
};

/// Matrices of a fit in units of the noise and of the scale, at one estimate.
struct ScaledFit {
  Matrix A;                ///< [m x k] derivatives times scale over standard deviations
  Matrix frame;            ///< [m x frame_rank] orthonormal basis of the columns of phi over standard deviations
  Matrix reduced;          ///< [m x k] A less its part in `frame`
  Vector singular_values;  ///< [min(m, k)] of `reduced`, the largest first
  Matrix V;                ///< [k x k] right singular vectors of `reduced`
  std::size_t rank = 0;    ///< singular values above kUnseen times the largest

  std::size_t frame_rank() const {
    return static_cast<std::size_t>(frame.cols());
  }  ///< The rank of the columns of phi.
};

/// Singular values below this share of the largest belong to what the measurements do not see.
inline constexpr double kUnseen = 1e-6;

/// The matrices for these derivatives. sd: [m] standard deviations.
ScaledFit scaled_fit(const Derivatives& derivatives, const Vector& sd, const Vector& scale);

/// A least-squares problem.
struct FitProblem {
  const Measurement& measurement;      ///< what was measured
  const FittedDirections& directions;  ///< what is fitted
  Vector sd;                           ///< [m] standard deviations, or equal weights
  Prior prior = {};                    ///< what is known before
};

/// The estimate.
struct FitResult {
  bool converged = false;   ///< whether a step was below 1e-9 of the scale, or 1e-8 of the noise
  bool solved = true;       ///< whether all machines on the way were solved; otherwise nothing else is valid
  std::size_t steps = 0;    ///< number of steps
  Vector theta;             ///< [k] fitted numbers, SI
  Vector phi;               ///< [places] numbers of the frame and the target
  Vector residual;          ///< [m] measured less fitted, SI
  Derivatives derivatives;  ///< at the estimate
  ScaledFit scaled;         ///< at the estimate
  double sum = 0.0;         ///< S, with the prior's part
  double noise_sum = 0.0;   ///< sum of (residual / sd)^2
};

/// The minimum of the sum of squares by Gauss-Newton steps with the derivatives at the estimate, halved where the sum
/// would grow, at most 30. A step has no part in what is unseen without a prior: it has the least norm of the scaled
/// numbers, and what looks like a frame is left to the frame.
FitResult fit(const FitProblem& problem);

}  // namespace poesy::calibration
