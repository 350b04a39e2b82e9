#pragma once

#include <array>
#include <vector>

#include "engine/drawing/zone_scatter.h"
#include "engine/model/feature.h"

/// The largest effect of features within their zones, to first order.
namespace poesy::drawing {

/// A number for each error of a feature, in the order of Feature::errors(): first the errors of its middle, then those
/// of its tilt.
using OfErrors = std::vector<double>;

/// The errors of a feature that make a linear effect largest.
struct Extreme {
  OfErrors errors;     ///< errors, m; they keep the feature in its zones
  double value = 0.0;  ///< sum of slope x error: the support function of the zones at the slopes
};

/// The largest sum of slope x error over all errors that keep the feature within its zones. slopes: derivatives of the
/// effect, one for each error. An error that no zone limits is 0. See theory.md, features and zones.
Extreme extreme(const Feature& feature, const OfErrors& slopes);

/// Mean squares of a feature's effect on a response, in squared SI units of the response.
struct ZoneSquares {
  double even;  ///< mean square with the standard deviations of scatter_sigmas()
  /// For a feature without a zone of orientation: mean square if the middle alone or the tilt alone uses the zone of
  /// location, whichever is worse. Otherwise equal to `even`. Under uniform and boundary scatter it also equals `even`.
  /// For inspected features, it is the value before inspection.
  double worst;
};

/// The mean squares of a feature's effect under this scatter. sigmas: scatter_sigmas(feature, scatter). It is an
/// argument so that callers do its numerical integration only once. squares: for each error of the feature, the sum of
/// the squared slopes of the components of the response.
ZoneSquares zone_squares(const Feature& feature, const ZoneScatter& scatter, const FeatureSigmas& sigmas,
                         const OfErrors& squares);

/// The largest length of a sum of vectors, to which each feature contributes one vector.
struct LargestLength {
  double length = 0.0;             ///< largest length that was found
  std::vector<double> by_feature;  ///< [features] component of each vector along the sum; they add up to the length
};

/// The largest length of the sum of the features' vectors over all errors within the zones. The vector of a feature is
/// the sum of slope x error over its errors. slopes: [features][one to three components of the vectors] derivatives
/// with respect to each error of the feature. Ascents from many directions find the largest length in practice, but do
/// not prove it.
LargestLength largest_length(const std::vector<Feature>& features, const std::vector<std::vector<OfErrors>>& slopes);

}  // namespace poesy::drawing
