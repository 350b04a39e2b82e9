#pragma once

#include <algorithm>
#include <cstddef>
#include <span>
#include <vector>

#include "engine/kinds/monte_carlo/limited_vectors.h"
#include "engine/kinds/monte_carlo/part_groups.h"
#include "engine/model/model.h"
#include "engine/stats/error_scores.h"
#include "engine/stats/main_effects.h"
#include "engine/study/plan.h"
#include "engine/study/study.h"

namespace poesy {

/// The machines of a study that draws errors per machine, divided into units, and the data that their statistics need
/// beforehand. A unit has consecutive machines, each at all poses. Everything depends on the study alone, so all ranks
/// have the same. M poses, R responses, P errors.
class MachineTable {
 public:
  /// Refers to the plan and the model. Precondition: Draws::per_machine.
  MachineTable(const Plan& plan, const Model& model, const Analysis& analysis);

  /// The number of machines in a unit of a study with this many poses, a divisor of Plan::kUnitSamples. It is smaller
  /// for more poses, because memory grows with both, but large enough for a solver of batches.
  static std::size_t unit_machines(std::size_t poses);
  /// The number of units for this many machines. The last unit may be smaller.
  static std::size_t units_for(std::size_t machines, std::size_t poses);

  const Plan& plan() const { return *plan_; }           ///< The plan of the study.
  std::size_t responses() const { return responses_; }  ///< The number of responses, R.
  std::size_t units() const {
    return units_for(plan_->samples(), plan_->poses().size());
  }  ///< The number of units of the whole study.
  /// The machines of the n-th unit, at the first pose.
  WorkUnit unit(std::size_t n) const;
  /// Whether the unit is full.
  bool is_whole(std::size_t n) const { return unit(n).count == unit_machines(plan_->poses().size()); }

  bool has_limits() const { return has_limits_; }                 ///< Whether machines may be rejected.
  std::span<const ValueLimit> limits() const { return limits_; }  ///< [R] The limit of each response, if it has one.
  /// Whether each limit is judged at each pose alone, and none over the poses of a machine.
  bool judges_each_pose() const {
    return std::ranges::none_of(limits_, [](const ValueLimit& limit) { return limit.is_over_poses(); });
  }
  /// The limited responses whose limits are not plain, ascending. It is stored of each machine by what it is judged.
  std::span<const std::size_t> judged() const { return judged_; }
  std::size_t errors() const { return scores_.each.size(); }  ///< The number of errors, P.
  /// The scores of the errors, from which the gradient of the yield by their sizes is computed. An error that is
  /// correlated with others has one only if they are all normal.
  const ErrorScores& scores() const { return scores_; }
  /// The same scores divided: those of errors that are fixed in a machine, and those of errors that it draws anew at
  /// each pose (Plan::per_pose). Each has no score for the errors of the other.
  /// @{
  const ErrorScores& fixed_scores() const { return fixed_scores_; }
  const ErrorScores& pose_scores() const { return pose_scores_; }
  /// @}
  /// Whether machines draw some errors anew at each pose.
  bool has_per_pose() const { return !plan_->per_pose().empty(); }

  /// The vectors behind the limited responses, which are fitted to first order.
  const LimitedVectors& vectors() const { return vectors_; }
  /// [R] The effect that an error may seem to have because solves round (Model::rounding).
  std::span<const double> rounding() const { return rounding_; }
  /// Whether the vectors are fitted to the machines of this unit. They are fitted to the first machines, as many as
  /// show what is linear.
  bool is_fitted(std::size_t n) const;
  /// The number of machines, the first of the study, for which it is stored whether they are rejected. The gradient of
  /// the yield by a linear map uses them, which takes time for each error at each pose. 0 if no gradient is computed.
  std::size_t kept() const { return kept_; }
  /// The groups of errors that were measured on parts; empty without limits.
  const PartGroups& parts() const { return parts_; }
  /// Whether errors were measured on parts and there are limits.
  bool has_parts() const { return !parts_.each.empty() || !parts_.known; }

  /// The poses at which main effects are summed (engine/run/effect_poses.h).
  std::span<const PoseIndex> effect_poses() const { return effect_poses_; }
  /// The number of values whose main effects are summed: the responses at each of effect_poses(), the mean over all
  /// poses, and the largest magnitude.
  std::size_t effects() const { return effect_poses_.size() + 2; }

 private:
  const Plan* plan_;
  std::size_t responses_;
  bool has_limits_;
  std::vector<ValueLimit> limits_;
  std::vector<std::size_t> judged_;
  ErrorScores scores_;
  ErrorScores fixed_scores_;
  ErrorScores pose_scores_;
  LimitedVectors vectors_;
  std::vector<double> rounding_;
  std::size_t kept_;
  PartGroups parts_;
  std::vector<PoseIndex> effect_poses_;
};

}  // namespace poesy
