#pragma once

#include <array>
#include <cstdint>
#include <span>

#include "engine/base/archive.h"
#include "engine/stats/moments.h"

/// Sobol' indices from squared differences of pairs of samples. A and B are two independent samples of all errors; C is
/// A with the errors of one group taken from B. With the response y, its values y_A, y_B, y_C and its variance V,
///
///     E[(y_A - y_B)^2] = 2 V                  A and B have nothing in common
///     E[(y_A - y_C)^2] = 2 V ST               A and C differ only in the group (Jansen 1999, Eq. 9)
///     E[(y_B - y_C)^2] = 2 V (1 - S1)         B and C have only the group in common (Jansen 1999, Eq. 6)
///
/// So an index is a ratio of two means of the same samples. The mean of y does not enter, so no digits cancel and no
/// shift is needed. Sums over the components of a vector, or over poses with the same machines, give the generalised
/// and the aggregated index without another formula. For an error without effect y_C and y_A have the same bits, so
/// both of its indices are exactly 0.
namespace poesy {

/// Estimates the ratio E[x] / E[w] from pairs (x, w) with w >= 0, with an interval. It needs one pass over the pairs,
/// and the sums of several objects can be merged.
class RatioSums {
 public:
  /// Adds the pairs (x[k], w[k]). counts: 1, or 0 for a pair that is left out.
  void add(std::span<const double> x, std::span<const double> w, std::span<const std::uint8_t> counts);
  void add(double x, double w);  ///< Adds one pair.
  /// Adds the pairs of a later stream. Merging in the same order gives the same bits.
  void merge(const RatioSums& other);

  std::uint64_t count() const { return count_; }  ///< The number of pairs.
  double mean_x() const;                          ///< The mean of x; NaN when empty.
  double mean_w() const;                          ///< The mean of w; NaN when empty.
  /// The ratio mean_x() / mean_w(); NaN if no w is above zero.
  double value() const;
  /// The ratio with Fieller's interval, by Student's quantile with count - 1 degrees of freedom. The interval is
  /// [value, value] if x and w do not scatter about the ratio; NaN at both ends below two pairs, or if the mean of w
  /// may be zero at this level. Precondition: 0 < conf_level < 1.
  Estimate estimate(double conf_level) const;

  void state(Archive& archive);  ///< Reads or writes all sums, bit for bit.

 private:
  std::uint64_t count_ = 0;
  double x_ = 0.0;
  double w_ = 0.0;
  double xx_ = 0.0;
  double xw_ = 0.0;
  double ww_ = 0.0;
};

}  // namespace poesy
