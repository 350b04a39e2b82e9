#pragma once

#include <span>

#include "engine/kinds/monte_carlo/machine_unit.h"
#include "engine/kinds/monte_carlo/result.h"
#include "engine/run/result.h"
#include "engine/stats/first_order.h"
#include "engine/stats/machines.h"
#include "engine/stats/main_effects.h"
#include "engine/stats/quantile_sketch.h"
#include "engine/stats/yield_gradient.h"
#include "engine/study/plan.h"
#include "engine/study/study.h"

/// Computes the numbers of a result from counts and sums over machines.
namespace poesy {

/// Sets an estimate in lists of values and of the ends of their intervals, at these positions.
template <class Values, class... Positions>
void set_estimate(const Estimate& estimate, Values& value, Values& low, Values& high, Positions... at) {
  value(at...) = estimate.value;
  low(at...) = estimate.interval.low;
  high(at...) = estimate.interval.high;
}

/// One number of each machine. moments, sketches: [R] of the machines that are solved at each pose.
MachineValues machine_values(std::span<const Moments> moments, std::span<const QuantileSketch> sketches,
                             const Analysis& analysis);

/// The yield and its gradient. limits: those of the study.
YieldResult yield_of(const MachineCounts& counts, const ScoreSums& scores, std::span<const ResponseLimit> limits,
                     double conf_level);

/// Sets the gradient by errors that machines draw anew at each pose (MachineSums::pose_scores).
void set_pose_gradient(const Plan& plan, const ScoreSums& scores, YieldResult& found);

/// The interval that includes the uncertainty from few parts. parts: of the same machines as `found`.
PartsYield parts_yield(const PartSums& parts, const YieldResult& found);

/// First-order indices, summed over the poses of `at_poses`, and curves from `curve`. errors: [P] all errors.
MainEffects main_effects(std::span<const MainEffectSums> at_poses, Dependence dependence, const MainEffectSums& curve,
                         std::span<const BinSpread> errors, std::size_t responses, double conf_level);

/// Sets indices and curves of correlated errors to NaN, because other errors vary with them, and the uniform from which
/// such an error is drawn is not its own.
void leave_out_correlated(const Plan& plan, MainEffects& effects);

/// Sets indices and curves of errors that machines draw anew at each pose to NaN, because a machine has many of them.
void leave_out_per_pose(const Plan& plan, MainEffects& effects);
/// The same for the curves alone: the indices are those at single poses.
void leave_out_curves_per_pose(const Plan& plan, MainEffects& effects);

/// Sets indices and curves to NaN for responses that do not vary (stats/indices.h), at the poses over which indices are
/// summed or from machine to machine. Records which responses do not vary at any pose, if there are some. rounding: [R]
/// see joint_rounding() (run/response_rounding.h).
void leave_out_constant(std::span<const double> rounding, MonteCarloResult& found);

/// The distribution of each error of a study in its bins.
std::vector<BinSpread> bin_spreads(const Plan& plan);

/// The result at these poses, without the effects.
EffectResult effect_result(std::span<const PoseIndex> poses, std::span<const BinSpread> errors, double conf_level);

/// Judges the yield against the wanted one (0: none): kept if the one-sided lower limit at the result's level is at
/// least that, not kept if the upper limit is below it. solves: those of the machines at all poses.
YieldVerdict judge_yield(const YieldResult& found, const SolveCounts& solves, double asked);

/// Judges the limits of a study with draws per machine, together and each alone. judged: [R] what machines are judged
/// by (ValueLimit::deciding), of those that are solved at each pose. counts: see yield_of(); solves: see judge_yield().
LimitVerdicts judge_machines(std::span<const ResponseLimit> limits, double asked, const YieldResult& found,
                             const SolveCounts& solves, const MachineCounts& counts,
                             std::span<const QuantileSketch> judged);

}  // namespace poesy
