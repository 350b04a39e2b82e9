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

/// What a quantile sketch knows exactly, whatever the number of values. Values below 2^-1022 in magnitude (subnormal)
/// count as zero, except in `min` and `max`.
struct Extremes {
  std::uint64_t count = 0;                                       ///< number of values
  double min = std::numeric_limits<double>::infinity();          ///< the smallest; infinite without values
  double max = -std::numeric_limits<double>::infinity();         ///< the largest; minus infinity without values
  double least_above = std::numeric_limits<double>::infinity();  ///< the smallest above zero; infinite without one
  double least_below =
      std::numeric_limits<double>::infinity();  ///< the smallest magnitude below zero; infinite without one

  static Extremes of(
      std::span<const double> values);  ///< The extremes of these values. Precondition: all values are finite.
  void merge(const Extremes& other);    ///< Adds other extremes, exactly and in any order.

  bool has_above() const { return least_above <= max; }   ///< Whether there is a value above zero.
  bool has_below() const { return least_below <= -min; }  ///< Whether there is a value below zero.

  /// Reads or writes all but the count. Throws BytesError for extremes that `count` values cannot have.
  void state(Archive& archive);
};

/// The number of consecutive buckets of one sign in a page.
inline constexpr std::size_t kPageBuckets = 64;
/// The largest number of pages that a scale may span, of both signs together.
inline constexpr std::size_t kMostPagesSpanned = 1023;

/// Divides the magnitudes of one sign into buckets, numbered from zero. From 2^(octave - 1023) on, all buckets have the
/// same width, 2^-8 of that number. Below, the width is 2^-7 of the power of two. So each bucket lies in one bucket of
/// any coarser scale, which has a larger octave.
class BucketScale {
 public:
  static constexpr unsigned kCoarsest = 2047;  ///< the octave of the scale without buckets of equal width
  /// The largest relative distance of a value from the middle of its bucket, on any scale.
  static constexpr double kRelativeError = 0x1p-8;
  static constexpr std::uint64_t kSign = std::uint64_t{1} << 63U;  ///< bit of a key() of a value below zero
  static constexpr std::uint64_t kFirstNormal = 128;               ///< values in lower buckets count as zero

  /// Precondition: 1 <= octave <= kCoarsest.
  explicit BucketScale(unsigned octave = 1) : octave_(octave) {}

  unsigned octave() const { return octave_; }                       ///< The octave, as a biased exponent of a double.
  bool is_coarsest() const { return octave_ == kCoarsest; }         ///< Whether there is no coarser scale.
  BucketScale coarser() const { return BucketScale(octave_ + 1); }  ///< The next coarser scale, with twice the width.
  bool operator==(const BucketScale& other) const = default;        ///< Whether all buckets are equal.
  std::uint64_t first_even() const { return std::uint64_t{octave_} << 7; }  ///< The first bucket of the equal width.
  /// The page of the next coarser scale that contains a page.
  std::uint64_t page_of_coarser(std::uint64_t page) const;

  /// The bucket of each value, with kSign if it is below zero. Precondition: the octave is at most 44 below the biased
  /// exponent of each of them.
  void keys(std::span<const double> values, std::span<std::uint64_t> keys) const;
  std::uint64_t key(double value) const;    ///< The same for one number.
  double edge(std::uint64_t bucket) const;  ///< The smallest magnitude in a bucket.

 private:
  unsigned octave_;
};

/// The pages of one sign between the smallest and the largest magnitude.
struct PageRange {
  std::uint64_t first = 0;  ///< number of the first bucket divided by kPageBuckets
  std::size_t count = 0;    ///< number of pages; 0 without values of this sign
};

/// The pages above zero, or below zero.
PageRange pages_spanned(const Extremes& extremes, const BucketScale& scale, bool below);

/// Whether both signs together span at most kMostPagesSpanned pages, and keys() accepts values with these extremes. A
/// scale that does not fit some values does not fit more values either; if a scale fits, all coarser ones do.
bool fits(const BucketScale& scale, const Extremes& extremes);
/// The finest scale that fits; the coarsest one if none does.
BucketScale finest_fitting(const Extremes& extremes);

}  // namespace poesy
