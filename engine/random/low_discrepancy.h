#pragma once

#include <cstddef>
#include <vector>

namespace poesy {

/// The first `count` points of the Sobol' sequence after the origin in `dimensions` dimensions, row-major
/// [count x dimensions], each strictly inside (0, 1). Prefix-stable: fewer points are the first of more.
/// Throws std::invalid_argument for more dimensions than Boost.Random tabulates (3667; Joe and Kuo 2008).
std::vector<double> sobol_points(std::size_t count, std::size_t dimensions);

}  // namespace poesy
