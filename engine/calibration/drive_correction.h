#pragma once

#include <functional>
#include <optional>
#include <span>
#include <vector>

#include "engine/calibration/exact_machine.h"

namespace poesy::calibration {

/// Gives the errors of the commanded coordinates of a displaced platform (actual minus commanded values), SI. There is
/// one for each coordinate of a pose.
using CoordinateError = std::function<Vector(const Placement& nominal, const Displacement& displacement)>;

/// Commanded coordinates that are components of a displacement, given by indices in kComponents. If one angle is among
/// them, all three must be.
CoordinateError coordinates_of_components(std::vector<std::size_t> positions);

/// A commanded pose, with the derivatives of the platform's placement and of the commanded coordinates at this pose.
struct CommandedPose {
  std::vector<double> pose;  ///< commanded coordinates, SI
  Placement nominal;         ///< placement of the perfect mechanism's platform at the pose
  Matrix motion;             ///< [6 x coordinates] rotation (rad) and displacement of P (m) per unit of each coordinate
  Matrix per_error;  ///< [coordinates x coordinates] change of the pose that causes a unit of each coordinate error
};

/// A controller that knows some errors and moves the drives so that the commanded coordinates reach their commanded
/// values. The corrected drive positions are those of the perfect mechanism at another pose. So exact solves at poses
/// suffice to find them.
class DriveCorrection {
 public:
  /// machine: must outlive this object. commanded: gives the coordinate errors.
  DriveCorrection(ExactMachine& machine, CoordinateError commanded)
      : machine_(&machine), commanded_(std::move(commanded)) {}

  /// The pose at which the perfect mechanism has the corrected drive positions, if the controller believes in these
  /// errors (all errors of the model, SI). None if that pose is out of reach or not found.
  std::optional<std::vector<double>> drive_at(std::span<const double> pose, const Vector& errors) const;

  /// Prepares a pose that is commanded to many controllers. Precondition: the pose is reachable.
  CommandedPose at(std::span<const double> pose) const;
  /// The coordinate errors (SI) with respect to the commanded pose. other: the placement of the perfect mechanism with
  /// the machine's drive positions. displacement: the machine's displacement from `other`.
  Vector error_of(const CommandedPose& commanded, const Placement& other, const Displacement& displacement) const {
    return commanded_(commanded.nominal, seen_from(displacement, other, commanded.nominal));
  }
  /// The pose minus the change that causes this coordinate error, to first order.
  static std::vector<double> without(std::span<const double> pose, const CommandedPose& commanded, const Vector& error);

 private:
  ExactMachine* machine_;
  CoordinateError commanded_;
};

}  // namespace poesy::calibration
