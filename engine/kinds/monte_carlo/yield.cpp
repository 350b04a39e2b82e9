#include "engine/kinds/monte_carlo/yield.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "engine/base/nan.h"
#include "engine/kinds/monte_carlo/columns.h"
#include "engine/stats/buckets.h"
#include "engine/stats/indices.h"
#include "engine/stats/proportion.h"

namespace poesy::monte_carlo {
namespace {

double share(std::uint64_t part, std::uint64_t all) { return static_cast<double>(part) / static_cast<double>(all); }

/// Copies the estimates of all errors into lists of values, lower ends and upper ends of their intervals.
void set_all(const std::vector<Estimate>& estimates, Array<double, axis::Factor>& value,
             Array<double, axis::Factor>& low, Array<double, axis::Factor>& high) {
  make_room({estimates.size()}, value, low, high);
  for (std::size_t p = 0; p < estimates.size(); ++p) set_estimate(estimates[p], value, low, high, p);
}

/// Statistics with room for this many responses and quantiles.
MachineValues values_of(std::size_t responses, std::size_t levels) {
  MachineValues values;
  make_room({responses}, values.mean, values.mean_ci_low, values.mean_ci_high, values.std, values.min, values.max,
            values.count, values.quantile_error);
  make_room({responses, levels}, values.quantiles, values.quantiles_ci_low, values.quantiles_ci_high);
  make_room({responses, kHistogramBins + 1}, values.histogram_edges);
  make_room({responses, kHistogramBins}, values.histogram_counts);
  return values;
}

void set_quantiles(std::span<const Bucket> buckets, std::span<const double> levels, double conf_level,
                   std::size_t response, MachineValues& values) {
  std::vector<RankInterval> ranks;
  const std::uint64_t count = buckets.empty() ? 0 : buckets.back().up_to;
  for (const double level : levels) ranks.push_back(quantile_ranks(count, level, conf_level));
  const QuantilesOf found = quantiles_of(buckets, levels, ranks);
  found.copy(values.quantiles.row(response), values.quantiles_ci_low.row(response),
             values.quantiles_ci_high.row(response));
  values.quantile_error(response) = found.error;
}

/// Sets main-effect curves to NaN. at: a response and an error, or only a response, for all its errors.
template <class... Positions>
void leave_out_curve(MainEffects& effects, Positions... at) {
  for (auto* list : {&effects.mean, &effects.ci_low, &effects.ci_high}) std::ranges::fill(list->row(at...), kNaN);
}

/// Sets indices and curves to NaN. at: as for leave_out_curve().
template <class... Positions>
void leave_out(MainEffects& effects, Positions... at) {
  for (auto* list : {&effects.s1, &effects.s1_ci_low, &effects.s1_ci_high}) std::ranges::fill(list->row(at...), kNaN);
  leave_out_curve(effects, at...);
}

}  // namespace

MachineValues machine_values(std::span<const Moments> moments, std::span<const QuantileSketch> sketches,
                             const Analysis& analysis) {
  const std::vector<double>& levels = asked_of<Options>(analysis).quantiles;
  MachineValues values = values_of(moments.size(), levels.size());
  for (std::size_t r = 0; r < moments.size(); ++r) {
    const bool none = moments[r].count() == 0;
    set_estimate({none ? kNaN : moments[r].mean(), mean_interval(moments[r], analysis.conf_level)}, values.mean,
                 values.mean_ci_low, values.mean_ci_high, r);
    values.std(r) = moments[r].standard_deviation();
    values.min(r) = sketches[r].min();
    values.max(r) = sketches[r].max();
    values.count(r) = moments[r].count();
    const std::vector<Bucket> buckets = sketches[r].buckets();
    set_quantiles(buckets, levels, analysis.conf_level, r, values);
    fill_histogram(buckets, values.histogram_edges.row(r), values.histogram_counts.row(r));
  }
  return values;
}

YieldResult yield_of(const MachineCounts& counts, const ScoreSums& scores, std::span<const ResponseLimit> limits,
                     double conf_level) {
  const std::uint64_t n = counts.machines;
  const auto good = [&](std::uint64_t rejects) { return proportion(n - rejects, n, conf_level); };
  const Estimate strict = good(counts.all.strict);
  const Estimate lenient = good(counts.all.lenient);
  YieldResult found{.conf_level = conf_level,
                    .value = strict.value,
                    .ci_low = strict.interval.low,
                    .ci_high = strict.interval.high,
                    .rejects = counts.all.strict,
                    .machines = n,
                    .unsolved = counts.unsolved,
                    .unsolved_pass = lenient.value,
                    .unsolved_pass_ci_low = lenient.interval.low,
                    .unsolved_pass_ci_high = lenient.interval.high,
                    .unsolved_pass_rejects = counts.all.lenient};
  for (auto* list : {&found.by_response, &found.by_response_ci_low, &found.by_response_ci_high}) {
    *list = Array<double, axis::Response>(counts.by_limit.lengths(), kNaN);
  }
  found.worst_pose_share = decltype(found.worst_pose_share)(counts.at_pose.lengths(), kNaN);
  for (const ResponseLimit& limit : limits) {
    const std::size_t r = limit.response;
    set_estimate(good(counts.by_limit(r).strict), found.by_response, found.by_response_ci_low,
                 found.by_response_ci_high, r);
    // A limit on the spread is judged over all poses together, so the shares at single poses remain NaN.
    if (limit.allowed.is_spread()) continue;
    std::ranges::transform(counts.at_pose.row(r), found.worst_pose_share.row(r).begin(),
                           [&](const Rejects& rejects) { return share(rejects.strict, n); });
  }
  set_all(scores.gradient(conf_level), found.gradient, found.gradient_ci_low, found.gradient_ci_high);
  set_all(scores.change(conf_level), found.change, found.change_ci_low, found.change_ci_high);
  found.change_sd_without_effect = {found.change.lengths(), scores.change_sd_without_effect()};
  return found;
}

CalibrationYields calibration_yields(const CalibrationCounts& counts, const MachineCalibration& calibration,
                                     const YieldResult& found) {
  const auto good = [&](std::uint64_t rejects) {
    return proportion(found.machines - rejects, found.machines, found.conf_level);
  };
  const Estimate without = good(counts.uncalibrated);
  const bool knows_best = calibration.model().calibrated_evaluator(calibration.study().solver) != nullptr;
  const Estimate best = knows_best ? good(counts.best) : Estimate{kNaN, {kNaN, kNaN}};
  return {.uncalibrated = without.value,
          .uncalibrated_ci_low = without.interval.low,
          .uncalibrated_ci_high = without.interval.high,
          .best = best.value,
          .best_ci_low = best.interval.low,
          .best_ci_high = best.interval.high,
          .not_fitted = counts.not_fitted,
          .fitted = calibration.fitted(),
          .measured = calibration.values(),
          .measured_poses = calibration.measured_poses()};
}

void set_pose_gradient(const Plan& plan, const ScoreSums& scores, YieldResult& found) {
  const std::vector<Estimate> gradient = scores.gradient(found.conf_level);
  const std::vector<Estimate> change = scores.change(found.conf_level);
  const std::vector<double> sd_without_effect = scores.change_sd_without_effect();
  for (const std::size_t p : plan.per_pose()) {
    found.change_sd_without_effect(p) = sd_without_effect[p];
    set_estimate(gradient[p], found.gradient, found.gradient_ci_low, found.gradient_ci_high, p);
    set_estimate(within(change[p], -found.value, 1.0 - found.value), found.change, found.change_ci_low,
                 found.change_ci_high, p);
  }
}

PartsYield parts_yield(const PartSums& parts, const YieldResult& found) {
  const Interval interval = parts.interval(found.conf_level);
  if (std::isnan(interval.low)) return {kNaN, kNaN};
  return {std::min(interval.low, found.ci_low), std::max(interval.high, found.ci_high)};
}

MainEffects main_effects(std::span<const MainEffectSums> at_poses, Dependence dependence, const MainEffectSums& curve,
                         std::span<const BinSpread> errors, std::size_t responses, double conf_level) {
  MainEffects effects;
  make_room({responses, errors.size()}, effects.s1, effects.s1_ci_low, effects.s1_ci_high);
  make_room({responses, errors.size(), kEffectBins}, effects.mean, effects.ci_low, effects.ci_high);
  for (std::size_t r = 0; r < responses; ++r) {
    for (std::size_t p = 0; p < errors.size(); ++p) {
      std::vector<BinnedVariance> variances;
      for (const MainEffectSums& sums : at_poses) variances.push_back(sums.variance(r, p, errors[p]));
      set_estimate(first_order_index(variances, dependence, conf_level), effects.s1, effects.s1_ci_low,
                   effects.s1_ci_high, r, p);
      const std::array<Estimate, kEffectBins> bins = curve.curve(r, p, conf_level);
      for (std::size_t b = 0; b < bins.size(); ++b) {
        set_estimate(bins[b], effects.mean, effects.ci_low, effects.ci_high, r, p, b);
      }
    }
  }
  return effects;
}

void leave_out_dependent(const Plan& plan, MainEffects& effects) {
  for (std::size_t p = 0; p < plan.factors().size(); ++p) {
    if (plan.is_drawn_alone(p)) continue;
    for (std::size_t r = 0; r < effects.s1.length<axis::Response>(); ++r) leave_out(effects, r, p);
  }
}

void leave_out_per_pose(const Plan& plan, MainEffects& effects) {
  for (const std::size_t p : plan.per_pose()) {
    for (std::size_t r = 0; r < effects.s1.length<axis::Response>(); ++r) leave_out(effects, r, p);
  }
}

void leave_out_curves_per_pose(const Plan& plan, MainEffects& effects) {
  for (const std::size_t p : plan.per_pose()) {
    for (std::size_t r = 0; r < effects.s1.length<axis::Response>(); ++r) leave_out_curve(effects, r, p);
  }
}

void leave_out_constant(std::span<const double> rounding, Result& found) {
  make_room({found.responses()}, found.varies);
  for (std::size_t r = 0; r < found.responses(); ++r) {
    const std::span at_poses = found.std.row(r);
    std::vector<double> at_some;
    for (const std::uint64_t m : found.effects.s1_poses) at_some.push_back(at_poses[m]);
    found.varies(r) = is_constant(at_poses, rounding[r]) ? 0 : 1;
    if (is_constant(at_some, rounding[r])) leave_out(found.effects.effects, r);
    if (!found.machines) continue;
    if (is_constant(found.machines->largest.std.row(r), rounding[r])) leave_out(found.machines->effects_on_largest, r);
  }
  if (std::ranges::find(found.varies, 0) == found.varies.end()) found.varies = {};
}

std::vector<BinSpread> bin_spreads(const Plan& plan) {
  const std::vector<double> grid = bin_spread_grid();
  std::vector<BinSpread> spreads;
  for (const Distribution& distribution : plan.distributions()) {
    std::vector<double> quantiles = grid;
    distribution.transform(quantiles);
    spreads.push_back(bin_spread(quantiles));
  }
  return spreads;
}

EffectResult effect_result(std::span<const PoseIndex> poses, std::span<const BinSpread> errors, double conf_level) {
  EffectResult found;
  found.conf_level = conf_level;
  for (const PoseIndex pose : poses) found.s1_poses.push_back(pose.value);
  make_room({errors.size(), kEffectBins}, found.bin_error);
  for (std::size_t p = 0; p < errors.size(); ++p) {
    std::ranges::copy(errors[p].mean, found.bin_error.row(p).begin());
  }
  return found;
}

YieldVerdict judge_yield(const YieldResult& found, const SolveCounts& solves, double asked) {
  using enum YieldVerdict::Decision;
  YieldVerdict verdict{.decision = not_asked,
                       .asked = asked,
                       .conf_level = found.conf_level,
                       .value = found.value,
                       .ci_low = found.ci_low,
                       .ci_high = found.ci_high,
                       .machines = found.machines,
                       .rejects = found.rejects,
                       .unsolved = found.rejects - found.unsolved_pass_rejects,
                       .solves = solves};
  if (found.parts) verdict.with_parts = Interval{found.parts->ci_low, found.parts->ci_high};
  if (asked == 0.0) return verdict;
  const std::uint64_t good = found.machines - found.rejects;
  verdict.decision = undecided;
  if (proportion_at_least(good, found.machines, found.conf_level) >= asked) verdict.decision = kept;
  if (proportion_at_most(good, found.machines, found.conf_level) < asked) verdict.decision = not_kept;
  return verdict;
}

LimitVerdicts judge_machines(std::span<const ResponseLimit> limits, double asked, const YieldResult& found,
                             const SolveCounts& solves, const MachineCounts& counts,
                             std::span<const QuantileSketch> judged) {
  LimitVerdicts verdicts{.judge = Judge::yield, .limits = {}, .yield = judge_yield(found, solves, asked)};
  const std::uint64_t n = counts.machines;
  for (const ResponseLimit& limit : limits) {
    LimitVerdict verdict{.response = limit.response, .limit = limit.allowed, .value = kNaN, .tried = n};
    verdict.within = n - counts.by_limit(limit.response).strict;
    const std::uint64_t rank = asked == 0.0 ? n : quantile_rank(asked, n);
    const QuantileSketch& values = judged[limit.response];
    // Magnitudes and spreads are not negative, so a larger value is worse.
    const bool is_sorted = limit.allowed.is_plain() || limit.allowed.is_spread();
    if (asked > 0.0) {
      verdict.value = is_sorted && rank <= values.count() ? values.order_statistic(rank)
                                                          : value_at_rank(values, limit.allowed, rank);
    }
    verdict.passed = verdict.within >= rank;
    verdicts.limits.push_back(verdict);
  }
  return verdicts;
}

}  // namespace poesy::monte_carlo
