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

/// From counts and sums over machines to what a result says of them.
namespace poesy {

/// Sets an estimate in lists of values and of the ends of their intervals, at these positions.
template <class Values, class... Positions>
void set_estimate(const Estimate& estimate, Values& value, Values& low, Values& high, Positions... at) {
  value(at...) = estimate.value;
  low(at...) = estimate.interval.low;
  high(at...) = estimate.interval.high;
}

/// One number of each machine. moments, sketches: of each response, of the machines that are solved at each pose.
MachineValues machine_values(std::span<const Moments> moments, std::span<const QuantileSketch> sketches,
                             const Analysis& analysis);

/// limits: those of the study.
YieldResult yield_of(const MachineCounts& counts, const ScoreSums& scores, std::span<const ResponseLimit> limits,
                     double conf_level);

/// The interval of the parts, which holds that of the machines. parts: of the same machines as `found`.
PartsYield parts_yield(const PartSums& parts, const YieldResult& found);

/// First-order indices and curves of all errors: the indices added up over the poses that `at_poses` are of, the curves
/// of `curve`. errors: all of them.
MainEffects main_effects(std::span<const MainEffectSums> at_poses, Dependence dependence, const MainEffectSums& curve,
                         std::span<const BinSpread> errors, std::size_t responses, double conf_level);

/// Makes indices and curves of correlated errors NaN: what the uniform of such an error does is not what the error
/// does, and others go with it.
void leave_out_correlated(const Plan& plan, MainEffects& effects);

/// Makes indices and curves of responses NaN that do not vary (stats/indices.h), at the poses over which indices add up
/// or from machine to machine. Says which do not vary at any pose, where there are such. rounding: of each response as
/// joint_rounding (run/response_rounding.h) gives it.
void leave_out_constant(std::span<const double> rounding, MonteCarloResult& found);

/// How each error of a study lies in its bins.
std::vector<BinSpread> bin_spreads(const Plan& plan);

/// What is found at these poses, but for the effects.
EffectResult effect_result(std::span<const PoseIndex> poses, std::span<const BinSpread> errors, double conf_level);

/// What is shown of the yield that is asked for, 0 for none: kept if the one-sided lower limit at the result's level is
/// at least that, not kept if the upper limit is below it. solves: of the
/// machines at all poses.
YieldVerdict judge_yield(const YieldResult& found, const SolveCounts& solves, double asked);

/// Judges the limits of a study of machines: all together, and each alone. largest: of each response, of the machines
/// that are solved at each pose. counts: as for yield_of; solves: as for judge_yield.
LimitVerdicts judge_machines(std::span<const ResponseLimit> limits, double asked, const YieldResult& found,
                             const SolveCounts& solves, const MachineCounts& counts,
                             std::span<const QuantileSketch> largest);

}  // namespace poesy
