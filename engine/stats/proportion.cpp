#include "engine/stats/proportion.h"

#include <algorithm>
#include <boost/math/special_functions/beta.hpp>
#include <cmath>

#include "engine/base/contract.h"
#include "engine/base/nan.h"

namespace poesy {
namespace {

// With double arithmetic, the relative error of a bound is 1e-13 for a million trials and 5e-12 for 1e10 trials. Double
// arithmetic takes a seventh of the time of long double, Boost's default.
using InDouble = boost::math::policies::policy<boost::math::policies::promote_double<false>>;

}  // namespace

double proportion_at_least(std::uint64_t k, std::uint64_t n, double confidence) {
  POESY_EXPECTS(k <= n && confidence > 0.0 && confidence < 1.0);
  if (k == 0) return 0.0;
  const auto hits = static_cast<double>(k);
  const auto others = static_cast<double>(n - k);
  return boost::math::ibeta_inv(hits, others + 1.0, 1.0 - confidence, InDouble{});
}

double proportion_at_most(std::uint64_t k, std::uint64_t n, double confidence) {
  POESY_EXPECTS(k <= n && confidence > 0.0 && confidence < 1.0);
  if (k == n) return 1.0;
  const auto hits = static_cast<double>(k);
  const auto others = static_cast<double>(n - k);
  return boost::math::ibetac_inv(hits + 1.0, others, 1.0 - confidence, InDouble{});
}

Estimate proportion(std::uint64_t k, std::uint64_t n, double conf_level) {
  const double one_sided = 0.5 + 0.5 * conf_level;
  const double share = n == 0 ? kNaN : static_cast<double>(k) / static_cast<double>(n);
  return {share, {proportion_at_least(k, n, one_sided), proportion_at_most(k, n, one_sided)}};
}

Estimate paired_change(std::uint64_t gained, std::uint64_t lost, std::uint64_t n, double conf_level) {
  POESY_EXPECTS(gained <= n && lost <= n - gained);
  if (n == 0) return {kNaN, {-1.0, 1.0}};
  const auto more = static_cast<double>(gained);
  const auto fewer = static_cast<double>(lost);
  const double all = static_cast<double>(n) + 2.0;
  const double centre = (more - fewer) / all;
  const double spread = (more + fewer + 1.0) / all - centre * centre;
  const double half = two_sided_normal_quantile(conf_level) * std::sqrt(spread / all);
  return {(more - fewer) / static_cast<double>(n), {std::max(centre - half, -1.0), std::min(centre + half, 1.0)}};
}

std::uint64_t trials_without_failure(double share, double confidence) {
  POESY_EXPECTS(share > 0.0 && share < 1.0 && confidence > 0.0 && confidence < 1.0);
  return static_cast<std::uint64_t>(std::ceil(std::log1p(-confidence) / std::log(share)));
}

}  // namespace poesy
