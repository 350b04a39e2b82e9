#pragma once

#include <cstdint>
#include <span>

#include "engine/base/index.h"
#include "engine/random/design_column.h"

namespace poesy {

/// A Latin hypercube of n samples (McKay, Beckman and Conover 1979). Each dimension has one sample in each of n equal
/// strata, at a random place in the stratum; strata of different dimensions are permuted independently. Each sample is
/// uniform on the unit cube. A part of the samples is not a Latin hypercube, so n must be known from the beginning.
///
/// The permutation of a dimension is a Feistel network of eight rounds over the smallest power of two that is at least
/// n and 2^10, which is applied again until the result is below n (Black and Rogaway 2002). So each coordinate is
/// computed from the seed, the dimension, the replicate and the number of the sample, and no permutation is stored. The
/// random bits of keys and places come from Philox (stream.h) with purpose latin_hypercube, factor = dimension and pose
/// = replicate. Replicates are independent.
class LatinHypercube {
 public:
  /// The largest number of samples: 2^32.
  static constexpr std::uint64_t kMostSamples = std::uint64_t{1} << 32;

  /// Precondition: 0 < samples <= kMostSamples.
  LatinHypercube(std::uint64_t samples, std::uint64_t seed);

  /// Fills uniforms[k] with the coordinate of sample first + k, strictly inside (0, 1). Precondition: first + k is
  /// below the number of samples.
  void fill(const DesignColumn& column, SampleIndex first, std::span<double> uniforms) const;

 private:
  std::uint64_t samples_;
  std::uint64_t seed_;
};

}  // namespace poesy
