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

namespace poesy {

/// Computes the numbers of a Monte Carlo result from the samples at each pose and at all poses together.
class MonteCarloColumns {
 public:
  /// Starts a result of a study with this analysis; no numbers are set.
  MonteCarloColumns(std::size_t poses, std::size_t responses, const Analysis& analysis);

  MonteCarloResult& result() { return result_; }              ///< The numbers set so far.
  const MonteCarloResult& result() const { return result_; }  ///< The numbers set so far.

  /// Sets the numbers that depend on the moments of a response at a pose.
  void set_moments(std::size_t response, std::size_t pose, const Moments& moments);
  /// Sets the numbers that depend on a response's sketch at a pose. tried: all samples, including those that do not
  /// count.
  void set_quantiles(std::size_t response, std::size_t pose, const QuantileSketch& sketch, std::uint64_t tried);
  /// Sets the numbers of all poses together. independent: the number of independent samples, which is all of them, or
  /// the machines if they were used at all poses. Quantiles then have the interval for samples that repeat at every
  /// pose, which is never too narrow.
  void set_overall(std::size_t response, const Moments& moments, const QuantileSketch& sketch,
                   std::uint64_t independent);

 private:
  /// The ranks of the ends of quantile intervals, one for each quantile, from this many samples.
  const std::vector<RankInterval>& ranks_of(std::uint64_t samples);

  MonteCarloOptions asked_;
  std::vector<ValueLimit> limits_;  ///< [R]
  MonteCarloResult result_;
  MeanIntervals mean_intervals_;
  std::uint64_t ranked_samples_ = 0;  ///< number of samples for which ranks_ was computed
  std::vector<RankInterval> ranks_;   ///< [quantiles]
};

/// The quantiles of some samples, as a result states them.
struct QuantilesOf {
  std::vector<double> value;       ///< NaN without samples
  std::vector<Interval> interval;  ///< of each value
  double error = kNaN;  ///< bound on the difference between a value and its order statistic; NaN without samples

  /// Copies values and intervals into the rows of a result.
  void copy(std::span<double> values, std::span<double> low, std::span<double> high) const;
};

/// The value of the given rank, from 1, when values are sorted by ValueLimit::badness; a magnitude, if the limit is on
/// magnitudes. Beyond every limit with fewer values: infinite, or NaN if the limit is not on magnitudes.
double value_at_rank(const QuantileSketch& values, const ValueLimit& limit, std::uint64_t rank);

/// Computes quantiles. buckets: the samples; levels: the quantiles; ranks: those of the intervals' ends.
QuantilesOf quantiles_of(std::span<const Bucket> buckets, std::span<const double> levels,
                         std::span<const RankInterval> ranks);

/// The number of bins of a histogram.
inline constexpr std::size_t kHistogramBins = 128;

/// Fills in the histogram of the samples in the buckets; NaN edges if there are none. Precondition: there is room for
/// kHistogramBins counts, and for one edge more.
void fill_histogram(std::span<const Bucket> buckets, std::span<double> edges, std::span<std::uint64_t> counts);

/// Judges the limits of a Monte Carlo study by its result. A limit is kept
/// - by Judge::rms, if the response's root mean square over the samples of all poses that count is within it;
/// - by Judge::share, if at every pose at least that share of all draws is within it: if the worst of the poses'
///   share_magnitude is. Draws that do not count are not within it.
/// overall: [R] the samples of all poses that count. Preconditions: found.overall_rms is set; found.share_magnitude is
/// set for Judge::share; judge is rms or share; by rms all limits are on magnitudes, and none is over poses.
LimitVerdicts judge_draws(std::span<const ResponseLimit> limits, Judge judge, double share,
                          const MonteCarloResult& found, std::span<const QuantileSketch> overall);

}  // namespace poesy
