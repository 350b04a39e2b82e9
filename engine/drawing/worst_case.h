#pragma once

#include <array>
#include <vector>

#include "engine/model/feature.h"

/// The largest effect that features may have in their zones, to first order.
namespace poesy::drawing {

/// A number for each error of a feature: those of its middle, then those of its tilt, in their order.
using OfErrors = std::vector<double>;

/// The errors of a feature that make a linear effect largest.
struct Extreme {
  OfErrors errors;     ///< m, in the zone
  double value = 0.0;  ///< their effect: the support function of the zone
};

/// The largest value of sum over the errors of slope x error in the feature's zones. slopes: of its errors. An error
/// without a zone is 0. theory.md, features and zones.
Extreme extreme(const Feature& feature, const OfErrors& slopes);

/// Mean squares of a feature's effect.
struct ZoneSquares {
  double even;   ///< as feature_sigmas() divides its zone of location
  double worst;  ///< as the worst division of a location without orientation: the middle alone, or the tilt alone
};

/// The mean squares if half a zone is so many standard deviations. squares: of each error of the feature, the sum of
/// squared slopes over the components of a response.
ZoneSquares zone_squares(const Feature& feature, double sigmas, const OfErrors& squares);

/// The largest length of a sum of vectors, one for each feature.
struct LargestLength {
  double length = 0.0;             ///< the largest that was found
  std::vector<double> by_feature;  ///< the part of each feature in that direction
};

/// The largest length over all errors in the zones. An error adds its column of slopes times its value. Ascents from
/// many directions find the largest in practice, and prove no bound. slopes: [features][components] of each feature's
/// errors; up to three components.
LargestLength largest_length(const std::vector<Feature>& features, const std::vector<std::vector<OfErrors>>& slopes);

}  // namespace poesy::drawing
