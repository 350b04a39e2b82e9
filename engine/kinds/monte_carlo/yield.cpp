#include "engine/kinds/monte_carlo/yield.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "engine/base/nan.h"
#include "engine/kinds/monte_carlo/columns.h"
#include "engine/stats/buckets.h"
#include "engine/stats/indices.h"
#include "engine/stats/proportion.h"

namespace poesy {
namespace {

double share(std::uint64_t part, std::uint64_t all) { return static_cast<double>(part) / static_cast<double>(all); }

void append(const Estimate& estimate, std::vector<double>& value, std::vector<double>& low, std::vector<double>& high) {
  value.push_back(estimate.value);
  low.push_back(estimate.interval.low);
  high.push_back(estimate.interval.high);
}

void append_quantiles(std::span<const Bucket> buckets, std::span<const double> levels, double conf_level,
                      MachineValues& values) {
  std::vector<RankInterval> ranks;
  const std::uint64_t count = buckets.empty() ? 0 : buckets.back().up_to;
  for (const double level : levels) ranks.push_back(quantile_ranks(count, level, conf_level));
  const QuantilesOf found = quantiles_of(buckets, levels, ranks);
  for (std::size_t q = 0; q < levels.size(); ++q) {
    append({found.value[q], found.interval[q]}, values.quantiles, values.quantiles_ci_low, values.quantiles_ci_high);
  }
  values.quantile_error.push_back(found.error);
}

/// At this position of [R x P].
void leave_out(std::size_t at, MainEffects& effects) {
  for (auto* list : {&effects.s1, &effects.s1_ci_low, &effects.s1_ci_high}) (*list)[at] = kNaN;
  for (auto* list : {&effects.mean, &effects.ci_low, &effects.ci_high}) {
    std::ranges::fill(std::span(*list).subspan(at * kEffectBins, kEffectBins), kNaN);
  }
}

}  // namespace

MachineValues machine_values(std::span<const Moments> moments, std::span<const QuantileSketch> sketches,
                             const Analysis& analysis) {
  MachineValues values;
  for (std::size_t r = 0; r < moments.size(); ++r) {
    const bool none = moments[r].count() == 0;
    append({none ? kNaN : moments[r].mean(), mean_interval(moments[r], analysis.conf_level)}, values.mean,
           values.mean_ci_low, values.mean_ci_high);
    values.std.push_back(moments[r].standard_deviation());
    values.min.push_back(sketches[r].min());
    values.max.push_back(sketches[r].max());
    values.count.push_back(moments[r].count());
    const std::vector<Bucket> buckets = sketches[r].buckets();
    append_quantiles(buckets, asked_of<MonteCarloOptions>(analysis).quantiles, analysis.conf_level, values);
    append_histogram(buckets, values.histogram_edges, values.histogram_counts);
  }
  return values;
}

YieldResult yield_of(const MachineCounts& counts, const ScoreSums& scores, std::span<const ResponseLimit> limits,
                     double conf_level) {
  const std::uint64_t n = counts.machines;
  const auto good = [&](std::uint64_t rejects) { return proportion(n - rejects, n, conf_level); };
  const Estimate strict = good(counts.all.strict);
  const Estimate lenient = good(counts.all.lenient);
  const std::size_t responses = counts.by_limit.size();
  const std::size_t poses = counts.at_pose.size() / std::max<std::size_t>(1, responses);
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
  for (std::size_t r = 0; r < responses; ++r) {
    const bool limited = std::ranges::find(limits, r, &ResponseLimit::response) != limits.end();
    append(limited ? good(counts.by_limit[r].strict) : Estimate{kNaN, {kNaN, kNaN}}, found.by_response,
           found.by_response_ci_low, found.by_response_ci_high);
    for (std::size_t m = 0; m < poses; ++m) {
      found.worst_pose_share.push_back(limited ? share(counts.at_pose[r * poses + m].strict, n) : kNaN);
    }
  }
  for (const Estimate& one : scores.gradient(conf_level)) {
    append(one, found.gradient, found.gradient_ci_low, found.gradient_ci_high);
  }
  for (const Estimate& one : scores.change(conf_level)) {
    append(one, found.change, found.change_ci_low, found.change_ci_high);
  }
  return found;
}

PartsYield parts_yield(const PartSums& parts, const YieldResult& found) {
  const Interval interval = parts.interval(found.conf_level);
  if (std::isnan(interval.low)) return {kNaN, kNaN};
  return {std::min(interval.low, found.ci_low), std::max(interval.high, found.ci_high)};
}

MainEffects main_effects(std::span<const MainEffectSums> at_poses, Dependence dependence, const MainEffectSums& curve,
                         std::span<const BinSpread> errors, std::size_t responses, double conf_level) {
  MainEffects effects;
  for (std::size_t r = 0; r < responses; ++r) {
    for (std::size_t p = 0; p < errors.size(); ++p) {
      std::vector<BinnedVariance> variances;
      for (const MainEffectSums& sums : at_poses) variances.push_back(sums.variance(r, p, errors[p]));
      append(first_order_index(variances, dependence, conf_level), effects.s1, effects.s1_ci_low, effects.s1_ci_high);
      for (const Estimate& bin : curve.curve(r, p, conf_level)) {
        append(bin, effects.mean, effects.ci_low, effects.ci_high);
      }
    }
  }
  return effects;
}

void leave_out_correlated(const Plan& plan, MainEffects& effects) {
  const std::size_t errors = plan.factors().size();
  for (std::size_t at = 0; at < effects.s1.size(); ++at) {
    if (plan.is_correlated(at % errors)) leave_out(at, effects);
  }
}

void leave_out_constant(std::span<const double> rounding, MonteCarloResult& found) {
  const auto leave_out_all = [&](std::size_t r, MainEffects& effects) {
    const std::size_t errors = effects.s1.size() / found.responses;
    for (std::size_t p = 0; p < errors; ++p) leave_out(r * errors + p, effects);
  };
  for (std::size_t r = 0; r < found.responses; ++r) {
    const std::span at_poses = std::span(found.std).subspan(r * found.poses, found.poses);
    std::vector<double> at_some;
    for (const std::uint64_t m : found.effects.s1_poses) at_some.push_back(at_poses[m]);
    found.varies.push_back(is_constant(at_poses, rounding[r]) ? 0 : 1);
    if (is_constant(at_some, rounding[r])) leave_out_all(r, found.effects.effects);
    if (!found.machines) continue;
    if (is_constant({&found.machines->largest.std[r], 1}, rounding[r])) {
      leave_out_all(r, found.machines->effects_on_largest);
    }
  }
  if (std::ranges::find(found.varies, 0) == found.varies.end()) found.varies.clear();
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
  for (const BinSpread& spread : errors) {
    found.bin_error.insert(found.bin_error.end(), spread.mean.begin(), spread.mean.end());
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
                             std::span<const QuantileSketch> largest) {
  LimitVerdicts verdicts{.judge = Judge::yield, .limits = {}, .yield = judge_yield(found, solves, asked)};
  const std::uint64_t n = counts.machines;
  for (const ResponseLimit& limit : limits) {
    LimitVerdict verdict{.response = limit.response, .limit = limit.most, .value = kNaN, .tried = n};
    verdict.within = n - counts.by_limit[limit.response].strict;
    const std::uint64_t rank = asked == 0.0 ? n : quantile_rank(asked, n);
    const QuantileSketch& values = largest[limit.response];
    if (asked > 0.0) {
      verdict.value = rank <= values.count() ? values.order_statistic(rank) : std::numeric_limits<double>::infinity();
    }
    verdict.passed = verdict.within >= rank;
    verdicts.limits.push_back(verdict);
  }
  return verdicts;
}

}  // namespace poesy
