#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "engine/base/array.h"
#include "engine/base/nan.h"
#include "engine/base/units.h"
#include "engine/result/result_file.h"

namespace poesy {

namespace axis {
using Fitted = Axis<"fitted">;            ///< Fitted errors.
using OtherFitted = Axis<"with_fitted">;  ///< The same for the columns of a matrix.
using Direction = Axis<"direction">;      ///< Directions of fitted errors, by their singular values.
using Value = Axis<"value">;              ///< Measured values.
using FramePart = Axis<"frame_part">;     ///< Numbers of the frame and the target.
using Moved = Axis<"moved">;              ///< Components of the platform's displacement.
using Drive = Axis<"drive">;              ///< Drives.
using Next = Axis<"next">;                ///< Poses to measure next.
using Coordinate = Axis<"coordinate">;    ///< Coordinates of a pose.
using Typed = Axis<"typed">;              ///< Numbers to be typed into the controller.
}  // namespace axis

/// The calibration of one machine, SI. NaN where something is not determined or not known.
struct CalibrationResult {
  std::vector<NamedUnit> fitted;                                  ///< fitted errors
  Array<double, axis::Fitted> estimate;                           ///< estimates
  Array<double, axis::Fitted> sd;                                 ///< standard deviations
  Array<double, axis::Fitted> low;                                ///< lower ends of the intervals
  Array<double, axis::Fitted> high;                               ///< upper ends of the intervals
  Array<double, axis::Fitted> scale;                              ///< what counts as one: the tolerances
  std::uint64_t has_tolerances = 0;                               ///< whether `scale` are tolerances
  Array<double, axis::Fitted, axis::OtherFitted> covariance;      ///< covariance of the estimates
  Array<double, axis::Fitted, axis::OtherFitted> correlation;     ///< their correlation
  Array<double, axis::Fitted, axis::OtherFitted> null_projector;  ///< on what is unseen, in scaled numbers
  Array<double, axis::Direction> singular_values;                 ///< of the scaled matrix, the largest first
  double conf_level = 0.95;                                       ///< level of the intervals
  std::uint64_t has_prior = 0;                                    ///< whether tolerances count as knowledge
  std::uint64_t noise_is_known = 1;                               ///< whether values have standard deviations
  std::uint64_t sd_is_estimated = 0;                              ///< whether the noise is known up to one factor

  std::vector<std::string> values;           ///< names of the measured values
  std::vector<std::string> value_units;      ///< their SI units
  Array<double, axis::Value> measured;       ///< measured values
  Array<double, axis::Value> value_sd;       ///< their standard deviations
  Array<double, axis::Value> residual;       ///< measured less fitted
  Array<double, axis::Value> leverage;       ///< how far the fit follows each value
  Array<double, axis::Value> standardised;   ///< residuals over their own standard deviations
  Array<std::uint8_t, axis::Value> outlier;  ///< 1 for outliers
  std::uint64_t measured_poses = 0;          ///< number of rows
  std::uint64_t distances = 0;               ///< number of distances among the values

  double rms = kNaN;              ///< root mean square of residuals over standard deviations
  double chi_square = kNaN;       ///< sum of squares, with the prior's part
  std::uint64_t dof = 0;          ///< its degrees of freedom
  double p = kNaN;                ///< share of larger sums of squares if nothing but noise is left
  double outlier_limit = kNaN;    ///< magnitude of standardised residuals beyond which a value is an outlier
  std::uint64_t rank = 0;         ///< directions of fitted errors that are seen
  std::uint64_t frame_rank = 0;   ///< directions of frame and target that are seen
  std::uint64_t below_noise = 0;  ///< directions whose signal is below the noise
  std::uint64_t steps = 0;        ///< steps of the fit
  double O1 = kNaN;               ///< observability index
  double O2 = kNaN;               ///< observability index
  double O3 = kNaN;               ///< observability index
  double O4 = kNaN;               ///< observability index
  double O5 = kNaN;               ///< observability index
  double condition = kNaN;        ///< largest over smallest singular value that is seen

  std::vector<std::string> frame_parts;  ///< names of the numbers of frame and target
  Array<double, axis::FramePart> frame;  ///< numbers of the unknown frame and target

  Array<double, axis::Pose, axis::Moved> left_mean;    ///< what the calibrated controller leaves, expected
  Array<double, axis::Pose, axis::Moved> left_sd;      ///< its standard deviation
  std::vector<NamedUnit> drives;                       ///< the drives
  Array<double, axis::Pose, axis::Drive> drive_shift;  ///< by how much the controller moves them
  std::uint64_t unfitted = 0;                          ///< directions of errors with a tolerance that are not fitted
  double kept = kNaN;                                  ///< share of machines, as far as known, within all limits
  std::uint64_t left_in_device_frame = 0;              ///< whether what is left is seen in the device's frame

  Array<double, axis::Next, axis::Coordinate> next_pose;  ///< poses to measure next
  Array<double, axis::Next> gain;                         ///< bits of each, beyond those before it
  Array<std::uint64_t, axis::Next> candidate;             ///< their positions among the candidates

  std::vector<NamedUnit> typed;              ///< numbers for the controller; `description` is the expression
  Array<double, axis::Typed> typed_nominal;  ///< without errors
  Array<double, axis::Typed> typed_value;    ///< with the estimates
  Array<double, axis::Typed> typed_sd;       ///< standard deviation

  std::string file;         ///< name of the table of measurements
  std::string file_text;    ///< its content
  std::string file_sha256;  ///< hash of its content
};

/// The names on the axis `moved`.
std::vector<std::string> moved_names();

/// The calibration in a result. Precondition: the result is one.
inline const CalibrationResult& calibration_of(const StoredResult& result) {
  return found_of<CalibrationResult>(result);
}

}  // namespace poesy
