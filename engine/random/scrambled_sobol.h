#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "engine/base/index.h"
#include "engine/random/design_column.h"

namespace poesy {

/// Sobol' points, including the origin, with Owen's nested uniform scrambling (Owen 1995, in: Monte Carlo and
/// Quasi-Monte Carlo Methods, 299-317). Each point is uniform on the unit cube; the first 2^m points of a replicate are
/// a digital net, as they are without scrambling. The points of one replicate depend on each other, but replicates are
/// independent, so the scatter of their estimates shows the uncertainty.
///
/// Digit k of a coordinate is flipped by a random bit that depends on the k digits before it. A block of Philox4x64-10
/// (stream.h), with purpose scrambled_sobol, factor = dimension and pose = replicate, has these bits for a binary tree
/// of eight digits. The digits after the 32nd are random. So each coordinate is computed from the seed, the dimension,
/// the replicate and the number of the point, and a larger set of points begins with the smaller one.
class ScrambledSobol {
 public:
  /// The number of points of a replicate: 2^32.
  static constexpr std::uint64_t kMostPoints = std::uint64_t{1} << 32;

  /// Throws std::invalid_argument for more dimensions than Boost.Random tabulates (3667; Joe and Kuo 2008).
  ScrambledSobol(std::size_t dimensions, std::uint64_t seed);

  /// Fills uniforms[k] with the coordinate of point first + k, strictly inside (0, 1), exact to 2^-53. Preconditions:
  /// column.dimension < dimensions; the numbers of the points are below kMostPoints.
  void fill(const DesignColumn& column, SampleIndex first, std::span<double> uniforms) const;

 private:
  std::uint64_t seed_;
  /// [dimensions x 32] direction numbers, whose first digit is the highest bit.
  std::vector<std::uint32_t> directions_;
};

}  // namespace poesy
