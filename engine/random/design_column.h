#pragma once

#include <cstddef>

namespace poesy {

/// Selects a column of a sampling design: one coordinate of the design's points, in one randomisation of the design.
struct DesignColumn {
  std::size_t dimension = 0;  ///< index of the coordinate
  std::size_t replicate = 0;  ///< index of the randomisation; randomisations are independent of each other
};

}  // namespace poesy
