#pragma once

#include <gtest/gtest.h>

#include <cmath>
#include <vector>

#include "engine/calibration/fit.h"
#include "engine/random/normal_quantile.h"
#include "engine/random/stream.h"

namespace poesy::calibration {

/// Standard normal numbers of one stream.
inline std::vector<double> normal_numbers(std::size_t stream, std::size_t count) {
  std::vector<double> numbers(count);
  fill_uniforms({17, Purpose::calibration, FactorIndex(stream), PoseIndex(1)}, SampleIndex(0), numbers);
  for (double& number : numbers) number = normal_quantile(1.0, number);
  return numbers;
}

/// [rows x columns] Standard normal numbers of one stream.
inline Matrix normal_matrix(std::size_t stream, Eigen::Index rows, Eigen::Index columns) {
  const std::vector<double> numbers = normal_numbers(stream, static_cast<std::size_t>(rows * columns));
  return Eigen::Map<const Matrix>(numbers.data(), rows, columns);
}

/// Expects that each share is 0.95 within 4.3 standard errors (alpha = 2e-5). shares: for each number, the share of
/// `machines` 95 % intervals that contain the true value. Example: with 4000 machines 4.3 standard errors are 1.5
/// percentage points.
inline void expect_nominal(const Vector& shares, std::size_t machines) {
  const double standard_error = std::sqrt(0.95 * 0.05 / static_cast<double>(machines));
  for (Eigen::Index j = 0; j < shares.size(); ++j) EXPECT_NEAR(shares(j), 0.95, 4.3 * standard_error) << j;
}

}  // namespace poesy::calibration
