#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include "engine/base/array.h"
#include "engine/base/index.h"
#include "engine/kinds/machine_calibration.h"
#include "engine/model/model.h"
#include "engine/study/plan.h"
#include "engine/study/study.h"

namespace poesy::axis {

using Limit = Axis<"limit">;  ///< Limits of a study.

}  // namespace poesy::axis

namespace poesy::allocation {

/// The limits of a study as distances from a centre. For a limit with one or two ends, the centre is the response of
/// the mechanism with the constant errors of the background and all varied errors at their own centres
/// (Distribution::centre: zero, or a stated mean); the deviation from this response grows with the tolerances. For a
/// limit on a magnitude, the centre is zero. For a limit on the spread over the poses, the centre is the machine's mean
/// over the poses.
class RelativeLimits {
 public:
  /// Solves the mechanism with all errors at their centres at all poses of the plan, unless all limits are on
  /// magnitudes or spreads. calibration: how this mechanism is calibrated, without noise; null: it is not calibrated.
  RelativeLimits(const Plan& plan, const Model& model, std::span<const ResponseLimit> limits,
                 const MachineCalibration* calibration = nullptr);

  std::size_t size() const { return limits_.size(); }  ///< The number of limits.
  /// Position of the response that limit k limits.
  std::size_t response(std::size_t k) const { return limits_[k].response; }
  /// The centre of limit k at a pose, SI. 0 for a limit on a spread, whose centre differs from machine to machine.
  double centre(std::size_t k, PoseIndex pose) const { return centre_(k, pose.value); }
  /// The distance from the centre to the nearer end of the limit, SI; zero or negative if the centre is not within the
  /// limit. For a limit on a spread, half the limit: if no value is farther than this from the mean, the spread keeps
  /// its limit.
  double room(std::size_t k, PoseIndex pose) const;
  /// The load of a value (SI): its distance from the centre, divided by the distance from the centre to the end of the
  /// limit on the same side. The load is at most 1 if and only if the limit holds, in spite of rounding. Preconditions:
  /// room() > 0; the limit is not on a spread.
  double load(std::size_t k, PoseIndex pose, double value) const;

  bool is_spread(std::size_t k) const { return limits_[k].allowed.is_spread(); }  ///< Whether a spread is limited.
  /// Whether some limit is on a spread.
  bool any_spread() const;
  /// Whether a limit is judged from a machine's values at all poses together.
  bool is_over_poses(std::size_t k) const { return limits_[k].allowed.is_over_poses(); }
  /// Whether some limit is judged from the values at all poses together.
  bool any_over_poses() const { return poesy::any_over_poses(limits_); }
  /// The load of a machine under a limit with is_over_poses(): at most 1 if and only if the limit holds. at_poses:
  /// [poses] the responses (SI) for a limit on a spread, otherwise load() at each pose; the function reorders them.
  double load_over_poses(std::size_t k, std::span<double> at_poses) const;

 private:
  std::vector<ResponseLimit> limits_;
  Array<double, axis::Limit, axis::Pose> centre_;
};

}  // namespace poesy::allocation
