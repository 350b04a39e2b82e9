#pragma once

#include <cstdint>
#include <span>

#include "engine/base/index.h"
#include "engine/random/design_column.h"

namespace poesy {

/// A Latin hypercube of n samples (McKay, Beckman and Conover 1979): each dimension has one sample in each of n equal
/// strata, at a random place in it, and strata of different dimensions are permuted independently. Each sample is
/// uniform on the unit cube. Fewer samples are not a Latin hypercube, so n is part of the design.
///
/// The permutation of a dimension is a Feistel network of eight rounds over the smallest power of two that has room for
/// n (at least 2^10), walked until it comes back below n (Black and Rogaway 2002), so that any sample is a function of
/// its address and no permutation is stored. Its keys and the places come from Philox at purpose latin_hypercube,
/// factor = dimension and pose = replicate. Replicates are independent.
class LatinHypercube {
 public:
  /// So many samples there are at most: 2^32.
  static constexpr std::uint64_t kMostSamples = std::uint64_t{1} << 32;

  /// Precondition: 0 < samples <= kMostSamples.
  LatinHypercube(std::uint64_t samples, std::uint64_t seed);

  /// Fills uniforms[k] with the coordinate of sample first + k, strictly inside (0, 1).
  /// Precondition: no sample beyond the last.
  void fill(const DesignColumn& column, SampleIndex first, std::span<double> uniforms) const;

 private:
  std::uint64_t samples_;
  std::uint64_t seed_;
};

}  // namespace poesy
