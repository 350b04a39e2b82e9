#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include "engine/base/array.h"
#include "engine/base/index.h"
#include "engine/model/model.h"
#include "engine/study/plan.h"
#include "engine/study/study.h"

namespace poesy {

namespace axis {
using Limit = Axis<"limit">;  ///< Limits of a study.
}  // namespace axis

/// The limits of a study, seen from the mechanism whose errors are at their centres (Distribution::centre: zero, except
/// for a stated mean), with the constant errors of the background: K limits, M poses. What errors add to a response
/// grows with the tolerances, so a limit with two ends, or with one, is counted from this response. A limit on
/// magnitudes is counted from zero, and one on the spread over the poses from the mean over the poses.
class RelativeLimits {
 public:
  /// Solves this mechanism at all poses of the plan, if a limit is not on magnitudes.
  RelativeLimits(const Plan& plan, const Model& model, std::span<const ResponseLimit> limits);

  std::size_t size() const { return limits_.size(); }                        ///< K.
  std::size_t response(std::size_t k) const { return limits_[k].response; }  ///< The response of a limit.
  /// The value from which the limit is counted, SI.
  double centre(std::size_t k, PoseIndex pose) const { return centre_(k, pose.value); }
  /// The distance from the centre to the nearer end, SI; not above zero if the centre is not inside. Of a spread it is
  /// half of the limit, because values that are no further than this from their mean keep it.
  double room(std::size_t k, PoseIndex pose) const;
  /// The distance of a value from the centre over that of the end on its side: at most 1 exactly if the limit holds,
  /// whatever the rounding. Preconditions: room() > 0; not of a spread.
  double load(std::size_t k, PoseIndex pose, double value) const;

  bool is_spread(std::size_t k) const { return limits_[k].allowed.is_spread(); }  ///< Whether a spread is limited.
  bool any_spread() const;                                                        ///< Whether any limit is on a spread.
  /// Whether the load of a machine by this limit needs its values at all poses.
  bool is_over_poses(std::size_t k) const { return limits_[k].allowed.is_over_poses(); }
  bool any_over_poses() const { return poesy::any_over_poses(limits_); }  ///< Whether it does for any limit.
  /// The load of a machine by a limit over poses: at most 1 exactly if the limit holds. at_poses: [M] of a spread the
  /// values, else their load() at each pose; reordered.
  double load_over_poses(std::size_t k, std::span<double> at_poses) const;

 private:
  std::vector<ResponseLimit> limits_;
  Array<double, axis::Limit, axis::Pose> centre_;
};

}  // namespace poesy
