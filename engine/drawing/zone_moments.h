#pragma once

#include "engine/drawing/zone_scatter.h"
#include "engine/model/feature.h"

namespace poesy::drawing {

/// The standard deviations of a feature's errors under this scatter. The errors of a feature are uncorrelated under
/// every scatter. If the feature has a clearance, the scatter does not matter: the deviations are those of the
/// clearance. See theory.md, features and zones. Precondition: for ScatterShape::boundary, can_touch().
FeatureSigmas scatter_sigmas(const Feature& feature, const ZoneScatter& scatter);

/// Returns true if ScatterShape::boundary is defined for a feature with these zones: an axis, a point or a distance,
/// without a zone of orientation.
bool can_touch(const Feature& feature);

/// The largest value (m) of an error if it is the only error of its feature. For a lean and for a distance it is the
/// size of the zone, for other errors half of the size.
double half_width_alone(const Feature& feature);

}  // namespace poesy::drawing
