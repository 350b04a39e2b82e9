#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "engine/base/array.h"
#include "engine/base/nan.h"
#include "engine/base/units.h"
#include "engine/result/result_file.h"

namespace poesy::axis {

using Fitted = Axis<"fitted">;            ///< Fitted errors.
using OtherFitted = Axis<"with_fitted">;  ///< Fitted errors as the second axis of a matrix.
using Direction = Axis<"direction">;      ///< Directions of fitted errors, ordered by their singular values.
using Value = Axis<"value">;              ///< Measured values.
using Measurement = Axis<"measurement">;  ///< Rows of the table of measurements.
using FramePart = Axis<"frame_part">;     ///< Numbers that place the measuring frame and the target.
using Moved = Axis<"moved">;              ///< Components of the platform's displacement.
using Drive = Axis<"drive">;              ///< Drives.
using Next = Axis<"next">;                ///< Poses recommended for the next measurement.
using Coordinate = Axis<"coordinate">;    ///< Coordinates of a pose.
using Typed = Axis<"typed">;              ///< Parameters for the controller.

}  // namespace poesy::axis

namespace poesy::calibration {

/// The calibration of one machine. Numbers are SI, and NaN if not determined or not known. "In scaled numbers" means
/// that each fitted error is divided by its scale.
struct Result {
  std::vector<NamedUnit> fitted;         ///< names and units of the fitted errors
  Array<double, axis::Fitted> estimate;  ///< estimated values of the fitted errors
  Array<double, axis::Fitted> sd;        ///< standard deviations of the estimates
  Array<double, axis::Fitted> low;       ///< lower ends of the confidence intervals of the estimates
  Array<double, axis::Fitted> high;      ///< upper ends of the confidence intervals of the estimates
  /// Scale of each fitted error: the standard deviation that follows from the tolerances; without tolerances, the
  /// default that FittedColumns states.
  Array<double, axis::Fitted> scale;
  std::uint64_t has_tolerances = 0;                            ///< 1 if all scales follow from tolerances, otherwise 0
  Array<double, axis::Fitted, axis::OtherFitted> covariance;   ///< covariance of the estimates
  Array<double, axis::Fitted, axis::OtherFitted> correlation;  ///< correlation of the estimates
  /// Projector on the combinations of fitted errors that the measurement cannot determine, in scaled numbers.
  Array<double, axis::Fitted, axis::OtherFitted> null_projector;
  Array<double, axis::Direction> singular_values;  ///< singular values of the derivatives of the measured values,
                                                   ///< divided by the noise, in scaled numbers; largest first
  double conf_level = 0.95;                        ///< confidence level of the intervals
  std::uint64_t has_prior = 0;                     ///< 1 if tolerances are used as prior knowledge, otherwise 0
  std::uint64_t noise_is_known = 1;                ///< 1 if the values have standard deviations, 0 if all noise is 0
  /// 1 if only the ratios of the noise are known and its level was estimated from the residuals, otherwise 0.
  std::uint64_t sd_is_estimated = 0;

  std::vector<std::string> values;       ///< names of the measured values
  std::vector<std::string> value_units;  ///< SI units of the measured values
  /// Index of the row of each value in the table of measurements.
  Array<std::uint64_t, axis::Value> value_row;
  /// For a distance: index of the row of the other pose. For any other value: equal to value_row.
  Array<std::uint64_t, axis::Value> value_to;
  std::vector<std::string> rows;  ///< names of the rows of the table of measurements
  /// The pose of each row, in the pose coordinates of the model, SI.
  Array<double, axis::Measurement, axis::Coordinate> measured_at;
  Array<double, axis::Value> measured;  ///< measured values
  Array<double, axis::Value> value_sd;  ///< standard deviations of the measured values
  Array<double, axis::Value> residual;  ///< measured minus fitted values
  /// Leverage of each value (diagonal of the projector on the fitted values), from 0 to 1.
  Array<double, axis::Value> leverage;
  /// Each residual divided by its own standard deviation; NaN if no other value checks the value.
  Array<double, axis::Value> standardised;
  Array<std::uint8_t, axis::Value> outlier;  ///< 1 for outliers, otherwise 0
  std::uint64_t measured_poses = 0;          ///< number of rows of the table of measurements
  std::uint64_t distances = 0;               ///< number of distances among the values

