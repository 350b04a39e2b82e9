#pragma once

#include "engine/drawing/zone_scatter.h"
#include "engine/model/feature.h"

namespace poesy::drawing {

/// The standard deviations of a feature's errors under this scatter. The errors of a feature are uncorrelated under
/// every scatter. For a feature with a clearance, they follow from the clearance, whatever the scatter. See theory.md,
/// features and zones. Precondition: for ScatterShape::boundary, can_touch().
FeatureSigmas scatter_sigmas(const Feature& feature, const ZoneScatter& scatter);

/// Returns true if ScatterShape::boundary is defined for the feature. It is defined for an axis, a point or a distance
/// without a zone of orientation.
bool can_touch(const Feature& feature);

/// The largest value (m) of an error that is the only error of its feature: half the zone of location; for a distance,
/// its whole tolerance; for a lean with only a zone of orientation, the whole zone. For a feature with several errors,
/// the radius of its zone of location.
double half_width_alone(const Feature& feature);

}  // namespace poesy::drawing
