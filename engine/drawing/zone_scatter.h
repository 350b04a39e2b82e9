#pragma once

#include <optional>

#include "engine/model/feature.h"

/// Tolerance zones of a drawing as standard deviations of a feature's errors.
namespace poesy::drawing {

/// The distribution of features in their zones.
enum class ScatterShape {
  normal,    ///< coordinates of extreme points are normal; some features are outside their zones
  uniform,   ///< all features within the zones are equally likely
  boundary,  ///< extreme points are on the boundary of the zone, uniformly in direction
  inspected  ///< normal, but features outside their zones are rejected
};

/// The scatter of the extreme points of features (ends of axes, corners of planes) in their zones. The scatter in a
/// zone of location and that in a zone of orientation are independent. Under normal scatter, the errors that displace
/// an extreme point contribute equally to its variance.
struct ZoneScatter {
  ScatterShape shape = ScatterShape::normal;  ///< distribution of the extreme points
  /// Half a zone, in standard deviations of a coordinate of an extreme point. Applies to `normal` and `inspected`.
  double sigmas = 3.0;
  std::optional<double> within{};  ///< the share of extreme points inside the zone, from which `sigmas` is computed
                                   ///< instead

  bool is_normal() const { return shape == ScatterShape::normal; }  ///< Returns true if errors are independent normals.
  /// Returns true if the distribution has normals, which `sigmas` or `within` scale.
  bool has_sigmas() const { return is_normal() || shape == ScatterShape::inspected; }

  bool operator==(const ZoneScatter&) const = default;  ///< Returns true if both give errors the same distribution.
};

/// Half a zone of this feature, in standard deviations of a coordinate. If `within` is set, the result depends on
/// whether the zone is an interval, a disc or a ball.
double sigmas_of(const Feature& feature, const ZoneScatter& scatter);

/// Standard deviations of a feature's errors (m).
struct FeatureSigmas {
  std::optional<double>
      middle;  ///< standard deviation of each error that displaces the feature; none if no zone limits it
  std::optional<double> tilt;  ///< standard deviation of each error that turns the feature; none if no zone limits it
};

/// The standard deviations of a feature's normal errors, if half a zone is `sigmas` standard deviations. A feature
/// with a clearance has the mean square that follows from the clearance.
FeatureSigmas feature_sigmas(const Feature& feature, double sigmas);

/// A pin that is loose in its bore by this clearance (m), as the axis of a feature whose zone of location has this
/// diameter: each end of the pin's axis is in a disc of this diameter. Precondition: the feature has a clearance.
Feature pin_in_zone(const Feature& feature, double clearance);

/// The largest useful zone of orientation, as a share of the zone of location. A wider zone does not limit the feature
/// further.
double widest_orientation(FeatureKind kind);

}  // namespace poesy::drawing
