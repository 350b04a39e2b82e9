#pragma once

#include <cstddef>

namespace poesy {

/// Selects a column of a sampling design: one coordinate of the design's points, in one randomisation of the design.
struct DesignColumn {
  std::size_t dimension = 0;  ///< coordinate of the points
  std::size_t replicate = 0;  ///< number of the independent randomisation of the design
};

}  // namespace poesy
