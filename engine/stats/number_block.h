#pragma once

#include <span>
#include <vector>

#include "engine/base/bytes.h"
#include "engine/stats/bucket_scale.h"

namespace poesy {

/// A block of numbers, prepared for a quantile sketch as far as that is possible without the sketch.
struct NumberBlock {
  NumberBlock() = default;
  explicit NumberBlock(std::span<const double> numbers);  ///< Precondition: all numbers are finite.

  std::vector<double>
      values;         ///< the numbers; if more than kMostExact, each may be replaced by another of the same bucket
  Extremes extremes;  ///< extremes of the numbers

  /// Sorts a small block, so that a sketch without other numbers need not do it. Any order gives the same quantiles.
  void sort_few();

  /// Writes what a sketch needs: up to kMostExact numbers as they are, more as two bytes each (four if they span more
  /// than kMostPagesSpanned pages on every scale).
  void write(ByteWriter& to) const;
  static NumberBlock read(ByteReader& from);  ///< Reads a block. Throws BytesError for one that no numbers can give.
};

}  // namespace poesy
