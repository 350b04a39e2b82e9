#pragma once

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

/// The machines of a study that draws errors per machine, in units: consecutive machines, each unit at all poses. And
/// what their statistics need to know beforehand. Depends on the study alone, so everybody who has it has the same one.
/// M poses, R responses, P errors.
class MachineTable {
 public:
  /// Refers to the plan and the model. Precondition: Draws::per_machine.
  MachineTable(const Plan& plan, const Model& model, const Analysis& analysis);

  /// Machines of a unit at so many poses, a divisor of Plan::kUnitSamples: the fewer the more poses there are, because
  /// memory grows with both, but enough for a solver that takes several at once.
  static std::size_t unit_machines(std::size_t poses);
  /// Units that so many machines make up, the last one perhaps smaller.
  static std::size_t units_for(std::size_t machines, std::size_t poses);

  const Plan& plan() const { return *plan_; }                                               ///< Of the study.
  std::size_t responses() const { return responses_; }                                      ///< R.
  std::size_t units() const { return units_for(plan_->samples(), plan_->poses().size()); }  ///< Of the whole study.
  /// The n-th unit's machines, at the first pose.
  WorkUnit unit(std::size_t n) const;
  /// Whether it is as large as any.
  bool is_whole(std::size_t n) const { return unit(n).count == unit_machines(plan_->poses().size()); }

  bool has_limits() const { return has_limits_; }             ///< Whether machines may be rejected.
  std::span<const double> limits() const { return limits_; }  ///< On magnitudes of responses, infinite for none.
  std::size_t errors() const { return scores_.each.size(); }  ///< P.
  /// How the yield depends on the size of each error. Not known of an error that is correlated with others unless they
  /// are all normal.
  const ErrorScores& scores() const { return scores_; }

  /// The vectors behind the limited responses, which are fitted to first order.
  const LimitedVectors& vectors() const { return vectors_; }
  /// For each response what an error may seem to do because solves round (Model::rounding).
  std::span<const double> rounding() const { return rounding_; }
  /// Whether the vectors are fitted to this unit's machines, too: they are the first ones, as many as tell what is
  /// linear.
  bool is_fitted(std::size_t n) const;
  /// The first machines of the study, of which it is kept whether they are rejected: as many as the gradient of the
  /// yield by a linear map looks at, which takes time for each error at each pose. 0 where none is wanted.
  std::size_t kept() const { return kept_; }
  /// What is known of the parts that errors were measured on, where there are limits.
  const PartGroups& parts() const { return parts_; }
  /// Whether errors were measured on parts, and there are limits.
  bool has_parts() const { return !parts_.each.empty() || !parts_.known; }

  /// The poses at which main effects are added up (engine/run/effect_poses.h).
  std::span<const PoseIndex> effect_poses() const { return effect_poses_; }
  /// Numbers whose main effects are added up: the responses at each of effect_poses(), a machine's means over all
  /// poses, and its largest magnitudes.
  std::size_t effects() const { return effect_poses_.size() + 2; }

 private:
  const Plan* plan_;
  std::size_t responses_;
  bool has_limits_;
  std::vector<double> limits_;
  ErrorScores scores_;
  LimitedVectors vectors_;
  std::vector<double> rounding_;
  std::size_t kept_;
  PartGroups parts_;
  std::vector<PoseIndex> effect_poses_;
};

}  // namespace poesy
