#include "engine/random/low_discrepancy.h"

#include <boost/random/sobol.hpp>

namespace poesy {

std::vector<double> sobol_points(std::size_t count, std::size_t dimensions) {
  std::vector<double> points(count * dimensions);
  if (points.empty()) return points;
  // Boost leaves out the origin. Coordinates of the points after it are k / 2^m with 2^m above the point's position:
  // never 0 or 1, and exact in a double for the first 2^53 points.
  boost::random::sobol sequence(dimensions);
  for (double& coordinate : points) coordinate = static_cast<double>(sequence()) * 0x1p-64;
  return points;
}

}  // namespace poesy
