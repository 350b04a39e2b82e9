#pragma once

#include <optional>
#include <span>
#include <vector>

#include "engine/calibration/drive_correction.h"
#include "engine/calibration/fit.h"
#include "engine/calibration/inference.h"

namespace poesy::calibration {

/// What is known about a machine from a measurement: estimates of its errors and of the place of the measuring device.
struct Knowledge {
  FittedDirections directions;  ///< directions along which errors may differ from 0
  Vector theta;                 ///< [numbers] estimates of the errors along the directions, SI
  Vector phi;                   ///< [places] estimates for the frame of the measuring device and for the target, SI
  Matrix covariance;            ///< [(numbers + places) x (numbers + places)] joint covariance of theta and phi

  Vector errors() const { return directions.F * theta; }  ///< [all errors] estimated errors, SI.
};

/// The knowledge from a solved fit with this prior. sd: FitProblem::sd. sd_factor: ratio of the actual to the stated
/// noise. The covariance is 0 along directions that neither the prior nor the measurements determine.
Knowledge knowledge(const FitResult& fit, const FittedDirections& directions, const Vector& sd, const Prior& prior,
                    double sd_factor);

/// A controller that uses fitted numbers, and the frame in which the remaining displacement is stated. This frame is
/// the base frame, or the measuring device's frame if the place of the device is unknown.
struct Corrected {
  Vector errors;  ///< [all errors] errors that the controller corrects, SI
  Vector phi;     ///< [places] place of the device from the fit that gave `errors`, SI
  Frame frame;    ///< what is unknown about the place of the device
};

/// The displacement that remains at one pose after a controller has corrected the drives.
struct LeftAtPose {
  std::vector<double> drive_at;  ///< pose at which the perfect mechanism has the corrected drive positions, SI
  Components mean;               ///< remaining displacement for the estimated errors, by an exact solve, SI
  /// Standard deviations of the remaining displacement to first order, SI. Derivatives are taken at zero errors with
  /// Frame::known, otherwise at the estimated errors.
  Components sd;
};

/// The displacement as a measuring device sees it. actual: numbers phi of the actual place of the device. believed:
/// numbers phi that the device uses instead. nominal: placement of the perfect mechanism at the pose.
Displacement seen_by_device(const Displacement& displacement, const Placement& nominal, const Vector& actual,
                            const Vector& believed, Frame frame);

/// [9 x machines] The displacements that remain at a pose, for several machines. errors: [all errors x machines], SI.
/// phi: [places x machines] actual places of the measuring device. drive_at: pose at which the perfect mechanism has
/// the corrected drive positions. The column of a machine that is not solved is NaN.
Matrix left_of_machines(ExactMachine& machine, std::span<const double> pose, std::span<const double> drive_at,
                        const Matrix& errors, const Matrix& phi, const Corrected& corrected);

/// The remaining displacement at a pose. None if the corrected drive positions are not found, or if the machine with
/// the estimated errors, or one of those solved for the derivatives, is not solved.
std::optional<LeftAtPose> left_at(ExactMachine& machine, const DriveCorrection& correction,
                                  std::span<const double> pose, const Corrected& corrected, const Knowledge& known);

}  // namespace poesy::calibration
