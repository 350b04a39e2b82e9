#pragma once

#include <cstddef>
#include <memory>
#include <span>
#include <vector>

namespace poesy {

/// The Sobol' sequence after the origin, point by point.
class SobolSequence {
 public:
  /// Throws std::invalid_argument for more dimensions than Boost.Random tabulates (3667; Joe and Kuo 2008).
  explicit SobolSequence(std::size_t dimensions);
  ~SobolSequence();
  SobolSequence(const SobolSequence&) = delete;
  SobolSequence& operator=(const SobolSequence&) = delete;

  /// Writes the next point, [dimensions], or the next n points, row-major [n x dimensions]; strictly inside (0, 1).
  void next(std::span<double> point);

 private:
  struct Generator;
  std::unique_ptr<Generator> generator_;
};

/// The first `count` points of the Sobol' sequence after the origin in `dimensions` dimensions, row-major
/// [count x dimensions], each strictly inside (0, 1). Prefix-stable: fewer points are the first of more.
/// Throws std::invalid_argument for more dimensions than Boost.Random tabulates (3667; Joe and Kuo 2008).
std::vector<double> sobol_points(std::size_t count, std::size_t dimensions);

}  // namespace poesy
