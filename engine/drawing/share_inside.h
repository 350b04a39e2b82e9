#pragma once

#include "engine/model/feature.h"

namespace poesy::drawing {

/// The share of manufactured features that are inside their zone of class `of`. The errors are normal, with the
/// standard deviations feature_sigmas(feature, sigmas): half a zone is `sigmas` standard deviations of a coordinate of
/// an extreme point. An axis is inside a zone of location if both ends are, and a plane face if all its extreme points
/// are. shift: the offset of the mean of a distance from its nominal size, as a share of the tolerance.
double share_inside(const Feature& feature, ZoneClass of, double sigmas, double shift = 0.0);

}  // namespace poesy::drawing
