#pragma once

#include <algorithm>
#include <cstddef>
#include <span>
#include <vector>

#include "engine/kinds/limited_vectors.h"
#include "engine/kinds/machine_calibration.h"
#include "engine/kinds/monte_carlo/part_groups.h"
#include "engine/model/model.h"
#include "engine/stats/error_scores.h"
#include "engine/stats/main_effects.h"
#include "engine/study/plan.h"
#include "engine/study/study.h"

namespace poesy::monte_carlo {

/// How many machines a unit of work has.
enum class UnitSize {
  usual,      ///< up to 1000; fewer if there are many poses, because memory grows with machines times poses
  calibrated  ///< few, because calibrated machines take much longer to solve
};

/// The machines of a study that draws errors per machine, divided into units of work, and data for their statistics. A
/// unit has consecutive machines, each at all poses. Everything follows from the study, so it is the same on all ranks.
class MachineTable {
 public:
  /// Keeps references to the plan, the model and the calibration (null: machines are not calibrated). keep_all: whether
  /// to record for every machine whether it is rejected. Precondition: the study draws errors per machine.
  MachineTable(const Plan& plan, const Model& model, const Analysis& analysis,
               const MachineCalibration* calibration = nullptr, bool keep_all = false);

  /// The number of machines in a unit; it divides Plan::kUnitSamples. It is smaller for a larger number of poses,
  /// because the memory of a unit grows with the number of machines times poses, but large enough for solvers that
  /// solve a batch at once.
  static std::size_t unit_machines(std::size_t poses, UnitSize size = UnitSize::usual);
  /// The number of units for this many machines. The last unit may be smaller.
  static std::size_t units_for(std::size_t machines, std::size_t poses, UnitSize size = UnitSize::usual);
  /// The size of the units of a study.
  static UnitSize unit_size(const Analysis& analysis) {
    return analysis.calibration == nullptr ? UnitSize::usual : UnitSize::calibrated;
  }

  const Plan& plan() const { return *plan_; }  ///< The plan.
  /// The calibration of the machines; null: they are not calibrated.
  const MachineCalibration* calibration() const { return calibration_; }
  std::size_t responses() const { return responses_; }               ///< The number of responses.
  std::size_t units() const { return units_for(plan_->samples()); }  ///< The number of units of the whole study.
  /// The machines of unit n as a WorkUnit at pose 0.
  WorkUnit unit(std::size_t n) const;
  /// Whether unit n has the full number of machines.
  bool is_whole(std::size_t n) const { return unit(n).count == unit_machines(); }
  /// unit_machines() and units_for() for the number of poses and the calibration of this study.
  /// @{
  std::size_t unit_machines() const {
    return unit_machines(plan_->poses().size(), calibration_ == nullptr ? UnitSize::usual : UnitSize::calibrated);
  }
  std::size_t units_for(std::size_t machines) const { return (machines + unit_machines() - 1) / unit_machines(); }
  /// @}

  /// Whether the study has limits, so that machines may be rejected.
  bool has_limits() const { return has_limits_; }
  /// [responses] The limit of each response; infinite for a response without a limit.
  std::span<const ValueLimit> limits() const { return limits_; }
  /// Whether every limit must hold at each pose, so that none is judged over the poses of a machine.
  bool judges_each_pose() const {
    return std::ranges::none_of(limits_, [](const ValueLimit& limit) { return limit.is_over_poses(); });
  }
  /// The responses whose limits are not plain (ValueLimit::is_plain()), ascending. For these responses, the value by
  /// which each machine is judged is recorded.
  std::span<const std::size_t> judged() const { return judged_; }
  std::size_t errors() const { return scores_.each.size(); }  ///< The number of errors.
  /// The scores of the errors: derivatives of ln(density) with respect to ln(sigma), from which the gradient of the
  /// yield is estimated. A correlated error has a score only if all errors of its block are normal.
  const ErrorScores& scores() const { return scores_; }
  /// fixed_scores(): the scores of the errors that a machine draws once. pose_scores(): the scores of the errors that
  /// it draws anew at each pose (Plan::per_pose). Each list has empty scores for the errors of the other list.
  /// @{
  const ErrorScores& fixed_scores() const { return fixed_scores_; }
  const ErrorScores& pose_scores() const { return pose_scores_; }
  /// @}
  /// Whether machines draw some errors anew at each pose.
  bool has_per_pose() const { return !plan_->per_pose().empty(); }

  /// The vectors whose norms are the limited responses (LimitedVector). Each component is fitted as a linear function
  /// of the errors.
  const LimitedVectors& vectors() const { return vectors_; }
  /// [responses] The largest spread of a response that may come from rounding in solves (Model::rounding).
  std::span<const double> rounding() const { return rounding_; }
  /// Whether unit n is used to fit the linear map from the errors to the limited vectors. The fit uses the first
  /// machines of the study, as many as it needs.
  bool is_fitted(std::size_t n) const;
  /// The number of machines, from machine 0 on, from which the gradient of the yield is estimated by a linear map. It
  /// is limited, because the estimate takes time for each error at each pose. 0 if there is no such estimate.
  std::size_t mapped() const { return mapped_; }
  /// The number of machines, from machine 0 on, for which it is recorded whether they are rejected: mapped(), or all
  /// machines.
  std::size_t kept() const { return kept_; }
  /// The groups of errors that were measured on parts. Empty if there are none, or if the study has no limits. If
  /// PartGroups::known is false, the influence of the parts cannot be computed, and groups may be missing.
  const PartGroups& parts() const { return parts_; }
  /// Whether the study has limits and errors that were measured on parts, even if the influence of the parts cannot be
  /// computed.
  bool has_parts() const { return !parts_.each.empty() || !parts_.known; }

  /// The poses at which sums for main effects are computed (engine/run/effect_poses.h).
  std::span<const PoseIndex> effect_poses() const { return effect_poses_; }
  /// The number of quantities with sums for main effects: the responses at each of effect_poses(), the mean over all
  /// poses, and the largest magnitude over all poses.
  std::size_t effects() const { return effect_poses_.size() + 2; }

 private:
  const Plan* plan_;
  const MachineCalibration* calibration_;
  std::size_t responses_;
  bool has_limits_;
  std::vector<ValueLimit> limits_;
  std::vector<std::size_t> judged_;
  ErrorScores scores_;
  ErrorScores fixed_scores_;
  ErrorScores pose_scores_;
  LimitedVectors vectors_;
  std::vector<double> rounding_;
  std::size_t mapped_;
  std::size_t kept_;
  PartGroups parts_;
  std::vector<PoseIndex> effect_poses_;
};

}  // namespace poesy::monte_carlo
