#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "engine/stats/quantile_sketch.h"

namespace poesy {

/// Bin k holds the values from edges[k] to edges[k + 1].
struct Histogram {
  std::vector<double> edges;          ///< [B + 1] ascending; the first and the last are the extremes
  std::vector<std::uint64_t> counts;  ///< [B]
};

/// A histogram of exactly `bins` bins of what a sketch holds, of which `buckets` are. All but the first and the last
/// bin, which hold the outermost 0.05 % of the values, are about equally wide. Edges are edges of buckets, so every
/// count is exact; where buckets are wider than bins, fewer bins are filled, and those left over have no width and
/// come last. Precondition: bins >= 3, and there is a bucket.
Histogram histogram(std::span<const Bucket> buckets, std::size_t bins);

}  // namespace poesy
