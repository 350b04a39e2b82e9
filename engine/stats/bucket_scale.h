#pragma once

#include <cstddef>
#include <cstdint>
#include <limits>
#include <span>
#include <vector>

#include "engine/base/archive.h"

/// The buckets in which a quantile sketch counts values.
namespace poesy {

/// The largest number of values that a quantile sketch keeps unchanged.
inline constexpr std::size_t kMostExact = 256;

/// The extreme values of a quantile sketch. They are exact for any number of values. Values below 2^-1022 in magnitude
/// (subnormal) count as zero, except in `min` and `max`.
struct Extremes {
  std::uint64_t count = 0;                                       ///< number of values
  double min = std::numeric_limits<double>::infinity();          ///< smallest value; infinite without values
  double max = -std::numeric_limits<double>::infinity();         ///< largest value; minus infinity without values
  double least_above = std::numeric_limits<double>::infinity();  ///< smallest value above zero; infinite without one
  /// Smallest magnitude of the values below zero; infinite without one.
  double least_below = std::numeric_limits<double>::infinity();

  /// The extremes of these values. Precondition: all values are finite.
  static Extremes of(std::span<const double> values);
  void merge(const Extremes& other);  ///< Adds other extremes, exactly and in any order.

  bool has_above() const { return least_above <= max; }   ///< Returns true if there is a value above zero.
  bool has_below() const { return least_below <= -min; }  ///< Returns true if there is a value below zero.

  /// Reads or writes all members except `count`. Throws BytesError for extremes that `count` values cannot have.
  void state(Archive& archive);
};

/// The number of buckets in a page. A page is a block of consecutive buckets of one sign; counts are stored page by
/// page.
inline constexpr std::size_t kPageBuckets = 64;
/// The largest number of pages that a scale may span, of both signs together.
inline constexpr std::size_t kMostPagesSpanned = 1023;

/// Divides the magnitudes of one sign into buckets, numbered from zero. The parameter `octave` is the biased exponent
/// of a double. Below 2^(octave - 1023), each range from a power of two to the next is divided into 2^7 buckets of
/// equal width. From 2^(octave - 1023) on, all buckets have the width 2^(octave - 1031). A coarser scale has a larger
/// octave, and each bucket is inside one bucket of any coarser scale.
class BucketScale {
 public:
  static constexpr unsigned kCoarsest = 2047;  ///< octave of the scale on which widths grow up to the largest double
  /// The largest relative distance of a value from the middle of its bucket, on any scale.
  static constexpr double kRelativeError = 0x1p-8;
  /// The bit that is 1 in the key() of a value below zero.
  static constexpr std::uint64_t kSign = std::uint64_t{1} << 63U;
  static constexpr std::uint64_t kFirstNormal = 128;  ///< values in lower buckets count as zero

  /// Precondition: 1 <= octave <= kCoarsest.
  explicit BucketScale(unsigned octave = 1) : octave_(octave) {}

  /// The biased exponent of the doubles from which on all buckets have the same width.
  unsigned octave() const { return octave_; }
  bool is_coarsest() const { return octave_ == kCoarsest; }         ///< Returns true if there is no coarser scale.
  BucketScale coarser() const { return BucketScale(octave_ + 1); }  ///< The next coarser scale, with twice the width.
  bool operator==(const BucketScale& other) const = default;  ///< Returns true if both scales have the same buckets.
  /// The first of the buckets that have equal widths.
  std::uint64_t first_even() const { return std::uint64_t{octave_} << 7; }
  /// The page of the next coarser scale that contains this page of the present scale.
  std::uint64_t page_of_coarser(std::uint64_t page) const;

  /// The index of the bucket of each value, plus kSign if the value is below zero. Precondition: the biased exponent of
  /// each value is at most the octave plus 44.
  void keys(std::span<const double> values, std::span<std::uint64_t> keys) const;
  std::uint64_t key(double value) const;    ///< The bucket of one value, as keys() gives it.
  double edge(std::uint64_t bucket) const;  ///< The smallest magnitude in this bucket.

 private:
  unsigned octave_;
};

/// The pages (blocks of kPageBuckets buckets) that values of one sign need: from the page of the smallest magnitude to
/// the page of the largest.
struct PageRange {
  std::uint64_t first = 0;  ///< index of the first page: the index of its first bucket divided by kPageBuckets
  std::size_t count = 0;    ///< number of pages; 0 without values of this sign
};

/// The pages that the values above zero need. If `below` is true: the pages that the values below zero need.
PageRange pages_spanned(const Extremes& extremes, const BucketScale& scale, bool below);

/// Returns true if a scale can be used for values with these extremes: both signs together span at most
/// kMostPagesSpanned pages, and keys() accepts the values. If a scale fits, all coarser scales fit. A scale that does
/// not fit still does not fit after more values are added.
bool fits(const BucketScale& scale, const Extremes& extremes);
/// The finest scale that fits values with these extremes; the coarsest scale if none fits.
BucketScale finest_fitting(const Extremes& extremes);

}  // namespace poesy
