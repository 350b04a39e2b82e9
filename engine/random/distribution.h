#pragma once

#include <cmath>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "engine/random/smoothed_values.h"

namespace poesy {

/// The distribution of one error: its quantile function, mean and standard deviation. All shapes except measured and
/// given values are symmetric about their centre, which is zero unless about() moves it.
class Distribution {
 public:
  /// Shapes of the density.
  enum class Shape { normal, truncated_normal, uniform, triangular, measured, given };

  /// The least number of measured values for a distribution.
  static constexpr std::size_t kLeastMeasured = 8;

  /// A normal with sigma > 0. This function and the following ones throw std::invalid_argument for bad parameters. The
  /// exception's text is a clause that names the parameter and the rule that it breaks.
  static Distribution normal(double sigma);
  /// A normal of standard deviation sigma > 0, truncated at +-half_width > 0.
  static Distribution truncated_normal(double sigma, double half_width);
  static Distribution uniform(double half_width);     ///< Constant density on +-half_width > 0.
  static Distribution triangular(double half_width);  ///< Density falling linearly from zero error to +-half_width > 0.

  /// The distribution of the error of further parts, estimated from the measured values of n parts (SmoothedValues).
  /// Its mean and its standard deviation (with n - 1) are those of the values; the mean need not be zero. There must be
  /// at least kLeastMeasured values, finite and not all equal.
  static Distribution measured(std::vector<double> values);

  /// A distribution in which each of the given values is equally likely. The values are the errors of machines that are
  /// given in a table instead of drawn. The standard deviation is that of the values (n - 1). There must be at least
  /// two values, finite and not all equal.
  static Distribution given(std::vector<double> values);

  /// The same shape with a shifted mean: half of all errors scatter about -shift, half about +shift (m or rad, >= 0).
  /// With a zero shift, draws are bit for bit those without a shift. Throws std::invalid_argument for a negative shift,
  /// and for measured and given values, which have a mean of their own. Precondition: the distribution has no shift
  /// yet.
  Distribution shifted(double shift) const;

  /// The same distribution, moved so that its middle is at `centre` (m or rad). With a zero centre, draws are bit for
  /// bit those of this distribution. Throws std::invalid_argument for a number that is not finite, and for measured and
  /// given values, which have a mean of their own. Precondition: the present centre is 0.
  Distribution about(double centre) const;

  Shape shape() const { return shape_; }   ///< The shape of the density.
  double sigma() const { return sigma_; }  ///< Sigma of the normal, before truncation; 0 for other shapes.
  /// The largest possible distance of an error from the centre (from 0 for measured and given values), without the
  /// shift; infinity for a normal that is not truncated.
  double half_width() const { return half_width_; }
  double shift() const { return shift_; }  ///< The shift of shifted(); 0 if there is none.
  /// The largest possible magnitude of an error; infinity for a normal that is not truncated.
  double largest() const { return half_width_ + shift_ + std::abs(centre_); }
  double centre() const { return centre_; }  ///< The middle of a symmetric shape; 0 for other shapes.
  /// The mean: the centre of a symmetric shape, otherwise the mean of the values.
  double mean() const { return mean_; }
  /// The standard deviation about the mean, after truncation. For measured and given values it is computed with n - 1.
  /// With a shift it is sqrt(s^2 + shift^2), where s is the standard deviation without the shift.
  double standard_deviation() const { return standard_deviation_; }
  /// The measured values and how they are smoothed; none for other shapes.
  const std::optional<SmoothedValues>& parts() const { return parts_; }

  /// The value below which a share u of all draws lies. For a shifted distribution, quantile(u) is not this value, but
  /// another function that also turns a uniform u into a draw: -shift + q(2u) for u < 1/2, else shift + q(2u - 1),
  /// where q is the quantile without the shift. This function increases with u on either side of 1/2, and falls at 1/2.
  /// Precondition: 0 < u < 1.
  double quantile(double u) const;
  void transform(std::span<double> uniforms) const;  ///< Replaces each uniform number u by quantile(u).
  /// Replaces each normal score z (a standard normal) by quantile(Phi(z)), where Phi is the standard normal
  /// distribution function. For a normal without a shift this is centre + sigma z.
  void transform_scores(std::span<double> scores) const;

  /// The given values, ascending; empty for other shapes.
  std::span<const double> given_values() const { return given_; }

  /// Returns true if shape, parameters, shift, centre and measured values are the same.
  friend bool operator==(const Distribution&, const Distribution&) = default;

 private:
  Distribution(Shape shape, double sigma, double half_width, double standard_deviation);

  /// The quantile without a shift, about zero.
  /// @{
  double centred_quantile(double u) const;
  void centred_transform(std::span<double> uniforms) const;
  /// @}
  /// Replaces each uniform number by its quantile with the shift, about zero.
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

/// The name of a shape in a study file: "normal", "truncated-normal", "uniform", "triangular", "measured"; "given" for
/// given machines.
std::string_view name(Distribution::Shape shape);

}  // namespace poesy
