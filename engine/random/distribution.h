#pragma once

#include <cmath>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "engine/random/smoothed_values.h"

namespace poesy {

/// The distribution of one error: its quantile function, mean and standard deviation. All shapes but measured and given
/// values are symmetric about their centre, which is zero unless about() moves it.
class Distribution {
 public:
  /// Shapes of the density.
  enum class Shape { normal, truncated_normal, uniform, triangular, measured, given };

  /// The least number of measured values for a distribution.
  static constexpr std::size_t kLeastMeasured = 8;

  /// A normal with sigma > 0. Each of these functions throws std::invalid_argument, with a clause that names the
  /// parameter and its rule.
  static Distribution normal(double sigma);
  /// A normal of standard deviation sigma > 0, truncated at +-half_width > 0.
  static Distribution truncated_normal(double sigma, double half_width);
  static Distribution uniform(double half_width);     ///< Constant density on +-half_width > 0.
  static Distribution triangular(double half_width);  ///< Density falling linearly from zero error to +-half_width > 0.

  /// The distribution of further parts after these were measured (SmoothedValues), with the mean and the standard
  /// deviation (n - 1) of these values. The mean need not be zero. At least kLeastMeasured values, finite, not all
  /// equal.
  static Distribution measured(std::vector<double> values);

  /// The values themselves, each as often: those of machines that are given instead of drawn. Its standard deviation is
  /// that of the values (n - 1). At least two values, finite, not all equal.
  static Distribution given(std::vector<double> values);

  /// The same shape about a mean that is off by shift >= 0 (m or rad), as often up as down: half of all errors scatter
  /// about -shift and half about +shift. A zero shift gives the same bits. Throws std::invalid_argument for a negative
  /// shift, and for measured and given values, which have a mean. Precondition: it has no shift yet.
  Distribution shifted(double shift) const;

  /// The same distribution moved, so that its middle is at `centre` (m or rad). A zero centre gives the same bits.
  /// Throws std::invalid_argument for a number that is not finite, and for measured and given values, which have a
  /// mean. Precondition: its centre is 0.
  Distribution about(double centre) const;

  Shape shape() const { return shape_; }   ///< The shape of the density.
  double sigma() const { return sigma_; }  ///< Sigma of the (parent) normal; 0 for other shapes.
  /// Without a shift, the largest possible distance of an error from the centre; infinity for the normal.
  double half_width() const { return half_width_; }
  double shift() const { return shift_; }  ///< Offset of the mean, as often up as down; 0 unless it is shifted.
  /// Largest possible magnitude; infinity for the normal.
  double largest() const { return half_width_ + shift_ + std::abs(centre_); }
  double centre() const { return centre_; }  ///< The middle of a symmetric shape; 0 for others.
  double mean() const { return mean_; }      ///< The mean: the centre, or that of the values.
  /// The standard deviation about the mean: after truncation; for measured values with n - 1; with a shift, sqrt(s^2 +
  /// shift^2) where s is that without it.
  double standard_deviation() const { return standard_deviation_; }
  /// The measured values and how they are smoothed; none for other shapes.
  const std::optional<SmoothedValues>& parts() const { return parts_; }

  /// The value below which a share u of all draws lies. With a shift, another function with the same distribution for
  /// uniform u: -shift + q(2u) for u < 1/2, else shift + q(2u - 1), where q is the quantile without the shift. It
  /// increases with u on either side of 1/2, and falls at 1/2. Precondition: 0 < u < 1.
  double quantile(double u) const;
  void transform(std::span<double> uniforms) const;  ///< Replaces each uniform by its quantile.
  /// Replaces each normal score z, a standard normal, by the value at the same share: centre + sigma z for the normal,
  /// otherwise the quantile of Phi(z).
  void transform_scores(std::span<double> scores) const;

  /// The given values, ascending; empty for other shapes.
  std::span<const double> given_values() const { return given_; }

  /// Whether shape, parameters, shift, centre and measured values are the same.
  friend bool operator==(const Distribution&, const Distribution&) = default;

 private:
  Distribution(Shape shape, double sigma, double half_width, double standard_deviation);

  /// The quantile without a shift, about zero.
  /// @{
  double centred_quantile(double u) const;
  void centred_transform(std::span<double> uniforms) const;
  /// @}
  /// Replaces each uniform by its quantile about zero.
  void shifted_transform(std::span<double> uniforms) const;
  /// Moves values about zero to the centre.
  void add_centre(std::span<double> values) const;

  Shape shape_;
  double sigma_;
  double half_width_;
  double shift_ = 0.0;
  double centre_ = 0.0;
  double mean_ = 0.0;
  double standard_deviation_;
  std::optional<SmoothedValues> parts_;
  std::vector<double> given_;
};

/// The quantile of a normal with standard deviation sigma at the share u, to a few units in the last place. Odd about u
/// = 1/2, exactly wherever 1 - u is exact. Precondition: 0 < u < 1.
double normal_quantile(double sigma, double u);

/// Replaces each share by its normal_quantile(), with the same bits on every instruction set. Precondition: shares are
/// inside (0, 1). It is fastest if few of them are below 2^-54.
void normal_quantiles(double sigma, std::span<double> shares);

/// The word in a study file: "normal", "truncated-normal", "uniform", "triangular", "measured"; "given" where machines
/// are.
std::string_view name(Distribution::Shape shape);

}  // namespace poesy
