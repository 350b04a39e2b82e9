#pragma once

#include <optional>

#include "engine/model/feature.h"

/// Converts tolerance zones of a drawing to standard deviations of the errors of its features.
namespace poesy::drawing {

/// The distribution of features in their zones.
enum class ScatterShape {
  normal,    ///< coordinates of extreme points are normal, so some features are outside their zones
  uniform,   ///< all features within the zones are equally likely
  boundary,  ///< extreme points are on the boundary of the zone, in uniformly distributed directions
  inspected  ///< normal, but features outside their zones are rejected
};

/// The scatter of the extreme points of features (ends of axes, corners of planes) in their zones. The scatter in a
/// zone of location and that in a zone of orientation are independent. Under normal scatter, the errors that displace
/// an extreme point contribute equally to its variance.
struct ZoneScatter {
  ScatterShape shape = ScatterShape::normal;  ///< distribution of the extreme points
  /// For `normal` and `inspected`: half a zone, divided by the standard deviation of a coordinate of an extreme point.
  double sigmas = 3.0;
  std::optional<double> within{};  ///< if set, replaces `sigmas`: the share of extreme points that are inside the zone

  bool is_normal() const { return shape == ScatterShape::normal; }  ///< Returns true for normal, independent errors.
  /// Returns true if errors are normal before an inspection, so that `sigmas` or `within` matters.
  bool has_sigmas() const { return is_normal() || shape == ScatterShape::inspected; }

  bool operator==(const ZoneScatter&) const = default;  ///< Returns true if all members are equal.
};

/// Half a zone of this feature, divided by the standard deviation of a coordinate of an extreme point. If
/// scatter.within is set, the result depends on whether the zone is an interval, a disc or a ball.
double sigmas_of(const Feature& feature, const ZoneScatter& scatter);

/// Standard deviations of a feature's errors (m).
struct FeatureSigmas {
  std::optional<double>
      middle;  ///< standard deviation of each error that displaces the feature; none if no zone limits it
  std::optional<double> tilt;  ///< standard deviation of each error that turns the feature; none if no zone limits it
};

/// The standard deviations of a feature's normal errors, if half a zone is `sigmas` standard deviations of a coordinate
/// of an extreme point. For a feature with a clearance, they follow from Clearance::mean_square.
FeatureSigmas feature_sigmas(const Feature& feature, double sigmas);

/// A pin that is loose in its bore by this clearance (m), as the axis of a feature whose zone of location has this
/// diameter: each end of the pin's axis is in a disc of this diameter. Precondition: the feature has a clearance.
Feature pin_in_zone(const Feature& feature, double clearance);

/// The width of the largest zone of orientation that has an effect, divided by the width of the zone of location. A
/// wider zone changes nothing.
double widest_orientation(FeatureKind kind);

}  // namespace poesy::drawing