  double rms = kNaN;         ///< root mean square of the residuals, each divided by its noise
  double chi_square = kNaN;  ///< weighted sum of squared residuals, including the prior
  std::uint64_t dof = 0;     ///< degrees of freedom of chi_square
  double p = kNaN;           ///< p-value: probability of a larger chi_square if the residuals are only noise
  /// A value is an outlier if the magnitude of its Inference::outlier_score is above this.
  double outlier_limit = kNaN;
  std::uint64_t rank = 0;  ///< number of independent combinations of fitted errors that the measurement determines
  /// Number of independent combinations of the numbers in `frame` that the measurement determines.
  std::uint64_t frame_rank = 0;
  /// Number of combinations of fitted errors whose effect on the measured values is below the noise.
  std::uint64_t below_noise = 0;
  std::uint64_t steps = 0;  ///< number of steps of the fit
  /// 1 if the fit converged. 0: no number of the result may be used. Files of version 0.2 do not have this member.
  std::uint64_t converged = 1;
  double O1 = kNaN;         ///< observability index of Borm and Menq (calibration/inference.h)
  double O2 = kNaN;         ///< observability index of Driels and Pathre
  double O3 = kNaN;         ///< observability index of Nahvi, Hollerbach and Hayward
  double O4 = kNaN;         ///< observability index of Nahvi and Hollerbach
  double O5 = kNaN;         ///< observability index of Sun and Hollerbach
  double condition = kNaN;  ///< ratio of the largest singular value to the smallest one above rounding

  /// Names of the numbers that place the measuring frame and the target, such as "height". The numbers are in m or rad;
  /// slopes have no unit.
  std::vector<std::string> frame_parts;
  Array<double, axis::FramePart> frame;  ///< estimates of the numbers in `frame_parts`

  /// Expected displacement of the platform that remains with the calibrated controller, rad or m.
  Array<double, axis::Pose, axis::Moved> left_mean;
  Array<double, axis::Pose, axis::Moved> left_sd;  ///< standard deviation of the remaining displacement
  std::vector<NamedUnit> drives;                   ///< names and units of the drives
  /// Change of each drive's position by the calibrated controller, rad or m.
  Array<double, axis::Pose, axis::Drive> drive_shift;
  std::uint64_t unfitted = 0;  ///< number of errors with a tolerance minus the number of fitted errors; 0 if negative
  double kept = kNaN;          ///< probability that the calibrated machine keeps all limits (KeptLimits)
  std::uint64_t left_in_device_frame = 0;  ///< 1 if the remaining displacement is in the frame of the measuring device,
                                           ///< 0 if in the base frame

  Array<double, axis::Next, axis::Coordinate> next_pose;  ///< poses recommended for the next measurement
  /// Information, in bits, that each recommended pose adds to the measurements and the recommended poses before it.
  Array<double, axis::Next> gain;
  Array<std::uint64_t, axis::Next> candidate;  ///< indices of the recommended poses among the candidates

  std::vector<NamedUnit> typed;              ///< parameters for the controller; `description` is the expression
  Array<double, axis::Typed> typed_nominal;  ///< values of the parameters if the machine had no errors
  /// Values of the parameters while the machine was measured, which follow from the errors that the controller already
  /// corrected.
  Array<double, axis::Typed> typed_present;
  Array<double, axis::Typed> typed_value;  ///< values of the parameters for the estimated errors
  Array<double, axis::Typed> typed_sd;     ///< standard deviations of typed_value

  std::string file;         ///< name of the table of measurements
  std::string file_text;    ///< content of the table of measurements
  std::string file_sha256;  ///< SHA-256 hash of file_text
};

/// True if a value is the distance between the places of the platform at two poses.
inline bool is_distance(const Result& found, std::size_t value) {
  return found.value_to(value) != found.value_row(value);
}

/// The names on the axis `moved`: components of a displacement (kComponents).
std::vector<std::string> moved_names();

/// The calibration in a result. Precondition: the result is of kind `calibration`.
inline const Result& calibration_of(const StoredResult& result) { return found_of<Result>(result); }

}  // namespace poesy::calibration
