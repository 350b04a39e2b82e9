#pragma once

#include <cstddef>
#include <span>
#include <vector>

namespace poesy {

/// How a further part may be, after n parts were measured: each value is as likely as any other, and is spread evenly
/// over v +- w, with a half-width w of its own. Mean and standard deviation are those of the parts, the latter with
/// n - 1: the values alone have the variance (n - 1)/n s^2, and what they are spread by makes up the missing s^2/n.
///
/// w is in proportion to the distance of the value from its k-th nearest other one, k = ceil(sqrt(n)) (Breiman, Meisel
/// and Purcell 1977, Technometrics 19, 135-144), so values that stand close together hardly spread, equal ones not at
/// all, and one far from all others spreads most. Of 40 normal parts draws reach 0.7 s beyond the smallest and largest,
/// 0.8/n of them on either side (of a further part the probability is 1/(n + 1), whatever its distribution).
class SmoothedValues {
 public:
  /// values: [n], in any order. Precondition: n > 1, all are finite, not all are equal.
  explicit SmoothedValues(std::vector<double> values);

  std::span<const double> values() const { return values_; }            ///< [n] as they were given.
  std::span<const double> half_widths() const { return half_widths_; }  ///< [n] w of each of them.
  double mean() const { return mean_; }                                 ///< Of values, and of draws.
  double standard_deviation() const { return deviation_; }              ///< Of draws, to rounding that of values.
  double least() const { return knots_.front(); }                       ///< No draw is below.
  double greatest() const { return knots_.back(); }                     ///< No draw is above.

  /// Ends of the pieces over which the density is constant, ascending. Two are equal where a share of all draws has
  /// that value.
  std::span<const double> knots() const { return knots_; }
  /// The share of all draws below each of the knots, ascending from 0 to 1.
  std::span<const double> shares() const { return shares_; }

  /// The value below which a share u of all draws lies. It goes up with u. Precondition: 0 < u < 1.
  double quantile(double u) const;
  /// The share of all draws below x, half of those that are x counted.
  double share(double x) const;

  /// Whether the values are the same, in the same order.
  friend bool operator==(const SmoothedValues& a, const SmoothedValues& b) { return a.values_ == b.values_; }

 private:
  void add_pieces();

  std::vector<double> values_;
  std::vector<double> half_widths_;
  double mean_ = 0.0;
  double deviation_ = 0.0;
  std::vector<double> knots_;
  std::vector<double> shares_;
};

}  // namespace poesy
