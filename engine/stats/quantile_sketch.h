#pragma once

#include <cstddef>
#include <cstdint>
#include <limits>
#include <span>
#include <vector>

#include "engine/base/bytes.h"

namespace poesy {

/// The rank of the order statistic of n values that is taken as the quantile q: the smallest k >= 1 with k / n >= q.
/// Precondition: n > 0.
std::uint64_t quantile_rank(double q, std::uint64_t n);

/// A block of numbers as a sketch takes it: all that can be worked out without the sketch.
struct BucketedValues {
  BucketedValues() = default;
  explicit BucketedValues(std::span<const double> values);  ///< Precondition: all values are finite.

  std::vector<std::uint32_t> buckets;  ///< of each number, with the sign above the bits of the bucket
  std::uint32_t lowest = 0;            ///< bucket of the smallest magnitude that is not taken for zero
  std::uint32_t highest = 0;           ///< of the largest
  std::uint32_t negatives = 0;         ///< numbers below zero, and above, that are not taken for zero
  std::uint32_t positives = 0;         ///< those above
  double min = std::numeric_limits<double>::infinity();  ///< of all numbers, infinite when there is none
  /// Likewise.
  double max = -std::numeric_limits<double>::infinity();

  /// As much of it as a sketch takes, in two bytes for each number (four where the magnitudes span 2^128 or more).
  void write(ByteWriter& to) const;
  static BucketedValues read(ByteReader& from);  ///< Throws BytesError for what no numbers give.
};

/// One filled bucket of a sketch.
struct Bucket {
  double lower;         ///< no value of it is below
  double upper;         ///< nor above
  std::uint64_t count;  ///< values in it
  std::uint64_t up_to;  ///< values in it and in those before it
};

/// Quantiles of a stream of numbers without keeping them: a histogram whose buckets are the numbers' own leading bits,
/// which are sign, exponent and the first eight bits of the fraction. Counts are whole numbers, so merging is exact and
/// neither the order of merging nor how the stream was cut into pieces changes a bit.
/// Memory: 2 bytes for each bucket between the smallest and the largest magnitude seen, 256 buckets for each factor of
/// two, for each sign that was seen, and 8 more once a bucket holds 65 536 numbers; at most 5.2 MB a sign, whatever the
/// numbers are.
class QuantileSketch {
 public:
  /// quantile(q) differs from the order statistic it stands for by at most this part of it. Exact for zero, and for the
  /// extremes; numbers below 2^-1022 in magnitude (subnormal) are taken for zero.
  static constexpr double kRelativeError = 0x1p-9;

  void add(std::span<const double> values) { add(BucketedValues(values)); }  ///< Precondition: all values are finite.
  void add(const BucketedValues& values);                                    ///< The same, worked out before.
  void merge(const QuantileSketch& other);                                   ///< Exact, and so in any order.

  std::uint64_t count() const;  ///< Values.
  /// Exact; NaN when empty.
  double min() const { return count() == 0 ? std::numeric_limits<double>::quiet_NaN() : min_; }
  /// Exact; NaN when empty.
  double max() const { return count() == 0 ? std::numeric_limits<double>::quiet_NaN() : max_; }
  /// The order statistic of rank k, the smallest k >= 1 with k / n >= q: the inverse of the empirical distribution
  /// function, rank ceil(q n), to kRelativeError. NaN when empty. Precondition: 0 <= q <= 1.
  double quantile(double q) const;
  /// The k-th smallest value, to kRelativeError. Precondition: 1 <= k <= count().
  double order_statistic(std::uint64_t k) const;
  /// The filled buckets, ascending, cut off at min() and max(). Values taken for zero have a bucket of no width.
  std::vector<Bucket> buckets() const;
  /// A sketch of the values' magnitudes. Where there are values of both signs, its min() is 0.
  QuantileSketch magnitudes() const;

  /// Every count of it, and back: about two bytes for each bucket. read() throws BytesError for counts that no stream
  /// of numbers gives.
  void write(ByteWriter& to) const;
  static QuantileSketch read(ByteReader& from);  ///< The opposite of write().

 private:
  /// Counts of the buckets first, first + 1, ... of one sign; a bucket is numbered by the leading bits of a magnitude.
  struct Store {
    std::size_t first = 0;
    std::uint64_t total = 0;
    std::vector<std::uint16_t> low;    ///< counts modulo 2^16: a study with many poses has thousands of sketches
    std::vector<std::uint64_t> wraps;  ///< how often each went over; empty as long as none did

    std::size_t size() const { return low.size(); }
    std::uint64_t count(std::size_t k) const { return low[k] + (wraps.empty() ? 0 : wraps[k] << 16U); }
    /// Adds to bucket first + k.
    void add(std::size_t k, std::uint64_t count);
    /// The 16 bits of bucket first + k went over.
    void wrap(std::size_t k);
    /// Makes room for the buckets from lowest to highest.
    void reach(std::size_t lowest, std::size_t highest);
    void merge(const Store& other);
    /// The middle of the bucket that holds rank k of the magnitudes, k = 1 for the smallest.
    double magnitude(std::uint64_t k) const;
    void write(ByteWriter& to) const;
    static Store read(ByteReader& from);
  };

  Store negative_;
  Store positive_;
  std::uint64_t zeros_ = 0;
  double min_ = std::numeric_limits<double>::infinity();
  double max_ = -std::numeric_limits<double>::infinity();
};

}  // namespace poesy
