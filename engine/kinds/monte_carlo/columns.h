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

/// The numbers of a Monte Carlo result that follow from the samples at one pose, and of all poses together.
class MonteCarloColumns {
 public:
  /// Of a study with this analysis; nothing is set.
  MonteCarloColumns(std::size_t poses, std::size_t responses, const Analysis& analysis);

  MonteCarloResult& result() { return result_; }              ///< With what was set.
  const MonteCarloResult& result() const { return result_; }  ///< Likewise.

  /// Sets what follows from the moments of a response at a pose.
  void set_moments(std::size_t response, std::size_t pose, const Moments& moments);
  /// Sets what follows from their sketch. tried: all samples, among them those that do not count.
  void set_quantiles(std::size_t response, std::size_t pose, const QuantileSketch& sketch, std::uint64_t tried);
  /// Sets what follows from the samples of all poses together. independent: how many of them are independent of each
  /// other: all, or the machines that were used at all poses. Quantiles then have the interval for samples that say
  /// nothing new at another pose, which is never too narrow.
  void set_overall(std::size_t response, const Moments& moments, const QuantileSketch& sketch,
                   std::uint64_t independent);

 private:
  /// The ranks for quantile intervals of so many samples, one for each quantile.
  const std::vector<RankInterval>& ranks_of(std::uint64_t samples);

  MonteCarloOptions asked_;
  MonteCarloResult result_;
  MeanIntervals mean_intervals_;
  std::uint64_t ranked_samples_ = 0;  ///< number of samples of which ranks_ are
  std::vector<RankInterval> ranks_;   ///< of each quantile
};

/// The quantiles of some samples as a result has them.
struct QuantilesOf {
  std::vector<double> value;       ///< NaN without samples
  std::vector<Interval> interval;  ///< of each value
  double error = kNaN;             ///< what no value is off by more than from its order statistic; NaN without samples

  /// Copies them into the rows of a result.
  void copy(std::span<double> values, std::span<double> low, std::span<double> high) const;
};

/// buckets: of the samples. levels: of the quantiles. ranks: of their intervals.
QuantilesOf quantiles_of(std::span<const Bucket> buckets, std::span<const double> levels,
                         std::span<const RankInterval> ranks);

/// Bins of the histograms of a result.
inline constexpr std::size_t kHistogramBins = 128;

/// Fills in the histogram of what lies in the buckets; NaN edges where there are none. Precondition: kHistogramBins
/// counts, and one edge more.
void fill_histogram(std::span<const Bucket> buckets, std::span<double> edges, std::span<std::uint64_t> counts);

/// Judges the limits of a Monte Carlo study by what it found. A limit is kept
/// - by Judge::rms, if the response's root mean square over the samples of all poses that count is within it;
/// - by Judge::share, if at every pose at least that share of all draws is within it: if the largest of the poses'
///   share_magnitude is. Draws that do not count are not within it.
/// overall: of each response the samples of all poses that count.
/// Preconditions: found.overall_rms is there, and found.share_magnitude where it is needed; judge is no other one.
LimitVerdicts judge_draws(std::span<const ResponseLimit> limits, Judge judge, double share,
                          const MonteCarloResult& found, std::span<const QuantileSketch> overall);

}  // namespace poesy
