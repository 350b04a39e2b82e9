#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "engine/stats/moments.h"
#include "engine/stats/quantile_sketch.h"

/// Order statistics and histograms from the filled buckets of a quantile sketch.
namespace poesy {

/// The k-th smallest of the values in `buckets`, approximated by the middle of its bucket. The smallest and the largest
/// value are exact. Precondition: 1 <= k <= number of values.
double order_statistic(std::span<const Bucket> buckets, std::uint64_t k);

/// The largest error of order_statistic(): half the width of the bucket, and zero for the extremes.
double order_statistic_error(std::span<const Bucket> buckets, std::uint64_t k);

/// The ranks of the order statistics at the two ends of an interval, from 1 to n for n values. At an end without an
/// order statistic the rank is 0 or n + 1.
struct RankInterval {
  std::uint64_t low;   ///< rank of the lower end
  std::uint64_t high;  ///< rank of the upper end
};

/// The ranks of the order statistics of n independent draws that enclose the quantile q of any distribution with a
/// probability of at least conf_level. The probability that the quantile is beyond an end is at most (1 - conf_level) /
/// 2 for either end (David and Nagaraja 2003, Order Statistics, 7.1), because the number of draws below the quantile is
/// binomial. With too few draws an end has no order statistic: an upper end at q = 0.9973 and 95 % needs 1365 draws. If
/// the draws are stratified (each group of a mixture has its share of them), the number of draws below the quantile
/// varies less (Hoeffding 1956), so the interval is wider than necessary. Preconditions: 0 < q < 1, 0 < conf_level < 1.
RankInterval quantile_ranks(std::uint64_t n, double q, double conf_level);

/// The interval between the order statistics with these ranks. Each end is at the outer edge of the bucket of its order
/// statistic, so the buckets can only make the interval wider. An end without an order statistic is infinite. Without
/// values, both ends are NaN.
Interval quantile_interval(std::span<const Bucket> buckets, const RankInterval& ranks);

/// A histogram. Bin k has the values from edges[k] to edges[k + 1].
struct Histogram {
  std::vector<double> edges;          ///< [bins + 1] ascending; the first and the last are the extremes
  std::vector<std::uint64_t> counts;  ///< [bins] number of values in each bin
};

/// A histogram of the values in these buckets, with exactly `bins` bins. The first and the last bin have the outermost
/// 0.05 % of the values each; the others are about equally wide. Edges of bins are edges of buckets, so every count is
/// exact. If buckets are wider than bins, some bins remain empty; they come last and have no width. Preconditions: bins
/// >= 3; there is a bucket.
Histogram histogram(std::span<const Bucket> buckets, std::size_t bins);

}  // namespace poesy
