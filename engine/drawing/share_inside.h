#pragma once

#include "engine/model/feature.h"

namespace poesy::drawing {

/// The share of features that are inside a zone of theirs, where half a zone is `sigmas` standard deviations of a
/// coordinate of an extreme point and all coordinates are normal (feature_sigmas). Of a location: both ends of an axis,
/// all corners of a plane. A feature with an orientation has the tilt that this allows. of: one of the feature's zones.
/// shift: by which share of its tolerance the mean of a distance is off.
double share_inside(const Feature& feature, ZoneClass of, double sigmas, double shift = 0.0);

}  // namespace poesy::drawing
