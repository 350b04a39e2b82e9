#include "engine/stats/proportion.h"

#include <boost/math/special_functions/beta.hpp>
#include <cmath>

#include "engine/base/contract.h"
#include "engine/base/nan.h"

namespace poesy {

double proportion_at_least(std::uint64_t k, std::uint64_t n, double confidence) {
  POESY_EXPECTS(k <= n && confidence > 0.0 && confidence < 1.0);
  if (k == 0) return 0.0;
  const auto hits = static_cast<double>(k);
  const auto others = static_cast<double>(n - k);
  return boost::math::ibeta_inv(hits, others + 1.0, 1.0 - confidence);
}

double proportion_at_most(std::uint64_t k, std::uint64_t n, double confidence) {
  POESY_EXPECTS(k <= n && confidence > 0.0 && confidence < 1.0);
  if (k == n) return 1.0;
  const auto hits = static_cast<double>(k);
  const auto others = static_cast<double>(n - k);
  return boost::math::ibetac_inv(hits + 1.0, others, 1.0 - confidence);
}

Estimate proportion(std::uint64_t k, std::uint64_t n, double conf_level) {
  const double one_sided = 0.5 + 0.5 * conf_level;
  const double share = n == 0 ? kNaN : static_cast<double>(k) / static_cast<double>(n);
  return {share, {proportion_at_least(k, n, one_sided), proportion_at_most(k, n, one_sided)}};
}

std::uint64_t trials_without_failure(double share, double confidence) {
  POESY_EXPECTS(share > 0.0 && share < 1.0 && confidence > 0.0 && confidence < 1.0);
  return static_cast<std::uint64_t>(std::ceil(std::log1p(-confidence) / std::log(share)));
}

}  // namespace poesy
