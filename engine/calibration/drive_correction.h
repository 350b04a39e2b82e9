#pragma once

#include <functional>
#include <optional>
#include <span>
#include <vector>

#include "engine/calibration/exact_machine.h"

namespace poesy::calibration {

/// A function that returns the errors of the commanded coordinates of a displaced platform: actual minus commanded
/// value for each coordinate of a pose, SI.
using CoordinateError = std::function<Vector(const Placement& nominal, const Displacement& displacement)>;

/// The function for commanded coordinates that are components of a displacement. positions: indices of these components
/// in kComponents. If one angle is among them, all three must be.
CoordinateError coordinates_of_components(std::vector<std::size_t> positions);

/// A commanded pose, with the derivatives of the platform's placement and of the commanded coordinates at this pose.
struct CommandedPose {
  std::vector<double> pose;  ///< commanded coordinates, SI
  Placement nominal;         ///< placement of the perfect mechanism's platform at the pose
  Matrix motion;             ///< [6 x coordinates] derivatives of rotation (rad) and of P (m) by the coordinates
  /// [coordinates x coordinates] The change of the pose that changes each coordinate error by 1: the inverse of the
  /// derivatives of the coordinate errors by the pose.
  Matrix per_error;
};

/// A controller that knows some errors and moves the drives so that the commanded coordinates reach their commanded
/// values. Corrected drive positions are stated as the pose at which the perfect mechanism has them.
class DriveCorrection {
 public:
  /// machine: must outlive this object. commanded: the function that returns the coordinate errors.
  DriveCorrection(ExactMachine& machine, CoordinateError commanded)
      : machine_(&machine), commanded_(std::move(commanded)) {}

  /// The pose at which the perfect mechanism has the corrected drive positions. errors: [all errors of the model]
  /// errors that the controller corrects, SI. None if that pose is out of reach or not found.
  std::optional<std::vector<double>> drive_at(std::span<const double> pose, const Vector& errors) const;

  /// Computes a CommandedPose, which serves all controllers that get this command. Precondition: the pose is reachable.
  CommandedPose at(std::span<const double> pose) const;
  /// The coordinate errors (SI) with respect to the commanded pose. other: the placement of the perfect mechanism with
  /// the machine's drive positions. displacement: the machine's displacement from `other`.
  Vector error_of(const CommandedPose& commanded, const Placement& other, const Displacement& displacement) const {
    return commanded_(commanded.nominal, seen_from(displacement, other, commanded.nominal));
  }
  /// The pose at which this coordinate error would be 0, to first order. pose: the pose at which the error occurs.
  static std::vector<double> without(std::span<const double> pose, const CommandedPose& commanded, const Vector& error);

 private:
  ExactMachine* machine_;
  CoordinateError commanded_;
};

}  // namespace poesy::calibration
