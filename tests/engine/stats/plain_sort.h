#pragma once

#include <algorithm>
#include <vector>

namespace poesy::test {

/// The order statistic of the smallest rank k with k / n >= q, by sorting and looking: the oracle for sketches.
inline double sorted_quantile(std::vector<double> values, double q) {
  std::ranges::sort(values);
  std::size_t k = 1;
  while (static_cast<double>(k) / static_cast<double>(values.size()) < q) ++k;
  return values.at(k - 1);
}

}  // namespace poesy::test
