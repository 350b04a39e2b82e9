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
namespace poesy::monte_carlo {

/// Sets an estimate at these positions: its value, and both ends of its interval, in three lists.
template <class Values, class... Positions>
void set_estimate(const Estimate& estimate, Values& value, Values& low, Values& high, Positions... at) {
  value(at...) = estimate.value;
  low(at...) = estimate.interval.low;
  high(at...) = estimate.interval.high;
}

/// The distribution over the machines of a number that each machine has, such as its largest magnitude. moments,
/// sketches: [responses] moments and quantile sketch of this number over the machines that are solved at every pose.
MachineValues machine_values(std::span<const Moments> moments, std::span<const QuantileSketch> sketches,
                             const Analysis& analysis);

/// The yield and its gradient. counts, scores: over all machines; limits: those of the study.
YieldResult yield_of(const MachineCounts& counts, const ScoreSums& scores, std::span<const ResponseLimit> limits,
                     double conf_level);

/// The yields that the calibrated machines would have without calibration, and with the best correction. found: the
/// yield with calibration.
CalibrationYields calibration_yields(const CalibrationCounts& counts, const MachineCalibration& calibration,
                                     const YieldResult& found);

/// Sets the gradient with respect to errors that machines draw anew at each pose (MachineSums::pose_scores).
void set_pose_gradient(const Plan& plan, const ScoreSums& scores, YieldResult& found);

/// The interval of the yield that includes the uncertainty from few parts. parts: sums over the same machines as
/// `found`.
PartsYield parts_yield(const PartSums& parts, const YieldResult& found);

/// First-order indices and main-effect curves. at_poses: the sums at each of the poses over which the variances of the
/// indices are added up. curve: the sums from which the curves are computed. errors: [errors] distribution of each
/// error in its bins.
MainEffects main_effects(std::span<const MainEffectSums> at_poses, Dependence dependence, const MainEffectSums& curve,
                         std::span<const BinSpread> errors, std::size_t responses, double conf_level);

/// Sets indices and curves to NaN for errors that are correlated, or drawn together with others of their feature. A
/// main effect is defined only for an error that varies independently of the others and is computed from one uniform
/// number.
void leave_out_dependent(const Plan& plan, MainEffects& effects);

/// Sets indices and curves to NaN for errors that machines draw anew at each pose, because a machine has many values of
/// them.
void leave_out_per_pose(const Plan& plan, MainEffects& effects);
/// Sets the curves, but not the indices, to NaN for errors that machines draw anew at each pose. The indices of these
/// errors are valid if they were computed at single poses.
void leave_out_curves_per_pose(const Plan& plan, MainEffects& effects);

/// Sets the indices and curves of a response to NaN if it does not vary (stats/indices.h) at the poses over which the
/// variances of indices are summed, and those of its largest magnitude if this does not vary between machines. Records
/// in found.varies which responses vary at some pose, if not all do. rounding: [responses] see joint_rounding()
/// (run/response_rounding.h).
void leave_out_constant(std::span<const double> rounding, Result& found);

/// [errors] The distribution of each error within its bins of equal probability.
std::vector<BinSpread> bin_spreads(const Plan& plan);

/// A result of main effects at these poses, with the means of the errors in the bins but without indices and curves.
EffectResult effect_result(std::span<const PoseIndex> poses, std::span<const BinSpread> errors, double conf_level);

/// Judges the yield against the wanted yield `asked` (0: none). The wanted yield is kept if the one-sided lower
/// confidence bound of the yield is at least `asked`, not kept if the one-sided upper bound is below `asked`, and
/// otherwise undecided. solves: how the solves of the machines at all poses ended.
YieldVerdict judge_yield(const YieldResult& found, const SolveCounts& solves, double asked);

/// Judges the limits of a study with draws per machine: all together, and each alone. asked: the wanted yield; 0: none.
/// judged: [responses] the values by which machines are judged: largest magnitudes, or ValueLimit::deciding() for a
/// limit that is not plain, of machines that are solved at every pose. counts: the counts over all machines. solves:
/// see judge_yield().
LimitVerdicts judge_machines(std::span<const ResponseLimit> limits, double asked, const YieldResult& found,
                             const SolveCounts& solves, const MachineCounts& counts,
                             std::span<const QuantileSketch> judged);

}  // namespace poesy::monte_carlo
