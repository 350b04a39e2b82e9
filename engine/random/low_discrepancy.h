#pragma once

#include <cstddef>
#include <vector>

namespace poesy {

/// The first `count` points of the Sobol' sequence in `dimensions` dimensions, row-major
/// [count x dimensions], each strictly inside (0, 1). Prefix-stable: fewer points are the first of more.
std::vector<double> sobol_points(std::size_t count, std::size_t dimensions);

}  // namespace poesy
