#pragma once

#include "engine/model/feature.h"

namespace poesy::drawing {

/// The share of features that are inside their zone of class `of`. All coordinates are normal, as in feature_sigmas(),
/// and half a zone is `sigmas` standard deviations of a coordinate of an extreme point. An axis is inside a zone of
/// location if both ends are, and a plane if all its corners are. If the feature also has a zone of orientation, its
/// tilt has the standard deviation that follows from that zone. shift: the offset of the mean of a distance, as a share
/// of its tolerance.
double share_inside(const Feature& feature, ZoneClass of, double sigmas, double shift = 0.0);

}  // namespace poesy::drawing
