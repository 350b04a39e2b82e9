#pragma once

#include <span>
#include <vector>

#include "engine/base/bytes.h"
#include "engine/stats/bucket_scale.h"

namespace poesy {

/// A block of numbers for a quantile sketch. Threads prepare blocks in parallel; one thread adds them to the sketch.
struct NumberBlock {
  NumberBlock() = default;
  explicit NumberBlock(std::span<const double> numbers);  ///< Precondition: all numbers are finite.

  /// The numbers. In a block of more than kMostExact numbers that read() made, each is replaced by the end of its
  /// bucket that is nearer to zero (bucket_scale.h).
  std::vector<double> values;
  Extremes extremes;  ///< extremes of the numbers

  /// Sorts the numbers if there are at most kMostExact, so that a sketch of only this block need not sort them. Any
  /// order gives the same quantiles.
  void sort_few();

  /// Writes the block in the form that a sketch needs. Up to kMostExact numbers are written exactly. In a larger block
  /// each number takes two bytes, or four if even the coarsest BucketScale needs more than kMostPagesSpanned pages
  /// (blocks of buckets) for the numbers.
  void write(ByteWriter& to) const;
  static NumberBlock read(ByteReader& from);  ///< Reads a block. Throws BytesError if no numbers can give it.
};

}  // namespace poesy
