#pragma once

#include <cstddef>
#include <span>
#include <vector>

namespace poesy {

/// The distribution of the error of a further part after n parts were measured. This distribution is a mixture with one
/// component for each measured value v: a uniform on v +- w, with its own half-width w. Mean and standard deviation s
/// (with n - 1) are those of the measured values: the values alone have the variance (n - 1)/n s^2, and smoothing adds
/// the missing s^2/n.
///
/// w is in proportion to the distance of the value from its k-th nearest other value, k = ceil(sqrt(n)) (Breiman,
/// Meisel and Purcell 1977, Technometrics 19, 135-144). So w is small for values that are close together, 0 for values
/// that are equal, and largest for a value far from all others. With 40 values from a normal, draws reach 0.7 s beyond
/// the smallest and the largest value. The share of draws above the largest value is 0.8/n, and as many are below the
/// smallest; for a real further part this probability is 1/(n + 1), whatever the distribution.
class SmoothedValues {
 public:
  /// values: [n], in any order. Precondition: n > 1, all are finite, not all are equal.
  explicit SmoothedValues(std::vector<double> values);

  std::span<const double> values() const { return values_; }            ///< [n] The values in their original order.
  std::span<const double> half_widths() const { return half_widths_; }  ///< [n] The half-width w of each value.
  double mean() const { return mean_; }                                 ///< The mean of the values, and also of draws.
  /// The standard deviation of draws, which is that of the values up to rounding.
  double standard_deviation() const { return deviation_; }
  double least() const { return knots_.front(); }    ///< The smallest possible draw.
  double greatest() const { return knots_.back(); }  ///< The largest possible draw.

  /// The ends of the pieces of constant density, ascending. Two knots are equal if a share of all draws has exactly
  /// this value.
  std::span<const double> knots() const { return knots_; }
  /// The share of all draws below each knot, ascending from 0 to 1.
  std::span<const double> shares() const { return shares_; }

  /// The value below which a share u of all draws lies; increasing. Precondition: 0 < u < 1.
  double quantile(double u) const;
  /// The share of all draws below x, plus half of the share equal to x.
  double share(double x) const;

  /// Returns true if the values are the same, in the same order.
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
