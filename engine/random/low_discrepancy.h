#pragma once

#include <cstddef>
#include <memory>
#include <span>

namespace poesy {

/// The Sobol' sequence without the origin, point by point.
class SobolSequence {
 public:
  /// Throws std::invalid_argument for more dimensions than Boost.Random tabulates (3667; Joe and Kuo 2008).
  explicit SobolSequence(std::size_t dimensions);
  ~SobolSequence();
  SobolSequence(const SobolSequence&) = delete;
  SobolSequence& operator=(const SobolSequence&) = delete;

  /// Fills `point` with the coordinates of the next point. If `point` has room for several points, fills it with the
  /// next points, row-major [points x dimensions]. Coordinates are strictly inside (0, 1).
  void next(std::span<double> point);

 private:
  struct Generator;
  std::unique_ptr<Generator> generator_;
};

}  // namespace poesy
