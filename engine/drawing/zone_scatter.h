#pragma once

#include <optional>

#include "engine/model/feature.h"

/// Tolerance zones of a drawing as standard deviations of a feature's errors.
namespace poesy::drawing {

/// How the points of features scatter in their zones. A location and an orientation are used independently, and a zone
/// of location evenly: the errors that move an extreme point of the feature share its variance.
struct ZoneScatter {
  double sigmas = 3.0;             ///< half a zone, in standard deviations of a coordinate of an extreme point
  std::optional<double> within{};  ///< instead: share of the extreme points that are in the zone

  bool operator==(const ZoneScatter&) const = default;  ///< Whether zones give the same standard deviations.
};

/// Half a zone of this feature in standard deviations. With a share it depends on whether its zone is an interval, a
/// disc or a ball.
double sigmas_of(const Feature& feature, const ZoneScatter& scatter);

/// Standard deviations of a feature's errors (m).
struct FeatureSigmas {
  std::optional<double> middle;  ///< of each error that moves it; none: no zone says it
  std::optional<double> tilt;    ///< of each error that turns it; none: no zone says it
};

/// The standard deviations by the feature's zones, where half a zone is so many of them, or by its clearance: exact in
/// the mean square.
FeatureSigmas feature_sigmas(const Feature& feature, double sigmas);

/// The largest zone of orientation, as a share of that of location, that limits more than the location alone does.
double widest_orientation(FeatureKind kind);

}  // namespace poesy::drawing
