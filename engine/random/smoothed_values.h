#pragma once

#include <cstddef>
#include <span>
#include <vector>

namespace poesy {

/// The distribution of a further part after n parts were measured. Each value is equally likely, and is smoothed evenly
/// over v +- w, with a half-width w of its own. Mean and standard deviation (with n - 1) are those of the parts: the
/// values alone have the variance (n - 1)/n s^2, and smoothing adds the missing s^2/n.
///
/// w is in proportion to the distance of the value from its k-th nearest other value, k = ceil(sqrt(n)) (Breiman,
/// Meisel and Purcell 1977, Technometrics 19, 135-144). So values close together hardly spread, equal ones not at all,
/// and one far from all others spreads most. With 40 normal parts, draws reach 0.7 s beyond the smallest and largest;
/// 0.8/n of them are there on either side (for a further part the probability is 1/(n + 1), whatever its distribution).
class SmoothedValues {
 public:
  /// values: [n], in any order. Precondition: n > 1, all are finite, not all are equal.
  explicit SmoothedValues(std::vector<double> values);

  std::span<const double> values() const { return values_; }            ///< [n] The values in their original order.
  std::span<const double> half_widths() const { return half_widths_; }  ///< [n] The half-width w of each value.
  double mean() const { return mean_; }                                 ///< The mean of values and draws.
  double standard_deviation() const {
    return deviation_;
  }  ///< The standard deviation of draws; to rounding, that of the values.
  double least() const { return knots_.front(); }    ///< The lower bound of the draws.
  double greatest() const { return knots_.back(); }  ///< The upper bound of the draws.

  /// The ends of the pieces of constant density, ascending. Two are equal if a share of all draws has exactly that
  /// value.
  std::span<const double> knots() const { return knots_; }
  /// The share of all draws below each knot, ascending from 0 to 1.
  std::span<const double> shares() const { return shares_; }

  /// The value below which a share u of all draws lies; increasing. Precondition: 0 < u < 1.
  double quantile(double u) const;
  /// The share of all draws below x, plus half of those equal to x.
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
