#include "engine/optimise/tolerance_limits.h"

#include <limits>

#include "engine/base/contract.h"

namespace poesy {

double ToleranceLimits::need(std::size_t l, std::span<const double> tolerance) const {
  double sum = 0.0;
  const std::span<const double> effect = row(l);
  for (std::size_t i = 0; i < parts; ++i) sum += effect[i] * size_of(tolerance[i], stacking);
  return sum;
}

LimitUse worst_use(const ToleranceLimits& limits, std::span<const double> tolerance) {
  POESY_EXPECTS(limits.count() > 0 && tolerance.size() == limits.parts);
  LimitUse worst{0, -1.0};
  for (std::size_t l = 0; l < limits.count(); ++l) {
    const double room = limits.room[l];
    const double share = room > 0.0 ? limits.need(l, tolerance) / room : std::numeric_limits<double>::infinity();
    if (share > worst.share) worst = {l, share};
  }
  return worst;
}

}  // namespace poesy
