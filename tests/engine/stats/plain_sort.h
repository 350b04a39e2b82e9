#pragma once

#include <algorithm>
#include <vector>

namespace poesy::test {

/// The quantile of n values by sorting: the value of the smallest rank k with k / n >= q. Reference for QuantileSketch.
inline double sorted_quantile(std::vector<double> values, double q) {
  std::ranges::sort(values);
  std::size_t k = 1;
  while (static_cast<double>(k) / static_cast<double>(values.size()) < q) ++k;
  return values.at(k - 1);
}

}  // namespace poesy::test
