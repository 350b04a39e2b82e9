#pragma once

#include <cstddef>
#include <vector>

#include "engine/random/distribution.h"

namespace poesy {

/// Means of polynomials up to this degree are exact over weighted points.
inline constexpr std::size_t kExactDegree = 19;

/// Points that stand for a distribution: sum of weights[k] f(points[k]) is the mean of f.
struct WeightedPoints {
  std::vector<double> points;   ///< [n] in the unit of the error
  std::vector<double> weights;  ///< [n] positive; sum to 1
};

/// Gauss and Legendre's ten points in each piece of the range over which the density is constant or linear: one piece
/// of the uniform, two of the triangular, and those of SmoothedValues, where values that are not spread make a piece
/// without length. Exact for polynomials up to kExactDegree. Throws std::logic_error for another shape.
WeightedPoints weighted_points(const Distribution& distribution);

}  // namespace poesy
