#pragma once

#include <cstddef>
#include <cstdint>
#include <limits>
#include <span>
#include <vector>

#include "engine/base/archive.h"
#include "engine/stats/bucket_counts.h"
#include "engine/stats/bucket_scale.h"
#include "engine/stats/number_block.h"

namespace poesy {

/// The rank of the order statistic of n values that is taken as the quantile q: the smallest k >= 1 with k / n >= q.
/// Precondition: n > 0.
std::uint64_t quantile_rank(double q, std::uint64_t n);

/// One filled bucket of a sketch.
struct Bucket {
  double lower;         ///< no value of it is below
  double upper;         ///< nor above
  std::uint64_t count;  ///< values in it
  std::uint64_t up_to;  ///< values in it and in those before it
};

/// Quantiles of a stream of numbers without keeping them. Up to kMostExact numbers are kept; more of them are counted
/// in buckets (BucketScale), on the finest scale on which numbers lie in no more than kMostPages pages and span no more
/// than kMostPagesSpanned. So buckets are as narrow as the numbers lie close to each other, wherever they lie, and a
/// number far away from all others costs one page. More numbers never make that scale finer, and counts are whole
/// numbers: merging is exact, and neither the order of merging nor how the stream was cut into pieces changes a bit.
/// Memory: 16 kB for the pages and 2 kB for the pages spanned; on the coarsest scale 128 bytes for each page in which
/// numbers lie, of two for each factor of two and sign.
class QuantileSketch {
 public:
  /// The most pages of buckets, unless the coarsest scale has more.
  static constexpr std::size_t kMostPages = BucketCounts::kMostPages;
  /// quantile(q) differs from the order statistic that it is taken for by at most this part of it, and by at most half
  /// of its bucket (quantile_error). Numbers below 2^-1022 in magnitude (subnormal) are taken for zero.
  static constexpr double kRelativeError = BucketScale::kRelativeError;

  void add(std::span<const double> values) { add(NumberBlock(values)); }     ///< Precondition: all values are finite.
  void add(const NumberBlock& block) { add(block.values, block.extremes); }  ///< The same, worked out before.
  void merge(const QuantileSketch& other);                                   ///< Exact, and so in any order.

  std::uint64_t count() const { return extremes_.count; }  ///< Values.
  /// Exact; NaN when empty.
  double min() const { return count() == 0 ? std::numeric_limits<double>::quiet_NaN() : extremes_.min; }
  /// Exact; NaN when empty.
  double max() const { return count() == 0 ? std::numeric_limits<double>::quiet_NaN() : extremes_.max; }
  /// The order statistic of rank k, the smallest k >= 1 with k / n >= q: the inverse of the empirical distribution
  /// function, rank ceil(q n), to within its bucket. NaN when empty. Precondition: 0 <= q <= 1.
  double quantile(double q) const;
  /// The k-th smallest value, to within its bucket. Precondition: 1 <= k <= count().
  double order_statistic(std::uint64_t k) const;
  /// The filled buckets, ascending, cut off at min() and max(). Values that are kept, and those taken for zero, have
  /// buckets of no width.
  std::vector<Bucket> buckets() const;
  /// A sketch of the values' magnitudes, on a scale that is not finer.
  QuantileSketch magnitudes() const;

  /// Every count of it: up to two bytes for each bucket.
  void state(Archive& archive);

 private:
  bool keeps_all() const { return count() <= kMostExact; }
  void add(std::span<const double> values, const Extremes& extremes);
  /// Takes coarser scales until all numbers fit.
  void fit();
  /// Takes coarser scales until there are no more than kMostPages pages.
  void save_pages();
  /// [count] those that are kept, ascending.
  std::vector<double> sorted() const;

  Extremes extremes_;
  std::vector<double> values_;  ///< as long as all are kept
  BucketCounts counts_;         ///< afterwards
};

}  // namespace poesy
