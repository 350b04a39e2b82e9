#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "engine/stats/moments.h"
#include "engine/stats/quantile_sketch.h"

/// What the filled buckets of a quantile sketch say.
namespace poesy {

/// The k-th smallest of the values in `buckets`, to within its bucket: the middle of that, and exactly the smallest and
/// the largest of all. Precondition: 1 <= k <= number of values.
double order_statistic(std::span<const Bucket> buckets, std::uint64_t k);

/// What order_statistic() may be off by at most: half the width of the bucket, and nothing for the extremes.
double order_statistic_error(std::span<const Bucket> buckets, std::uint64_t k);

/// Ranks of two of n order statistics, from 1 to n; 0 and n + 1 mean that there is none.
struct RankInterval {
  std::uint64_t low;   ///< of the lower end
  std::uint64_t high;  ///< of the upper end
};

/// The order statistics of n independent draws between which the quantile q of their distribution lies, whatever that
/// is: with a probability of at least conf_level, and of at most (1 - conf_level) / 2 beyond either end (David and
/// Nagaraja 2003, Order Statistics, 7.1). The number of draws below the quantile is binomial. Where n draws are too few
/// for an end, there is none: for an upper end at q = 0.9973 and 95 % it takes 1365 draws.
/// Draws of several groups, of which each has its own share in the distribution, make the number of draws below vary
/// less (Hoeffding 1956), so the interval is then wider than need be.
/// Preconditions: 0 < q < 1, 0 < conf_level < 1.
RankInterval quantile_ranks(std::uint64_t n, double q, double conf_level);

/// The interval between order statistics of a sketch, of which `buckets` are. An end lies at the outer edge of its
/// bucket, so what the sketch rounds away makes the interval wider, never narrower. It is infinite where there is no
/// such order statistic. NaN at both ends without values.
Interval quantile_interval(std::span<const Bucket> buckets, const RankInterval& ranks);

/// Bin k holds the values from edges[k] to edges[k + 1].
struct Histogram {
  std::vector<double> edges;          ///< [B + 1] ascending; the first and the last are the extremes
  std::vector<std::uint64_t> counts;  ///< [B]
};

/// A histogram of exactly `bins` bins of what a sketch holds, of which `buckets` are. All but the first and the last
/// bin, which hold the outermost 0.05 % of the values, are about equally wide. Edges are edges of buckets, so every
/// count is exact; where buckets are wider than bins, fewer bins are filled, and those left over have no width and
/// come last. Precondition: bins >= 3, and there is a bucket.
Histogram histogram(std::span<const Bucket> buckets, std::size_t bins);

}  // namespace poesy
