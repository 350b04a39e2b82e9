#pragma once

#include <optional>
#include <span>
#include <vector>

#include "engine/calibration/drive_correction.h"
#include "engine/calibration/fit.h"
#include "engine/calibration/inference.h"

namespace poesy::calibration {

/// What a measurement tells about a machine: its errors and the numbers of the measuring device.
struct Knowledge {
  FittedDirections directions;  ///< directions of errors that may differ from 0
  Vector theta;                 ///< [numbers] estimates of the errors along the directions, SI
  Vector phi;                   ///< [places] estimates for the measuring device's frame and the target
  Matrix covariance;            ///< [(numbers + places) squared] joint covariance of theta and phi

  Vector errors() const { return directions.F * theta; }  ///< [all errors] estimated errors, SI.
};

/// The knowledge from a solved fit with this prior. sd_factor: factor of the stated noise. The covariance is 0 along
/// directions that neither the prior nor the measurements determine.
Knowledge knowledge(const FitResult& fit, const FittedDirections& directions, const Vector& sd, const Prior& prior,
                    double sd_factor);

/// A controller that uses fitted numbers, and the frame in which the remaining displacement is stated. That is the base
/// frame, or the measuring device's frame if the place of the device is unknown.
struct Corrected {
  Vector errors;  ///< [all errors] errors that the controller corrects, SI
  Vector phi;     ///< [places] place of the device, from the fit that gave the controller's numbers
  Frame frame;    ///< what is unknown about the place of the device
};

/// The displacement that remains at one pose after the correction.
struct LeftAtPose {
  std::vector<double> drive_at;  ///< pose at which the perfect mechanism has the corrected drive positions, SI
  Components mean;               ///< exact remaining displacement for the estimated errors, SI
  /// Standard deviations to first order, SI. The derivatives are those at the perfect machine, or at the estimated
  /// errors if the frame is unknown.
  Components sd;
};

/// The displacement as a measuring device sees it. actual: numbers of the device's place (Knowledge::phi). believed:
/// numbers that the device uses instead. nominal: placement of the perfect mechanism at the pose.
Displacement seen_by_device(const Displacement& displacement, const Placement& nominal, const Vector& actual,
                            const Vector& believed, Frame frame);

/// [9 x machines] The displacements that remain at a pose, for several machines. errors: [all errors x machines], SI.
/// phi: [places x machines] actual places of the measuring device. drive_at: pose at which the perfect mechanism has
/// the corrected drive positions. NaN where a machine is not solved.
Matrix left_of_machines(ExactMachine& machine, std::span<const double> pose, std::span<const double> drive_at,
                        const Matrix& errors, const Matrix& phi, const Corrected& corrected);

/// The remaining displacement at a pose; none if the corrected drive positions are not found or a machine is not
/// solved.
std::optional<LeftAtPose> left_at(ExactMachine& machine, const DriveCorrection& correction,
                                  std::span<const double> pose, const Corrected& corrected, const Knowledge& known);

}  // namespace poesy::calibration
