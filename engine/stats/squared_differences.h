#pragma once

#include <array>
#include <cstdint>
#include <span>

#include "engine/base/archive.h"
#include "engine/stats/moments.h"

/// Sobol' indices from squared differences of pairs of samples. A and B are two independent samples of all errors, and
/// C is A with the errors of one group taken from B. Then, with V the variance of y,
///
///     E[(y_A - y_B)^2] = 2 V                  A and B have nothing in common
///     E[(y_A - y_C)^2] = 2 V ST               they differ in the group alone (Jansen 1999, Eq. 9)
///     E[(y_B - y_C)^2] = 2 V (1 - S1)         they have the group alone in common (Jansen 1999, Eq. 6)
///
/// so an index is a ratio of two means of the same samples. No mean of y enters, so nothing cancels and no shift is
/// needed; sums over the components of a vector, or over poses at which the same machines are used, give the
/// generalised and the aggregated index without another formula. An error that is absorbed has y_C = y_A in every
/// bit, and both its indices are 0 in every bit.
namespace poesy {

/// The ratio E[x] / E[w] of pairs (x, w): sums for the value and its interval, in one pass and mergeable. w >= 0.
class RatioSums {
 public:
  /// Adds pairs, [B] each; pairs whose flag is 0 are left out and not looked at. counts: [B]
  void add(std::span<const double> x, std::span<const double> w, std::span<const std::uint8_t> counts);
  void add(double x, double w);        ///< One pair.
  void merge(const RatioSums& other);  ///< Both streams together. In the same order it gives the same bits.

  std::uint64_t count() const { return count_; }  ///< Pairs.
  double mean_x() const;                          ///< NaN when empty.
  double mean_w() const;                          ///< NaN when empty.
  /// The ratio; NaN where no pair has a w above zero.
  double value() const;
  /// The ratio with Fieller's interval, by Student's quantile with count - 1 degrees of freedom; [value, value] where
  /// x and w have no scatter about the ratio, NaN at both ends below two pairs or where w may be zero at this level.
  /// Precondition: 0 < conf_level < 1.
  Estimate estimate(double conf_level) const;

  void state(Archive& archive);  ///< Every bit of it.

 private:
  std::uint64_t count_ = 0;
  double x_ = 0.0;
  double w_ = 0.0;
  double xx_ = 0.0;
  double xw_ = 0.0;
  double ww_ = 0.0;
};

}  // namespace poesy
