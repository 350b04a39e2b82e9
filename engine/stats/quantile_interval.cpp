#include "engine/stats/quantile_interval.h"

#include <algorithm>
#include <boost/math/distributions/binomial.hpp>
#include <limits>

#include "engine/base/contract.h"
#include "engine/base/nan.h"

namespace poesy {
namespace {

namespace policies = boost::math::policies;
/// A quantile of it is the smallest k with P(B <= k) >= p.
using Binomial =
    boost::math::binomial_distribution<double,
                                       policies::policy<policies::discrete_quantile<policies::integer_round_up>>>;

/// Precondition: 1 <= rank <= number of values.
const Bucket& bucket_of(std::span<const Bucket> buckets, std::uint64_t rank) {
  return *std::ranges::lower_bound(buckets, rank, {}, &Bucket::up_to);
}

}  // namespace

RankInterval quantile_ranks(std::uint64_t n, double q, double conf_level) {
  POESY_EXPECTS(q > 0.0 && q < 1.0 && conf_level > 0.0 && conf_level < 1.0);
  if (n == 0) return {0, 1};
  const Binomial below(static_cast<double>(n), q);
  const double beyond = 0.5 * (1.0 - conf_level);
  // P(B < low) < beyond and P(B >= high) <= beyond.
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

}  // namespace poesy
