#pragma once

#include "engine/drawing/zone_scatter.h"
#include "engine/model/feature.h"

namespace poesy::drawing {

/// The standard deviations of a feature's errors under this scatter. A feature with a clearance has those of its
/// clearance under any scatter. The errors of a feature are uncorrelated under every scatter. See theory.md, features
/// and zones. Precondition: for ScatterShape::boundary, can_touch().
FeatureSigmas scatter_sigmas(const Feature& feature, const ZoneScatter& scatter);

/// Whether ScatterShape::boundary is defined for a feature with these zones: an axis, a point or a distance, without a
/// zone of orientation.
bool can_touch(const Feature& feature);

/// The largest value of an error that is the only one of its feature (m): half the zone, or for a lean or a distance
/// all of it.
double half_width_alone(const Feature& feature);

}  // namespace poesy::drawing
