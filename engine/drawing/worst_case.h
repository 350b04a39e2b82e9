#pragma once

#include <array>
#include <vector>

#include "engine/drawing/zone_scatter.h"
#include "engine/model/feature.h"

/// The largest effect of features within their zones, to first order.
namespace poesy::drawing {

/// A number for each error of a feature. First come the errors of its middle, then those of its tilt, in the order of
/// the members of Feature.
using OfErrors = std::vector<double>;

/// The errors of a feature that make a linear effect largest.
struct Extreme {
  OfErrors errors;     ///< m, in the zone
  double value = 0.0;  ///< sum of slope x error, which is the support function of the zone
};

/// The largest sum of slope x error over all errors that keep the feature within its zones. slopes: one for each error.
/// An error that no zone limits is 0. See theory.md, features and zones.
Extreme extreme(const Feature& feature, const OfErrors& slopes);

/// Mean squares of a feature's effect on a response.
struct ZoneSquares {
  double even;  ///< mean square if the zone of location is divided between middle and tilt as in scatter_sigmas()
  /// Mean square at the worst division of the zone of location, for a feature without a zone of orientation: all to the
  /// middle or all to the tilt. Under uniform and boundary scatter, this equals `even`. For inspected
  /// features, it is the value before inspection.
  double worst;
};

/// The mean squares of a feature's effect under this scatter. sigmas: scatter_sigmas() of both. Callers compute it
/// once, because it integrates numerically for inspected features. squares: for each error of the feature, the sum of
/// squared slopes over the components of a response.
ZoneSquares zone_squares(const Feature& feature, const ZoneScatter& scatter, const FeatureSigmas& sigmas,
                         const OfErrors& squares);

/// The largest length of a sum of vectors, to which each feature contributes one vector.
struct LargestLength {
  double length = 0.0;             ///< the largest that was found
  std::vector<double> by_feature;  ///< component of each feature's vector along the sum; these add up to the length
};

/// The largest length of the sum of the features' vectors over all errors within the zones. The vector of a feature is
/// the sum of slope x error over its errors. slopes: for each feature and each of the one to three components of the
/// vectors, the slopes by the feature's errors. Ascents from many directions find the largest length in practice, but
/// do not prove it.
LargestLength largest_length(const std::vector<Feature>& features, const std::vector<std::vector<OfErrors>>& slopes);

}  // namespace poesy::drawing
