#pragma once

#include <cstddef>
#include <optional>
#include <vector>

#include "engine/calibration/exact_machine.h"

namespace poesy::calibration {

/// The kind of quantity that a value measures.
enum class Measured {
  deviation,  ///< a component (kComponents) of the platform's displacement from the commanded pose
  actual,     ///< a coordinate of P or of the tool point
  distance    ///< the distance between the positions of the tool point (of P if there is no tool) at two poses
};

/// A measured value.
struct MeasuredValue {
  Measured what;              ///< kind of quantity
  std::size_t row;            ///< index of the pose in the list of poses
  std::size_t other = 0;      ///< index of the second pose, for a distance
  std::size_t component = 0;  ///< index in kComponents, unless a distance is measured
  double value = 0.0;         ///< measured value, SI
  double sd = 0.0;            ///< standard deviation of the measured value, SI
};

/// What is unknown about the place of the measuring device, and the numbers that describe it. `height`: an offset c (m)
/// along z. `plane`: an offset c (m) and the slopes a and b. `rigid`: a translation tau (m) and a rotation vector rho
/// (rad).
enum class Frame { known, height, plane, rigid };
/// What is unknown about the place of the measured target on the platform, and the numbers that describe it in the
/// platform's axes. `point`: an offset (m). `rigid`: an offset and a rotation vector (rad) of the target's axes.
enum class Target { known, point, rigid };

std::size_t numbers_of(Frame frame);    ///< The number of entries of phi for a frame.
std::size_t numbers_of(Target target);  ///< The number of entries of phi for a target.

/// A pose at which a machine is measured.
struct MeasuredPose {
  std::vector<double> pose;  ///< commanded pose, SI
  /// Pose at which the perfect mechanism has the machine's drive positions, SI: `pose`, unless a controller corrects
  /// the drives.
  std::vector<double> drive_at;
};

/// The measured values h(e, phi) as a function of the errors e and of phi, the numbers of the frame followed by those
/// of the target. With the frame `rigid`, the device sees a point r at E(rho) r + tau and axes R at E(rho) R. Here tau
/// is a translation, rho a rotation vector and E(rho) its rotation matrix. With `height` and `plane` it sees a height z
/// as z - (c + a x + b y), with an offset c, slopes a and b (0 for `height`), and the actual coordinates x and y of the
/// same point.
class Measurement {
 public:
  /// machine: must outlive this object. poses: reachable. values: `row` and `other` are indices in `poses`.
  Measurement(ExactMachine& machine, std::vector<MeasuredPose> poses, std::vector<MeasuredValue> values, Frame frame,
              Target target);

  std::size_t size() const { return values_.size(); }                              ///< The number of measured values.
  std::size_t places() const { return numbers_of(frame_) + numbers_of(target_); }  ///< The number of entries of phi.
  /// What is unknown about the place of the measuring device.
  Frame frame() const { return frame_; }
  /// The measured values with their kinds.
  const std::vector<MeasuredValue>& values() const { return values_; }
  const std::vector<MeasuredPose>& poses() const { return poses_; }  ///< The poses of the measurement.
  /// Nominal placements at the commanded poses.
  const std::vector<Placement>& nominal() const { return nominal_; }
  Vector measured() const;  ///< [values] The measured values, SI.
  /// Replaces the measured values (SI) by those of another machine at the same poses.
  void set_measured(const Vector& values);

  /// The displacements at all poses [poses] of the machine with these errors (all errors of the model, SI); none if it
  /// is not solved at a pose.
  std::optional<std::vector<Displacement>> displacements(const Vector& errors) const;
  /// [machines][poses] The displacements of the machines with these errors [all errors x machines], SI. Empty for a
  /// machine that is not solved at every pose.
  std::vector<std::vector<Displacement>> displacements_of_solved(const Matrix& errors) const;
  /// [machines][poses] The displacements of the machines with these errors [all errors x machines], SI; none if any
  /// machine is not solved at a pose.
  std::optional<std::vector<std::vector<Displacement>>> displacements(const Matrix& errors) const;
  /// [values] The values that are measured at these displacements [poses], SI. phi: numbers of the frame and of the
  /// target (see Measurement).
  Vector values_of(const std::vector<Displacement>& displacements, const Vector& phi) const;

  /// The numbers phi at which a fit begins. They are 0, except for a frame `rigid` if at least three points were
  /// measured in all three coordinates: its numbers then map the nominal points to the measured ones with the least sum
  /// of squares (Kabsch 1976).
  Vector start() const;

 private:
  ExactMachine* machine_;
  std::vector<MeasuredPose> poses_;
  std::vector<MeasuredValue> values_;
  Frame frame_;
  Target target_;
  std::vector<Placement> nominal_;   ///< nominal placements at MeasuredPose::pose
  std::vector<Placement> drive_at_;  ///< nominal placements at MeasuredPose::drive_at
};

}  // namespace poesy::calibration
