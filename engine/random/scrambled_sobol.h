#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "engine/base/index.h"
#include "engine/random/design_column.h"

namespace poesy {

/// Sobol' points, origin included, with Owen's nested uniform scrambling (Owen 1995, in: Monte Carlo and Quasi-Monte
/// Carlo Methods, 299-317). Each point is uniform on the unit cube; together the first 2^m points of a replicate are a
/// digital net as the points of SobolSequence are. Replicates are independent, so that the differences between their
/// estimates say how sure these are; the points of one replicate depend on each other.
///
/// Digit k of a coordinate is flipped by a random bit of its own for each value of the k digits before it. A block of
/// Philox4x64-10, at purpose scrambled_sobol, factor = dimension and pose = replicate, has the bits of all nodes of a
/// tree of eight digits. The digits after the 32nd are random. So any coordinate of any point is a function of its
/// address, and more points begin with the same ones.
class ScrambledSobol {
 public:
  /// So many points there are of a replicate: 2^32.
  static constexpr std::uint64_t kMostPoints = std::uint64_t{1} << 32;

  /// Throws std::invalid_argument for more dimensions than Boost.Random tabulates (3667; Joe and Kuo 2008).
  ScrambledSobol(std::size_t dimensions, std::uint64_t seed);

  /// Fills uniforms[k] with the coordinate of point first + k, strictly inside (0, 1), exact to 2^-53.
  /// Preconditions: column.dimension < dimensions; no point beyond kMostPoints.
  void fill(const DesignColumn& column, SampleIndex first, std::span<double> uniforms) const;

 private:
  std::uint64_t seed_;
  std::vector<std::uint32_t> directions_;  ///< [dimensions x 32] direction numbers, the first digit uppermost
};

}  // namespace poesy
