#include "engine/stats/histogram.h"

#include <algorithm>

#include "engine/base/contract.h"

namespace poesy {
namespace {

/// The share of the values in each outermost bin.
constexpr double kTail = 0.0005;

const Bucket& bucket_at(std::span<const Bucket> buckets, double share) {
  const std::uint64_t rank = quantile_rank(share, buckets.back().up_to);
  return *std::ranges::lower_bound(buckets, rank, {}, &Bucket::up_to);
}

/// Where inner edges are sought.
std::vector<double> even_edges(std::span<const Bucket> buckets, std::size_t count) {
  const double first = bucket_at(buckets, kTail).lower;
  const double last = bucket_at(buckets, 1.0 - kTail).upper;
  std::vector<double> edges(count);
  for (std::size_t k = 0; k < count; ++k) {
    const double part = static_cast<double>(k) / static_cast<double>(count - 1);
    edges[k] = first * (1.0 - part) + last * part;
  }
  return edges;
}

/// Fills bins from below.
class Bins {
 public:
  explicit Bins(double first) { filled_.edges.push_back(first); }

  void add(std::uint64_t count) { open_ += count; }
  /// Ends the open bin here, unless it has no width.
  void end_at(double edge) {
    if (edge <= filled_.edges.back()) return;
    filled_.edges.push_back(edge);
    filled_.counts.push_back(open_);
    open_ = 0;
  }
  /// The bins, those that are left over at `last`.
  Histogram finish(double last, std::size_t bins) && {
    end_at(last);
    filled_.edges.resize(bins + 1, last);
    filled_.counts.resize(bins, 0);
    filled_.counts.back() += open_;  // where all values are the same
    return std::move(filled_);
  }

 private:
  Histogram filled_;
  std::uint64_t open_ = 0;
};

}  // namespace

Histogram histogram(std::span<const Bucket> buckets, std::size_t bins) {
  POESY_EXPECTS(bins >= 3 && !buckets.empty());
  const std::vector<double> even = even_edges(buckets, bins - 1);
  Bins filled(buckets.front().lower);
  auto next = even.begin();
  for (const Bucket& bucket : buckets) {
    for (; next != even.end() && *next <= bucket.lower; ++next) filled.end_at(*next);
    filled.add(bucket.count);
    const auto inside = next;
    while (next != even.end() && *next <= bucket.upper) ++next;
    if (next != inside) filled.end_at(bucket.upper);
  }
  return std::move(filled).finish(buckets.back().upper, bins);
}

}  // namespace poesy
