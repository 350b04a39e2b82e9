#pragma once

#include <optional>
#include <span>
#include <vector>

#include "engine/calibration/drive_correction.h"
#include "engine/calibration/fit.h"
#include "engine/calibration/inference.h"

namespace poesy::calibration {

/// What is known of a machine after its measurement: errors and places of the measuring device together.
struct Knowledge {
  FittedDirections directions;  ///< the errors that may differ from 0
  Vector theta;                 ///< [k] their estimates
  Vector phi;                   ///< [places] the estimates of frame and target
  Matrix covariance;            ///< [(k + places) x (k + places)] of both

  Vector errors() const { return directions.F * theta; }  ///< [F] estimated errors, SI.
};

/// The knowledge from a fit that was solved, with this prior. The covariance of what neither prior nor measurements
/// determine is that of its part that they do.
Knowledge knowledge(const FitResult& fit, const FittedDirections& directions, const Vector& sd, const Prior& prior,
                    double sd_factor);

/// A controller with the fitted numbers, and the frame in which what is left counts: the base's, or that of the
/// measuring device if its place is unknown.
struct Corrected {
  Vector errors;  ///< [F] errors that the controller corrects, SI
  Vector phi;     ///< places of the device by the fit whose numbers the controller has
  Frame frame;    ///< kind of frame
};

/// What is left at one pose.
struct LeftAtPose {
  std::vector<double> drive_at;  ///< pose at which the perfect mechanism has the corrected drives
  Components mean;               ///< exact displacement for the estimated errors
  Components sd;  ///< standard deviations, to first order: at no errors, with an unknown frame at the estimate
};

/// The displacements that are left at a pose for B machines, [9 x B]. errors: [F x B]; phi: [places x B] their places
/// of the measuring device. NaN where one is not solved.
Matrix left_of_machines(ExactMachine& machine, std::span<const double> pose, std::span<const double> drive_at,
                        const Matrix& errors, const Matrix& phi, const Corrected& corrected);

/// What is left at a pose; none if the corrected pose is not found or a machine is not solved.
std::optional<LeftAtPose> left_at(ExactMachine& machine, const DriveCorrection& correction,
                                  std::span<const double> pose, const Corrected& corrected, const Knowledge& known);

}  // namespace poesy::calibration
