#pragma once

#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "engine/random/smoothed_values.h"

namespace poesy {

/// A distribution of one error source: its quantile function, mean and standard deviation. All but the measured one are
/// symmetric about zero.
class Distribution {
 public:
  /// Shapes of the density.
  enum class Shape { normal, truncated_normal, uniform, triangular, measured };

  /// Of so many measured values a distribution is made.
  static constexpr std::size_t kLeastMeasured = 8;

  /// sigma > 0. Each of these throws std::invalid_argument with a clause that names the parameter
  /// and the rule it breaks.
  static Distribution normal(double sigma);
  /// A normal of standard deviation sigma > 0 cut off at +-half_width > 0.
  static Distribution truncated_normal(double sigma, double half_width);
  static Distribution uniform(double half_width);     ///< Constant density on +-half_width > 0.
  static Distribution triangular(double half_width);  ///< Density falling linearly from zero error to +-half_width > 0.

  /// As further parts may be (SmoothedValues): with the mean and, with n - 1, the standard deviation of these values.
  /// The mean need not be zero. At least kLeastMeasured values, finite, not all equal.
  static Distribution measured(std::vector<double> values);

  /// The same about a mean that is off by shift >= 0 (as the errors: m or rad), as often up as down: half of all errors
  /// scatter about -shift and half about +shift. Zero gives the same in every bit. Throws std::invalid_argument as the
  /// others do, and for measured values, whose mean was measured with them. Precondition: it has no shift yet.
  Distribution shifted(double shift) const;

  Shape shape() const { return shape_; }   ///< Which it is.
  double sigma() const { return sigma_; }  ///< Parameter of the (parent) normal; 0 for other shapes.
  /// Parameter: without a shift, the largest possible magnitude of an error; infinity for the normal.
  double half_width() const { return half_width_; }
  double shift() const { return shift_; }  ///< Of the mean, as often up as down; 0 unless it is shifted.
  double largest() const { return half_width_ + shift_; }  ///< Largest possible magnitude; infinity for the normal.
  double mean() const { return mean_; }                    ///< Of the distribution; 0 unless it is measured.
  /// The distribution's own standard deviation about its mean: after truncation; of measured values the sample's, with
  /// n - 1; with the shift, sqrt(s^2 + shift^2) where s is that without it.
  double standard_deviation() const { return standard_deviation_; }
  /// What was measured, and what it is spread over; nothing for other shapes.
  const std::optional<SmoothedValues>& parts() const { return parts_; }

  /// The value below which a share u of all draws lies. With a shift something else that is distributed in the same way
  /// for uniform u: -shift + q(2u) for u < 1/2, else shift + q(2u - 1), with q the quantile without the shift. It goes
  /// up with u on either side of 1/2, and down at 1/2. Precondition: 0 < u < 1.
  double quantile(double u) const;
  void transform(std::span<double> uniforms) const;  ///< Replaces each uniform by its quantile.
  /// Replaces each normal score z, a standard normal, by the value at the same share: sigma z for the normal, else the
  /// quantile of Phi(z).
  void transform_scores(std::span<double> scores) const;

  /// Whether shape, parameters, shift and measured values are the same.
  friend bool operator==(const Distribution&, const Distribution&) = default;

 private:
  Distribution(Shape shape, double sigma, double half_width, double standard_deviation);

  /// As without a shift.
  /// @{
  double centred_quantile(double u) const;
  void centred_transform(std::span<double> uniforms) const;
  /// @}

  Shape shape_;
  double sigma_;
  double half_width_;
  double shift_ = 0.0;
  double mean_ = 0.0;
  double standard_deviation_;
  std::optional<SmoothedValues> parts_;
};

/// The value below which a share u of a normal with standard deviation sigma lies, to a few units in the last place.
/// Precondition: 0 < u < 1. Odd about u = 1/2, to the bit wherever 1 - u is exact.
double normal_quantile(double sigma, double u);

/// Replaces each share by its normal_quantile, bit for bit the same on every instruction set. Shares must be inside
/// (0, 1); the fewer of them below 2^-54, the faster.
void normal_quantiles(double sigma, std::span<double> shares);

/// "normal", "truncated-normal", "uniform", "triangular", "measured": as in a study file.
std::string_view name(Distribution::Shape shape);

}  // namespace poesy
