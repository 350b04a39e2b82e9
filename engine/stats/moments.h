#pragma once

#include <cstdint>
#include <span>

#include "engine/base/bytes.h"

namespace poesy {

/// Count, mean and central moments to fourth order of a stream of numbers, in one pass and mergeable
/// (Welford; Chan et al. 1983; Pebay 2008, Sandia report SAND2008-6212, Eqs. 1.1-1.7, 2.1-2.4).
class Moments {
 public:
  /// The order changes rounding only.
  void add(double value);
  /// The moments of a block of numbers that is in memory: twice over it, faster than adding them one by one.
  static Moments of(std::span<const double> values);
  /// The moments of both streams together. Merging in the same order gives the same bits.
  void merge(const Moments& other);

  /// Values.
  std::uint64_t count() const { return count_; }
  /// 0 when empty.
  double mean() const { return mean_; }
  /// Sample variance, divided by count - 1; NaN below two values.
  double variance() const;
  /// Of the sample (n - 1); NaN with fewer than two values.
  double standard_deviation() const;
  /// Kurtosis m4 / m2^2 of the sample (3 for a normal); NaN when the variance is zero or undefined.
  double kurtosis() const;

  /// Every bit of it, and back.
  void write(ByteWriter& to) const;
  /// Throws BytesError for what no values give.
  static Moments read(ByteReader& from);

 private:
  std::uint64_t count_ = 0;
  double mean_ = 0.0;
  double m2_ = 0.0;  ///< sum of (x - mean)^2
  double m3_ = 0.0;  ///< sum of (x - mean)^3
  double m4_ = 0.0;  ///< sum of (x - mean)^4
};

/// The mean square of `count` values with this mean and sample standard deviation; NaN where that is.
double sample_mean_square(double mean, double standard_deviation, double count);

/// The root mean square of `count` values with this mean and sample standard deviation; NaN without values.
double root_mean_square(double mean, double standard_deviation, std::uint64_t count);

}  // namespace poesy
