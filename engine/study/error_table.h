#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "engine/base/index.h"

namespace poesy {

/// Names of rows that a user gave, so that he finds them again.
struct RowLabels {
  std::string column;              ///< what they name: "part"
  std::vector<std::string> names;  ///< [S], all different
};

/// Errors that somebody else sampled: S rows of V factors.
struct ErrorTable {
  std::vector<FactorIndex> factors;  ///< [V]
  std::vector<double> values;        ///< [S x V], row-major, SI
  std::size_t rows = 0;              ///< S
  RowLabels labels{};                ///< of the rows; empty where they have no names
};

}  // namespace poesy
