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
  std::uint64_t count;  ///< values in it
  std::uint64_t up_to;  ///< values in it and in all buckets before it
};

/// Estimates quantiles of a stream of numbers without storing them. Up to kMostExact numbers are kept. More are counted
/// in buckets (BucketScale), on the finest scale on which they are in at most kMostPages pages and span at most
/// kMostPagesSpanned. So buckets are narrow if the numbers are close to each other, wherever they are, and a number far
/// from all others costs one page. More numbers never make the scale finer, and counts are whole numbers, so merging is
/// exact: the result has the same bits for any order of merging and any division of the stream. Memory: 16 kB for the
/// pages and 2 kB for the pages spanned; on the coarsest scale 128 bytes for each page with numbers, and two pages for
/// each factor of two and sign.
class QuantileSketch {
 public:
  /// The largest number of pages of buckets, unless the coarsest scale has more.
  static constexpr std::size_t kMostPages = BucketCounts::kMostPages;
  /// The largest relative error of quantile() as an order statistic; it is also at most half of the bucket
  /// (quantile_error). Numbers below 2^-1022 in magnitude (subnormal) count as zero.
  static constexpr double kRelativeError = BucketScale::kRelativeError;

  void add(std::span<const double> values) {
    add(NumberBlock(values));
  }  ///< Adds values. Precondition: all values are finite.
  void add(const NumberBlock& block) { add(block.values, block.extremes); }  ///< Adds a prepared block.
  void merge(const QuantileSketch& other);  ///< Adds the numbers of another sketch, exactly and in any order.

  std::uint64_t count() const { return extremes_.count; }  ///< The number of values.
  /// The smallest value, exact; NaN when empty.
  double min() const { return count() == 0 ? std::numeric_limits<double>::quiet_NaN() : extremes_.min; }
  /// The largest value, exact; NaN when empty.
  double max() const { return count() == 0 ? std::numeric_limits<double>::quiet_NaN() : extremes_.max; }
  /// The order statistic of the smallest rank k >= 1 with k / n >= q, to within its bucket: the inverse of the
  /// empirical distribution function. NaN when empty. Precondition: 0 <= q <= 1.
  double quantile(double q) const;
  /// The k-th smallest value, to within its bucket. Precondition: 1 <= k <= count().
  double order_statistic(std::uint64_t k) const;
  /// The filled buckets, ascending, cut off at min() and max(). Values that are kept, and those that count as zero,
  /// have buckets of zero width.
  std::vector<Bucket> buckets() const;
  /// A sketch of the values' magnitudes, on a scale that is not finer.
  QuantileSketch magnitudes() const;

  /// Reads or writes every count: up to two bytes for each bucket.
  void state(Archive& archive);

 private:
  bool keeps_all() const { return count() <= kMostExact; }
  void add(std::span<const double> values, const Extremes& extremes);
  /// Changes to coarser scales until all numbers fit.
  void fit();
  /// Changes to coarser scales until there are at most kMostPages pages.
  void save_pages();
  /// [count] The values that are kept, ascending.
  std::vector<double> sorted() const;

  Extremes extremes_;
  std::vector<double> values_;  ///< used while all values are kept
  BucketCounts counts_;         ///< used afterwards
};

}  // namespace poesy
