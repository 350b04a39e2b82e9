#include "engine/kinds/monte_carlo/columns.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "engine/base/contract.h"
#include "engine/base/nan.h"

namespace poesy::monte_carlo {
namespace {

/// The mean, or NaN without samples.
double mean_of(const Moments& moments) { return moments.count() == 0 ? kNaN : moments.mean(); }

/// Scales the ranks of both ends of an interval from a list of `trials` values to a list of `count` values, in
/// proportion and rounded outwards.
RankInterval among(const RankInterval& ranks, std::uint64_t trials, std::uint64_t count) {
  if (trials == count || trials == 0) return ranks;
  const double each = static_cast<double>(count) / static_cast<double>(trials);
  const double low = std::floor(static_cast<double>(ranks.low) * each);
  const double high = std::ceil(static_cast<double>(ranks.high) * each);
  return {static_cast<std::uint64_t>(low), ranks.high > trials ? count + 1 : static_cast<std::uint64_t>(high)};
}

/// The number of samples within a limit. Each sample in a bucket of the quantile sketch is taken to have the value in
/// the middle of the bucket.
std::uint64_t count_within(const QuantileSketch& samples, const ValueLimit& limit) {
  std::uint64_t within = 0;
  for (const Bucket& bucket : samples.buckets()) {
    const double middle = 0.5 * bucket.lower + 0.5 * bucket.upper;
    if (limit.holds(middle)) within += bucket.count;
  }
  return within;
}

/// Sets `value` of the verdict to the worst share_magnitude of its response over the poses, and `pose` to the pose with
/// this value.
void take_worst_pose(const Result& found, LimitVerdict& verdict) {
  const std::span at_poses = found.share_magnitude.row(verdict.response);
  const auto worst = std::ranges::max_element(at_poses, {}, [&](double value) { return verdict.limit.badness(value); });
  verdict.value = *worst;
  verdict.pose = static_cast<std::size_t>(worst - at_poses.begin());
}

}  // namespace

MonteCarloColumns::MonteCarloColumns(std::size_t poses, std::size_t responses, const Analysis& analysis)
    : asked_(asked_of<Options>(analysis)),
      limits_(limits_by_response(analysis.limits, responses)),
      mean_intervals_(analysis.conf_level) {
  const std::size_t levels = asked_.quantiles.size();
  result_.conf_level = analysis.conf_level;
  result_.quantile_relative_error = QuantileSketch::kRelativeError;
  result_.levels = asked_.quantiles;
  make_room({responses, poses}, result_.mean, result_.mean_ci_low, result_.mean_ci_high, result_.std, result_.min,
            result_.max, result_.count, result_.rms, result_.quantile_error);
  if (asked_.judge == Judge::share) make_room({responses, poses}, result_.share_magnitude);
  make_room({responses, poses, levels}, result_.quantiles, result_.quantiles_ci_low, result_.quantiles_ci_high);
  make_room({responses}, result_.overall_mean, result_.overall_std, result_.overall_min, result_.overall_max,
            result_.overall_count, result_.overall_rms, result_.overall_quantile_error);
  make_room({responses, levels}, result_.overall_quantiles, result_.overall_quantiles_ci_low,
            result_.overall_quantiles_ci_high);
  make_room({responses, kHistogramBins + 1}, result_.histogram_edges);
  make_room({responses, kHistogramBins}, result_.histogram_counts);
  result_.solves.resize(poses);
}

void MonteCarloColumns::set_moments(std::size_t response, std::size_t pose, const Moments& moments) {
  const Interval interval = mean_intervals_.of(moments);
  result_.mean(response, pose) = mean_of(moments);
  result_.mean_ci_low(response, pose) = interval.low;
  result_.mean_ci_high(response, pose) = interval.high;
  result_.std(response, pose) = moments.standard_deviation();
  result_.rms(response, pose) = root_mean_square(moments.mean(), moments.standard_deviation(), moments.count());
  result_.count(response, pose) = moments.count();
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
  const QuantilesOf quantiles = quantiles_of(sketch.buckets(), result_.levels, ranks_of(sketch.count()));
  result_.min(response, pose) = sketch.min();
  result_.max(response, pose) = sketch.max();
  quantiles.copy(result_.quantiles.row(response, pose), result_.quantiles_ci_low.row(response, pose),
                 result_.quantiles_ci_high.row(response, pose));
  result_.quantile_error(response, pose) = quantiles.error;
  if (asked_.judge != Judge::share) return;
  const std::uint64_t rank = quantile_rank(asked_.share, tried);
  result_.share_magnitude(response, pose) = value_at_rank(sketch, limits_[response], rank);
}

double value_at_rank(const QuantileSketch& values, const ValueLimit& limit, std::uint64_t rank) {
  if (rank > values.count()) return limit.is_magnitude() ? std::numeric_limits<double>::infinity() : kNaN;
  if (limit.is_magnitude()) return values.magnitudes().order_statistic(rank);
  std::vector<std::pair<double, std::uint64_t>> middles;  // middle of each bucket, with the bucket's count
  for (const Bucket& bucket : values.buckets()) {
    middles.emplace_back(0.5 * bucket.lower + 0.5 * bucket.upper, bucket.count);
  }
  std::ranges::stable_sort(middles, {}, [&](const auto& middle) { return limit.badness(middle.first); });
  for (const auto& [value, count] : middles) {
    if (rank <= count) return value;
    rank -= count;
  }
  return kNaN;
}

void MonteCarloColumns::set_overall(std::size_t response, const Moments& moments, const QuantileSketch& sketch,
                                    std::uint64_t independent) {
  result_.overall_mean(response) = mean_of(moments);
  result_.overall_std(response) = moments.standard_deviation();
  result_.overall_rms(response) = root_mean_square(moments.mean(), moments.standard_deviation(), moments.count());
  result_.overall_min(response) = sketch.min();
  result_.overall_max(response) = sketch.max();
  result_.overall_count(response) = moments.count();
  std::vector<RankInterval> ranks;
  for (const RankInterval& one : ranks_of(independent)) ranks.push_back(among(one, independent, sketch.count()));
  const std::vector<Bucket> buckets = sketch.buckets();
  const QuantilesOf quantiles = quantiles_of(buckets, result_.levels, ranks);
  quantiles.copy(result_.overall_quantiles.row(response), result_.overall_quantiles_ci_low.row(response),
                 result_.overall_quantiles_ci_high.row(response));
  result_.overall_quantile_error(response) = quantiles.error;
  fill_histogram(buckets, result_.histogram_edges.row(response), result_.histogram_counts.row(response));
}

void QuantilesOf::copy(std::span<double> values, std::span<double> low, std::span<double> high) const {
  std::ranges::copy(value, values.begin());
  std::ranges::transform(interval, low.begin(), &Interval::low);
  std::ranges::transform(interval, high.begin(), &Interval::high);
}

void fill_histogram(std::span<const Bucket> buckets, std::span<double> edges, std::span<std::uint64_t> counts) {
  std::ranges::fill(edges, kNaN);
  if (buckets.empty()) return;
  const Histogram bins = histogram(buckets, kHistogramBins);
  std::ranges::copy(bins.edges, edges.begin());
  std::ranges::copy(bins.counts, counts.begin());
}

LimitVerdicts judge_draws(std::span<const ResponseLimit> limits, Judge judge, double share, const Result& found,
                          std::span<const QuantileSketch> overall) {
  POESY_EXPECTS(judge != Judge::yield);
  LimitVerdicts verdicts{.judge = judge, .share = share, .limits = {}};
  const std::uint64_t tried = found.total().total();
  for (const ResponseLimit& limit : limits) {
    LimitVerdict verdict{.response = limit.response, .limit = limit.allowed, .tried = tried};
    verdict.within = count_within(overall[limit.response], limit.allowed);
    if (judge == Judge::rms) {
      verdict.value = found.overall_rms(limit.response);
    } else {
      take_worst_pose(found, verdict);
    }
    verdict.passed = limit.allowed.holds(verdict.value);
    verdicts.limits.push_back(verdict);
  }
  return verdicts;
}

}  // namespace poesy::monte_carlo
