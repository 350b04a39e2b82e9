#pragma once

#include <cstddef>

namespace poesy {

/// One column of uniforms of a sampling design: a coordinate of its points, in one of its randomisations.
struct DesignColumn {
  std::size_t dimension = 0;  ///< coordinate of the points
  std::size_t replicate = 0;  ///< number of the design's independent randomisation
};

}  // namespace poesy
