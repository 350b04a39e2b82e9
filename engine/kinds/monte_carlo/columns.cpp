#include "engine/kinds/monte_carlo/columns.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "engine/base/contract.h"
#include "engine/base/nan.h"

namespace poesy {
namespace {

/// NaN where nothing counts.
double mean_of(const Moments& moments) { return moments.count() == 0 ? kNaN : moments.mean(); }

/// Ranks among `trials` values as ranks among `count` values, each trial with its share of them.
RankInterval among(const RankInterval& ranks, std::uint64_t trials, std::uint64_t count) {
  if (trials == count || trials == 0) return ranks;
  const double each = static_cast<double>(count) / static_cast<double>(trials);
  const double low = std::floor(static_cast<double>(ranks.low) * each);
  const double high = std::ceil(static_cast<double>(ranks.high) * each);
  return {static_cast<std::uint64_t>(low), ranks.high > trials ? count + 1 : static_cast<std::uint64_t>(high)};
}

/// Samples whose magnitude is within a limit; a bucket that the limit divides counts as its middle lies.
std::uint64_t count_within(const QuantileSketch& samples, double limit) {
  std::uint64_t within = 0;
  for (const Bucket& bucket : samples.buckets()) {
    const double middle = 0.5 * bucket.lower + 0.5 * bucket.upper;
    if (std::abs(middle) <= limit) within += bucket.count;
  }
  return within;
}

/// What the share of the draws stays within at the worst pose, into `value` and `pose`.
void take_worst_pose(const MonteCarloResult& found, LimitVerdict& verdict) {
  const std::span at_poses = std::span(found.share_magnitude).subspan(verdict.response * found.poses, found.poses);
  const auto worst = std::ranges::max_element(at_poses);
  verdict.value = *worst;
  verdict.pose = static_cast<std::size_t>(worst - at_poses.begin());
}

}  // namespace

MonteCarloColumns::MonteCarloColumns(std::size_t poses, std::size_t responses, const Analysis& analysis)
    : asked_(asked_of<MonteCarloOptions>(analysis)), mean_intervals_(analysis.conf_level) {
  result_.responses = responses;
  result_.poses = poses;
  result_.conf_level = analysis.conf_level;
  result_.quantile_relative_error = QuantileSketch::kRelativeError;
  result_.levels = asked_.quantiles;
  const std::size_t cells = responses * poses;
  for (std::vector<double>* values : {&result_.mean, &result_.mean_ci_low, &result_.mean_ci_high, &result_.std,
                                      &result_.min, &result_.max, &result_.rms, &result_.quantile_error}) {
    values->resize(cells);
  }
  if (asked_.judge == Judge::share) result_.share_magnitude.resize(cells);
  result_.count.resize(cells);
  for (std::vector<double>* values : {&result_.quantiles, &result_.quantiles_ci_low, &result_.quantiles_ci_high}) {
    values->resize(cells * result_.levels.size());
  }
  result_.solves.resize(poses);
}

void MonteCarloColumns::set_moments(std::size_t response, std::size_t pose, const Moments& moments) {
  const std::size_t cell = response * result_.poses + pose;
  const Interval interval = mean_intervals_.of(moments);
  result_.mean[cell] = mean_of(moments);
  result_.mean_ci_low[cell] = interval.low;
  result_.mean_ci_high[cell] = interval.high;
  result_.std[cell] = moments.standard_deviation();
  result_.rms[cell] = root_mean_square(moments.mean(), moments.standard_deviation(), moments.count());
  result_.count[cell] = moments.count();
}

const std::vector<RankInterval>& MonteCarloColumns::ranks_of(std::uint64_t samples) {
  if (ranks_.empty() || ranked_samples_ != samples) {
    ranks_.clear();
    for (const double level : result_.levels) {
      ranks_.push_back(quantile_ranks(samples, level, result_.conf_level));
    }
    ranked_samples_ = samples;
  }
  return ranks_;
}

QuantilesOf quantiles_of(std::span<const Bucket> buckets, std::span<const double> levels,
                         std::span<const RankInterval> ranks) {
  QuantilesOf found;
  if (!buckets.empty()) found.error = 0.0;
  for (std::size_t q = 0; q < levels.size(); ++q) {
    found.interval.push_back(quantile_interval(buckets, ranks[q]));
    if (buckets.empty()) {
      found.value.push_back(kNaN);
      continue;
    }
    const std::uint64_t rank = quantile_rank(levels[q], buckets.back().up_to);
    found.value.push_back(order_statistic(buckets, rank));
    found.error = std::max(found.error, order_statistic_error(buckets, rank));
  }
  return found;
}

void MonteCarloColumns::set_quantiles(std::size_t response, std::size_t pose, const QuantileSketch& sketch,
                                      std::uint64_t tried) {
  const std::size_t cell = response * result_.poses + pose;
  const QuantilesOf quantiles = quantiles_of(sketch.buckets(), result_.levels, ranks_of(sketch.count()));
  result_.min[cell] = sketch.min();
  result_.max[cell] = sketch.max();
  for (std::size_t q = 0; q < result_.levels.size(); ++q) {
    const std::size_t at = cell * result_.levels.size() + q;
    result_.quantiles[at] = quantiles.value[q];
    result_.quantiles_ci_low[at] = quantiles.interval[q].low;
    result_.quantiles_ci_high[at] = quantiles.interval[q].high;
  }
  result_.quantile_error[cell] = quantiles.error;
  if (asked_.judge != Judge::share) return;
  const std::uint64_t rank = quantile_rank(asked_.share, tried);
  result_.share_magnitude[cell] =
      rank <= sketch.count() ? sketch.magnitudes().order_statistic(rank) : std::numeric_limits<double>::infinity();
}

void MonteCarloColumns::set_overall(const Moments& moments, const QuantileSketch& sketch, std::uint64_t independent) {
  result_.overall_mean.push_back(mean_of(moments));
  result_.overall_std.push_back(moments.standard_deviation());
  result_.overall_rms.push_back(root_mean_square(moments.mean(), moments.standard_deviation(), moments.count()));
  result_.overall_min.push_back(sketch.min());
  result_.overall_max.push_back(sketch.max());
  result_.overall_count.push_back(moments.count());
  std::vector<RankInterval> ranks;
  for (const RankInterval& one : ranks_of(independent)) ranks.push_back(among(one, independent, sketch.count()));
  const std::vector<Bucket> buckets = sketch.buckets();
  const QuantilesOf quantiles = quantiles_of(buckets, result_.levels, ranks);
  for (std::size_t q = 0; q < result_.levels.size(); ++q) {
    result_.overall_quantiles.push_back(quantiles.value[q]);
    result_.overall_quantiles_ci_low.push_back(quantiles.interval[q].low);
    result_.overall_quantiles_ci_high.push_back(quantiles.interval[q].high);
  }
  result_.overall_quantile_error.push_back(quantiles.error);
  append_histogram(buckets, result_.histogram_edges, result_.histogram_counts);
}

void append_histogram(std::span<const Bucket> buckets, std::vector<double>& edges, std::vector<std::uint64_t>& counts) {
  Histogram bins = buckets.empty() ? Histogram{std::vector<double>(kHistogramBins + 1, kNaN), {}}
                                   : histogram(buckets, kHistogramBins);
  bins.counts.resize(kHistogramBins);
  edges.insert(edges.end(), bins.edges.begin(), bins.edges.end());
  counts.insert(counts.end(), bins.counts.begin(), bins.counts.end());
}

LimitVerdicts judge_draws(std::span<const ResponseLimit> limits, Judge judge, double share,
                          const MonteCarloResult& found, std::span<const QuantileSketch> overall) {
  POESY_EXPECTS(judge != Judge::yield);
  LimitVerdicts verdicts{.judge = judge, .share = share, .limits = {}};
  const std::uint64_t tried = found.total().total();
  for (const ResponseLimit& limit : limits) {
    LimitVerdict verdict{.response = limit.response, .limit = limit.most, .tried = tried};
    verdict.within = count_within(overall[limit.response], limit.most);
    if (judge == Judge::rms) {
      verdict.value = found.overall_rms[limit.response];
    } else {
      take_worst_pose(found, verdict);
    }
    verdict.passed = verdict.value <= limit.most;
    verdicts.limits.push_back(verdict);
  }
  return verdicts;
}

}  // namespace poesy
