#pragma once

#include <span>
#include <string>
#include <string_view>

namespace poesy {

/// A distribution of one error source, symmetric about zero: its quantile function and standard deviation.
class Distribution {
 public:
  /// Shapes of the density about zero.
  enum class Shape { normal, truncated_normal, uniform, triangular };

  /// sigma > 0. Each of these throws std::invalid_argument with a clause that names the parameter
  /// and the rule it breaks.
  static Distribution normal(double sigma);
  /// A normal of standard deviation sigma > 0 cut off at +-half_width > 0.
  static Distribution truncated_normal(double sigma, double half_width);
  static Distribution uniform(double half_width);     ///< Constant density on +-half_width > 0.
  static Distribution triangular(double half_width);  ///< Density falling linearly from zero error to +-half_width > 0.

  Shape shape() const { return shape_; }             ///< Which it is.
  double sigma() const { return sigma_; }            ///< Parameter of the (parent) normal; 0 for other shapes.
  double half_width() const { return half_width_; }  ///< Largest possible error; infinity for the normal.
  /// The distribution's own standard deviation (after truncation).
  double standard_deviation() const { return standard_deviation_; }

  /// The value below which a share u of all draws lies. Precondition: 0 < u < 1.
  double quantile(double u) const;
  void transform(std::span<double> uniforms) const;  ///< Replaces each uniform by its quantile.

  friend bool operator==(const Distribution&, const Distribution&) = default;  ///< Shape and parameters.

 private:
  Distribution(Shape shape, double sigma, double half_width, double standard_deviation);

  Shape shape_;
  double sigma_;
  double half_width_;
  double standard_deviation_;
};

/// The value below which a share u of a normal with standard deviation sigma lies, to a few units in the last place.
/// Precondition: 0 < u < 1. Odd about u = 1/2, to the bit wherever 1 - u is exact.
double normal_quantile(double sigma, double u);

/// Replaces each share by its normal_quantile, bit for bit the same on every instruction set. Shares must be inside
/// (0, 1); the fewer of them below 2^-54, the faster.
void normal_quantiles(double sigma, std::span<double> shares);

/// "normal", "truncated-normal", "uniform", "triangular": as in a study file.
std::string_view name(Distribution::Shape shape);

}  // namespace poesy
