#pragma once

#include <functional>
#include <optional>
#include <span>
#include <vector>

#include "engine/calibration/exact_machine.h"

namespace poesy::calibration {

/// How far the commanded coordinates of a displaced platform are from their commanded values, [as many as a pose has
/// coordinates], SI.
using CoordinateError = std::function<Vector(const Placement& nominal, const Displacement& displacement)>;

/// The coordinates that are components of a displacement, by their positions among kComponents. If angles are among
/// them, all three must be.
CoordinateError coordinates_of_components(std::vector<std::size_t> positions);

/// A controller that knows some errors and moves the drives so that commanded coordinates are what they should be. The
/// drives are then where those of the perfect mechanism are at another pose, so nothing but exact solves at poses is
/// needed.
class DriveCorrection {
 public:
  /// machine: must outlive it.
  DriveCorrection(ExactMachine& machine, CoordinateError commanded)
      : machine_(&machine), commanded_(std::move(commanded)) {}

  /// The pose of the perfect mechanism with the corrected drives, for a controller that believes these errors [F]; none
  /// if it is out of reach or not found.
  std::optional<std::vector<double>> drive_at(std::span<const double> pose, const Vector& errors) const;

 private:
  /// The derivatives of coordinate errors [coordinates x coordinates] by the pose's coordinates.
  Matrix by_pose(std::span<const double> pose) const;
  /// The coordinate errors if the perfect mechanism is at another pose, displaced there.
  Vector error_at(const Placement& nominal, std::span<const double> other, const Displacement& displacement) const;

  ExactMachine* machine_;
  CoordinateError commanded_;
};

}  // namespace poesy::calibration
