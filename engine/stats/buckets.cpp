#include "engine/stats/buckets.h"

#include <algorithm>
#include <boost/math/distributions/binomial.hpp>
#include <limits>
#include <utility>

#include "engine/base/contract.h"
#include "engine/base/nan.h"

namespace poesy {
namespace {

namespace policies = boost::math::policies;
/// The binomial distribution of a number B. Its quantile p is the smallest k with P(B <= k) >= p. Computed in double,
/// because Boost's default of long double takes several times as long.
using Binomial = boost::math::binomial_distribution<
    double, policies::policy<policies::discrete_quantile<policies::integer_round_up>, policies::promote_double<false>>>;

/// The bucket that contains the value of this rank. Precondition: 1 <= rank <= number of values.
const Bucket& bucket_of(std::span<const Bucket> buckets, std::uint64_t rank) {
  return *std::ranges::lower_bound(buckets, rank, {}, &Bucket::up_to);
}

/// The share of the values in each of the two outermost bins.
constexpr double kTail = 0.0005;

const Bucket& bucket_at(std::span<const Bucket> buckets, double share) {
  return bucket_of(buckets, quantile_rank(share, buckets.back().up_to));
}

/// The inner edges of the bins of a histogram, at equal distances. histogram() moves them to edges of buckets.
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

}  // namespace

double order_statistic(std::span<const Bucket> buckets, std::uint64_t k) {
  POESY_EXPECTS(!buckets.empty() && k >= 1 && k <= buckets.back().up_to);
  if (k == 1) return buckets.front().lower;
  if (k == buckets.back().up_to) return buckets.back().upper;
  const Bucket& bucket = bucket_of(buckets, k);
  return bucket.lower + 0.5 * (bucket.upper - bucket.lower);
}

double order_statistic_error(std::span<const Bucket> buckets, std::uint64_t k) {
  POESY_EXPECTS(!buckets.empty() && k >= 1 && k <= buckets.back().up_to);
  if (k == 1 || k == buckets.back().up_to) return 0.0;
  const Bucket& bucket = bucket_of(buckets, k);
  return 0.5 * (bucket.upper - bucket.lower);
}

RankInterval quantile_ranks(std::uint64_t n, double q, double conf_level) {
  POESY_EXPECTS(q > 0.0 && q < 1.0 && conf_level > 0.0 && conf_level < 1.0);
  if (n == 0) return {0, 1};
  const Binomial below(static_cast<double>(n), q);
  const double beyond = 0.5 * (1.0 - conf_level);
  // Let B be the number of draws below the quantile. The ranks are such that P(B < low) < beyond and P(B >= high) <=
  // beyond.
  const double low = quantile(below, beyond);
  const double high = quantile(complement(below, beyond)) + 1.0;
  return {static_cast<std::uint64_t>(low), static_cast<std::uint64_t>(high)};
}

Interval quantile_interval(std::span<const Bucket> buckets, const RankInterval& ranks) {
  constexpr double kInfinity = std::numeric_limits<double>::infinity();
  if (buckets.empty()) return {kNaN, kNaN};
  const std::uint64_t n = buckets.back().up_to;
  return {ranks.low < 1 ? -kInfinity : bucket_of(buckets, ranks.low).lower,
          ranks.high > n ? kInfinity : bucket_of(buckets, ranks.high).upper};
}

Histogram histogram(std::span<const Bucket> buckets, std::size_t bins) {
  POESY_EXPECTS(bins >= 3 && !buckets.empty());
  const std::vector<double> even = even_edges(buckets, bins - 1);
  Histogram filled{{buckets.front().lower}, {}};
  std::uint64_t open = 0;  // number of values in the bin that is being filled
  const auto end_at = [&](double edge) {
    if (edge <= filled.edges.back()) return;  // the bin would have no width
    filled.edges.push_back(edge);
    filled.counts.push_back(std::exchange(open, 0));
  };
  auto next = even.begin();
  for (const Bucket& bucket : buckets) {
    for (; next != even.end() && *next <= bucket.lower; ++next) end_at(*next);
    open += bucket.count;
    const auto inside = next;
    while (next != even.end() && *next <= bucket.upper) ++next;
    if (next != inside) end_at(bucket.upper);
  }
  const double last = buckets.back().upper;
  end_at(last);
  filled.edges.resize(bins + 1, last);
  filled.counts.resize(bins, 0);
  filled.counts.back() += open;  // adds the remaining values, which exist if all values are the same
  return filled;
}

}  // namespace poesy
