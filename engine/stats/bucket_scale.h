#pragma once

#include <cstddef>
#include <cstdint>
#include <limits>
#include <span>
#include <vector>

#include "engine/base/archive.h"

/// Which numbers a quantile sketch counts together.
namespace poesy {

/// The most numbers that a quantile sketch keeps as they are.
inline constexpr std::size_t kMostExact = 256;

/// What a quantile sketch knows exactly of any number of values. Numbers below 2^-1022 in magnitude (subnormal) are
/// taken for zero, except in `min` and `max`.
struct Extremes {
  std::uint64_t count = 0;                                       ///< values
  double min = std::numeric_limits<double>::infinity();          ///< the smallest; infinite without values
  double max = -std::numeric_limits<double>::infinity();         ///< the largest; likewise
  double least_above = std::numeric_limits<double>::infinity();  ///< the smallest above zero; infinite without one
  double least_below = std::numeric_limits<double>::infinity();  ///< the smallest magnitude below zero; likewise

  static Extremes of(std::span<const double> values);  ///< Precondition: all values are finite.
  void merge(const Extremes& other);                   ///< Exact, and so in any order.

  bool has_above() const { return least_above <= max; }   ///< Whether there is a number above zero.
  bool has_below() const { return least_below <= -min; }  ///< Whether there is one below.

  /// All but the count. Throws BytesError for what no `count` numbers have.
  void state(Archive& archive);
};

/// Consecutive buckets of one sign are counted in pages of this many.
inline constexpr std::size_t kPageBuckets = 64;
/// The pages between the smallest and the largest magnitude of both signs that a scale may have.
inline constexpr std::size_t kMostPagesSpanned = 1023;

/// Cuts the magnitudes of one sign into buckets, which are numbered from zero on. From 2^(octave - 1023) on all buckets
/// have the same width, 2^-8 of that number. Below, a bucket has 2^-7 of its power of two. So each bucket of a scale
/// lies in one bucket of any coarser scale, whose octave is larger.
class BucketScale {
 public:
  static constexpr unsigned kCoarsest = 2047;  ///< the octave of the scale without buckets of the same width
  /// Values that the middle of a bucket is off by at most, as a part of them, on any scale.
  static constexpr double kRelativeError = 0x1p-8;
  static constexpr std::uint64_t kSign = std::uint64_t{1} << 63U;  ///< bit of a key() of a number below zero
  static constexpr std::uint64_t kFirstNormal = 128;               ///< numbers in buckets below count as zero

  /// Precondition: 1 <= octave <= kCoarsest.
  explicit BucketScale(unsigned octave = 1) : octave_(octave) {}

  unsigned octave() const { return octave_; }                               ///< Biased exponent, as doubles have it.
  bool is_coarsest() const { return octave_ == kCoarsest; }                 ///< Whether none is coarser.
  BucketScale coarser() const { return BucketScale(octave_ + 1); }          ///< The next one, of twice the width.
  bool operator==(const BucketScale& other) const = default;                ///< Whether all buckets are the same.
  std::uint64_t first_even() const { return std::uint64_t{octave_} << 7; }  ///< The first bucket of the same width.
  /// The page of the next coarser scale in which a page lies.
  std::uint64_t page_of_coarser(std::uint64_t page) const;

  /// The bucket of each number, with kSign for those below zero. Precondition: the octave is not more than 44 below the
  /// biased exponent of any of them.
  void keys(std::span<const double> values, std::span<std::uint64_t> keys) const;
  std::uint64_t key(double value) const;    ///< The same for one number.
  double edge(std::uint64_t bucket) const;  ///< The smallest magnitude in a bucket, where the one before it ends.

 private:
  unsigned octave_;
};

/// The pages of one sign between the smallest and the largest magnitude.
struct PageRange {
  std::uint64_t first = 0;  ///< number of the page: of its buckets, divided by kPageBuckets
  std::size_t count = 0;    ///< none where there is no number of this sign
};

/// The pages above zero, or below.
PageRange pages_spanned(const Extremes& extremes, const BucketScale& scale, bool below);

/// Whether both signs together span no more than kMostPagesSpanned pages, and keys() takes such numbers. A scale that
/// does not fit some numbers fits no more numbers either, and one that fits has only coarser ones that fit.
bool fits(const BucketScale& scale, const Extremes& extremes);
/// The finest scale that fits; the coarsest if there is none.
BucketScale finest_fitting(const Extremes& extremes);

}  // namespace poesy
