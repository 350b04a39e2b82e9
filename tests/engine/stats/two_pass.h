#pragma once

#include <cmath>
#include <vector>

namespace poesy::test {

/// Moments by their definitions, in two passes in long double. Reference for the one-pass updates.
struct TwoPass {
  double mean;
  double variance;
  double kurtosis;
};

inline TwoPass two_pass(const std::vector<double>& values) {
  const auto n = static_cast<long double>(values.size());
  long double sum = 0.0L;
  for (const double value : values) sum += value;
  const long double mean = sum / n;
  long double m2 = 0.0L;
  long double m4 = 0.0L;
  for (const double value : values) {
    const long double square = (value - mean) * (value - mean);
    m2 += square;
    m4 += square * square;
  }
  return {static_cast<double>(mean), static_cast<double>(m2 / (n - 1.0L)), static_cast<double>(n * m4 / (m2 * m2))};
}

}  // namespace poesy::test
