#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "engine/base/nan.h"
#include "engine/kinds/monte_carlo/result.h"
#include "engine/stats/buckets.h"
#include "engine/stats/moments.h"
#include "engine/stats/quantile_sketch.h"
#include "engine/study/study.h"

namespace poesy::monte_carlo {

/// Computes the numbers of a Monte Carlo result at each pose and over all poses.
class MonteCarloColumns {
 public:
  /// A result with room for the numbers of a study with this analysis; all numbers are 0 until they are set.
  MonteCarloColumns(std::size_t poses, std::size_t responses, const Analysis& analysis);

  Result& result() { return result_; }              ///< The numbers set so far.
  const Result& result() const { return result_; }  ///< The numbers set so far.

  /// Sets the numbers that depend on the moments of a response at a pose.
  void set_moments(std::size_t response, std::size_t pose, const Moments& moments);
  /// Sets the extremes and quantiles of a response at a pose, and share_magnitude for Judge::share. tried: the number
  /// of all samples at the pose, including samples that do not count in statistics (counts() in run/result.h).
  void set_quantiles(std::size_t response, std::size_t pose, const QuantileSketch& sketch, std::uint64_t tried);
  /// Sets the numbers of a response over all poses. independent: the number of independent samples, which is the number
  /// of samples that count in statistics if errors are drawn per pose, and the number of machines if errors are drawn
  /// per machine. With draws per machine, the intervals of quantiles assume that the samples of a machine are equal at
  /// all poses, so they are never too narrow.
  void set_overall(std::size_t response, const Moments& moments, const QuantileSketch& sketch,
                   std::uint64_t independent);

 private:
  /// [quantiles] The ranks of both ends of the interval of each quantile, among this many samples.
  const std::vector<RankInterval>& ranks_of(std::uint64_t samples);

  Options asked_;
  std::vector<ValueLimit> limits_;  ///< [responses] limit of each response
  Result result_;
  MeanIntervals mean_intervals_;
  std::uint64_t ranked_samples_ = 0;  ///< number of samples for which ranks_ was computed
  std::vector<RankInterval> ranks_;   ///< [quantiles] ranks of the ends of each interval
};

/// The quantiles of some samples, with their intervals.
struct QuantilesOf {
  std::vector<double> value;       ///< [quantiles] order statistics; NaN without samples
  std::vector<Interval> interval;  ///< [quantiles] confidence interval of each quantile
  double error = kNaN;  ///< largest possible difference between a number in `value` and the exact order statistic of
                        ///< the samples; NaN without samples

  /// Copies the values and the ends of the intervals into these rows of a result.
  void copy(std::span<double> values, std::span<double> low, std::span<double> high) const;
};

/// The value with this rank, counted from 1, if values are sorted by ValueLimit::badness, which is larger for a worse
/// value. For a limit on magnitudes, the result is a magnitude. If there are fewer values than the rank, the result is
/// beyond every limit: infinite for a limit on magnitudes, otherwise NaN.
double value_at_rank(const QuantileSketch& values, const ValueLimit& limit, std::uint64_t rank);

/// Computes quantiles from a quantile sketch. buckets: the filled buckets of the sketch. levels: [quantiles] the share
/// of the samples below each quantile. ranks: [quantiles] the ranks of both ends of its interval.
QuantilesOf quantiles_of(std::span<const Bucket> buckets, std::span<const double> levels,
                         std::span<const RankInterval> ranks);

/// The number of bins in a histogram.
inline constexpr std::size_t kHistogramBins = 128;

/// Computes the histogram of the samples in the buckets; edges are NaN without samples. Precondition: `counts` has
/// kHistogramBins elements, and `edges` one more.
void fill_histogram(std::span<const Bucket> buckets, std::span<double> edges, std::span<std::uint64_t> counts);

/// Judges the limits of a Monte Carlo study by its result. A limit is kept
/// - for Judge::rms, if the root mean square of the response over the samples of all poses that count in statistics
/// (counts()) is within it;
/// - for Judge::share, if at each pose at least the share `share` of all draws is within it, which follows from the
/// worst share_magnitude over the poses. A draw that does not count in statistics is not within the limit.
///
/// overall: [responses] quantile sketch of the samples of all poses that count. Preconditions: judge is rms or share;
/// found.overall_rms is set, and for Judge::share also found.share_magnitude; no limit is over several poses
/// (ValueLimit::is_over_poses); for Judge::rms, all limits are on magnitudes.
LimitVerdicts judge_draws(std::span<const ResponseLimit> limits, Judge judge, double share, const Result& found,
                          std::span<const QuantileSketch> overall);

}  // namespace poesy::monte_carlo
