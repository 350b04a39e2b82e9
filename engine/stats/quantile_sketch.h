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

/// The rank of the order statistic of n values that is used as the quantile q: the smallest k >= 1 with k / n >= q.
/// Precondition: n > 0.
std::uint64_t quantile_rank(double q, std::uint64_t n);

/// One filled bucket of a sketch.
struct Bucket {
  double lower;         ///< smallest possible value
  double upper;         ///< largest possible value
  std::uint64_t count;  ///< number of values in the bucket
  std::uint64_t up_to;  ///< number of values in the bucket and all buckets before it
};

/// Estimates quantiles of a stream of numbers without storing them. Up to kMostExact numbers are kept. More numbers are
/// counted in buckets (BucketScale) instead. Buckets are stored in pages of kPageBuckets buckets. The scale of the
/// buckets is the finest one on which the numbers are in at most kMostPages pages, and at most kMostPagesSpanned pages
/// are between the smallest and the largest number. So buckets are narrow if the numbers are close to each other,
/// whatever their mean, and a number far from all others costs one page. Merging is exact, because more numbers never
/// make the scale finer, and counts are whole numbers: the result has the same bits for any order of merging and any
/// division of the stream. Memory: 16 kB for the pages with numbers, and 2 kB for the list of all pages between the
/// smallest and the largest number. The coarsest scale has no such bound: it has two pages of 128 bytes for each power
/// of two and sign.
class QuantileSketch {
 public:
  /// The largest number of pages with numbers, unless even the coarsest scale needs more.
  static constexpr std::size_t kMostPages = BucketCounts::kMostPages;
  /// The largest relative error of quantile() as an order statistic. The error is also at most half of the bucket's
  /// width (order_statistic_error()). Numbers below 2^-1022 in magnitude (subnormal) count as zero.
  static constexpr double kRelativeError = BucketScale::kRelativeError;

  /// Adds values. Precondition: all values are finite.
  void add(std::span<const double> values) { add(NumberBlock(values)); }
  void add(const NumberBlock& block) { add(block.values, block.extremes); }  ///< Adds a prepared block.
  void merge(const QuantileSketch& other);  ///< Adds the numbers of another sketch, exactly and in any order.

  std::uint64_t count() const { return extremes_.count; }  ///< The number of values.
  /// The smallest value, exact; NaN when empty.
  double min() const { return count() == 0 ? std::numeric_limits<double>::quiet_NaN() : extremes_.min; }
  /// The largest value, exact; NaN when empty.
  double max() const { return count() == 0 ? std::numeric_limits<double>::quiet_NaN() : extremes_.max; }
  /// The quantile q: the inverse of the empirical distribution function, to within a bucket. It is the order statistic
  /// of rank quantile_rank(q, count()). NaN when empty. Precondition: 0 <= q <= 1.
  double quantile(double q) const;
  /// The k-th smallest value, to within its bucket. Precondition: 1 <= k <= count().
  double order_statistic(std::uint64_t k) const;
  /// The filled buckets, ascending, cut off at min() and max(). Values that are kept, and those that count as zero,
  /// have buckets of zero width.
  std::vector<Bucket> buckets() const;
  /// A sketch of the magnitudes of the values, on the same scale or a coarser one.
  QuantileSketch magnitudes() const;

  /// Reads or writes the values that are kept, or the counts of all buckets.
  void state(Archive& archive);

 private:
  bool keeps_all() const { return count() <= kMostExact; }
  void add(std::span<const double> values, const Extremes& extremes);
  /// Changes to coarser scales until fits() accepts all numbers, and makes room for them.
  void fit();
  /// Changes to coarser scales until there are at most kMostPages pages.
  void save_pages();
  /// [count] The values that are kept, ascending.
  std::vector<double> sorted() const;

  Extremes extremes_;
  std::vector<double> values_;  ///< values, while there are at most kMostExact
  BucketCounts counts_;         ///< counts of the values in buckets, once there are more than kMostExact
};

}  // namespace poesy
