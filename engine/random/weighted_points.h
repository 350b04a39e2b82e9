#pragma once

#include <cstddef>
#include <vector>

#include "engine/random/distribution.h"

namespace poesy {

/// The points of weighted_points() give exact means of polynomials up to this degree.
inline constexpr std::size_t kExactDegree = 19;

/// Points that represent a distribution: sum of weights[k] f(points[k]) is the mean of f if f is a polynomial of degree
/// kExactDegree or less.
struct WeightedPoints {
  std::vector<double> points;   ///< [points] points, in the unit of the error
  std::vector<double> weights;  ///< [points] weights, positive, with the sum 1
};

/// Gauss-Legendre points, ten in each piece of the range with constant or linear density. The uniform has one such
/// piece and the triangular two. Measured values have the pieces between SmoothedValues::knots(), some of which may
/// have zero length. Means of polynomials up to kExactDegree are exact. Throws std::logic_error for other shapes.
WeightedPoints weighted_points(const Distribution& distribution);

}  // namespace poesy
