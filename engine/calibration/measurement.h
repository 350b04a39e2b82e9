#pragma once

#include <cstddef>
#include <optional>
#include <vector>

#include "engine/calibration/exact_machine.h"

namespace poesy::calibration {

/// What a value is a measurement of.
enum class Measured {
  deviation,  ///< a component of the platform's displacement from its commanded pose
  actual,     ///< a coordinate of P or of the tool's point itself
  distance    ///< the distance between the platform's points at two poses
};

/// A measured value.
struct MeasuredValue {
  Measured what;              ///< its kind
  std::size_t row;            ///< position of its pose
  std::size_t other = 0;      ///< position of the second pose, for a distance
  std::size_t component = 0;  ///< position among kComponents, for the others
  double value = 0.0;         ///< SI
  double sd = 0.0;            ///< standard deviation, SI
};

/// The unknown place of the measuring device. Its numbers: `height` c (m); `plane` c (m), a, b (slopes); `rigid` a
/// translation tau (m) and a rotation vector rho (rad).
enum class Frame { known, height, plane, rigid };
/// What is unknown about the measured place of the platform. Its numbers, in the platform's axes: `point` an offset
/// (m); `rigid` the offset and a rotation vector (rad) of the axes.
enum class Target { known, point, rigid };

std::size_t numbers_of(Frame frame);    ///< How many numbers it has.
std::size_t numbers_of(Target target);  ///< How many numbers it has.

/// A pose at which a machine is measured.
struct MeasuredPose {
  std::vector<double> pose;      ///< as commanded, SI
  std::vector<double> drive_at;  ///< pose at which the drives are nominal: `pose`, unless the controller corrects them
};

/// The values that a machine with errors would give, h(e, phi), where phi are the numbers of the frame and then of the
/// target. With frame `rigid` the point r is seen at E(rho) r + tau, and axes R at E(rho) R. With `height` and `plane`
/// heights z are seen at z - (c + a x + b y), with the actual x and y of the same point.
class Measurement {
 public:
  /// machine: must outlive it. poses: reachable. values: their `row` and `other` are positions of poses.
  Measurement(ExactMachine& machine, std::vector<MeasuredPose> poses, std::vector<MeasuredValue> values, Frame frame,
              Target target);

  std::size_t size() const { return values_.size(); }                              ///< The number of values, m.
  std::size_t places() const { return numbers_of(frame_) + numbers_of(target_); }  ///< The number of phi.
  Frame frame() const { return frame_; }                                           ///< The kind of frame.
  const std::vector<MeasuredValue>& values() const { return values_; }             ///< The values.
  const std::vector<MeasuredPose>& poses() const { return poses_; }                ///< The poses.
  const std::vector<Placement>& nominal() const { return nominal_; }               ///< Nominal placements at the poses.
  Vector measured() const;                                                         ///< [m] The measured values, SI.

  /// The displacements at all poses with these errors [F]; none if a machine is not solved.
  std::optional<std::vector<Displacement>> displacements(const Vector& errors) const;
  /// The same for each column of errors [F x B]; none if one is not solved.
  std::optional<std::vector<std::vector<Displacement>>> displacements(const Matrix& errors) const;
  /// [m] The values that these displacements give, with phi [places()].
  Vector values_of(const std::vector<Displacement>& displacements, const Vector& phi) const;

  /// The frame that places the nominal points best on the measured ones (Kabsch 1976), and a known target: where a fit
  /// begins. Zero unless the frame is `rigid` and at least three points were measured in all coordinates.
  Vector start() const;

 private:
  ExactMachine* machine_;
  std::vector<MeasuredPose> poses_;
  std::vector<MeasuredValue> values_;
  Frame frame_;
  Target target_;
  std::vector<Placement> nominal_;   ///< at `pose`
  std::vector<Placement> drive_at_;  ///< at `drive_at`
};

}  // namespace poesy::calibration
