#include "engine/drawing/zone_scatter.h"

#include <algorithm>
#include <boost/math/distributions/chi_squared.hpp>
#include <boost/math/distributions/normal.hpp>
#include <cmath>
#include <numbers>

namespace poesy::drawing {
namespace {

using std::numbers::sqrt2;

/// The standard deviation of each tilt error, divided by the width of the zone of orientation, if half the zone is one
/// standard deviation of the displacement of an extreme point (an end of an axis, a corner of a plane face).
double tilt_of_orientation(FeatureKind kind) {
  if (kind == FeatureKind::axis) return 1.0;
  return kind == FeatureKind::round ? 0.5 : 0.5 / sqrt2;
}

/// The standard deviation of the middle (m) in a zone of location, if a zone of orientation of this width limits the
/// tilt. sigmas: half a zone in standard deviations.
double middle_beside(double location, double orientation, double sigmas) {
  return std::sqrt((location - orientation) * (location + orientation)) / (2.0 * sigmas);
}

/// Each end of a pin is displaced within a disc whose diameter is the clearance. The displacement of the middle is half
/// the sum of the displacements of both ends, and the lean is their difference.
FeatureSigmas clearance_sigmas(const Clearance& clearance) {
  const double size = std::sqrt(clearance.mean_square);
  const double of_end = size / (clearance.touches ? 2.0 * sqrt2 : 4.0);
  return {of_end / sqrt2, of_end * sqrt2};
}

}  // namespace

Feature pin_in_zone(const Feature& feature, double clearance) {
  Feature pin = feature;
  pin.location = Zone{"position", clearance, {}};
  pin.clearance.reset();
  return pin;
}

double widest_orientation(FeatureKind kind) {
  return kind == FeatureKind::rectangle ? std::sqrt(2.0 / 3.0) : 1.0 / sqrt2;
}

double sigmas_of(const Feature& feature, const ZoneScatter& scatter) {
  if (!scatter.within) return scatter.sigmas;
  const bool is_round = !feature.one_direction && feature.kind == FeatureKind::axis;
  if (is_round) return std::sqrt(-2.0 * std::log1p(-*scatter.within));
  const bool is_ball = !feature.one_direction && feature.kind == FeatureKind::point;
  if (is_ball) return std::sqrt(quantile(boost::math::chi_squared(3.0), *scatter.within));
  return quantile(boost::math::normal(), 0.5 + 0.5 * *scatter.within);
}

FeatureSigmas feature_sigmas(const Feature& feature, double sigmas) {
  if (feature.clearance) return clearance_sigmas(*feature.clearance);
  FeatureSigmas found;
  if (feature.kind == FeatureKind::distance) {
    if (feature.location) found.middle = feature.location->size / sigmas;
    return found;
  }
  if (feature.kind == FeatureKind::point) {
    if (feature.location) found.middle = feature.location->size / (2.0 * sigmas);
    return found;
  }
  const double of_tilt = tilt_of_orientation(feature.kind) / sigmas;
  if (!feature.location) {
    if (feature.orientation) found.tilt = of_tilt * feature.orientation->size;
    return found;
  }
  const double location = feature.location->size;
  const double widest = widest_orientation(feature.kind) * location;
  const double orientation = feature.orientation ? std::min(feature.orientation->size, widest) : widest;
  found.middle = middle_beside(location, orientation, sigmas);
  found.tilt = of_tilt * orientation;
  return found;
}

}  // namespace poesy::drawing
