#pragma once

#include <span>
#include <vector>

#include "engine/base/bytes.h"
#include "engine/stats/bucket_scale.h"

namespace poesy {

/// A block of numbers as a quantile sketch takes it: all that can be worked out without the sketch.
struct NumberBlock {
  NumberBlock() = default;
  explicit NumberBlock(std::span<const double> numbers);  ///< Precondition: all numbers are finite.

  std::vector<double> values;  ///< the numbers; of more than kMostExact some others of the same buckets
  Extremes extremes;           ///< of the numbers

  /// Puts few numbers into ascending order, so that a sketch of no others need not do it. Any order gives the same
  /// quantiles.
  void sort_few();

  /// As much of it as a sketch takes: up to kMostExact numbers as they are, of more of them two bytes each (four where
  /// they fill no kMostPagesSpanned pages on any scale).
  void write(ByteWriter& to) const;
  static NumberBlock read(ByteReader& from);  ///< Throws BytesError for what no numbers give.
};

}  // namespace poesy
