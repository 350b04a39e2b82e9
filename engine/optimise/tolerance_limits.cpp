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

double sigma_per_tolerance(const Spread& spread) {
  POESY_EXPECTS(spread.sigmas > 0.0 && spread.shift >= 0.0 && spread.shift < 1.0);
  return (1.0 - spread.shift) / spread.sigmas;
}

double mean_square_per_tolerance(const Spread& spread) {
  const double sigma = sigma_per_tolerance(spread);
  return sigma * sigma + spread.shift * spread.shift;
}

std::vector<double> part_effects(Stacking stacking, std::span<const double> error_effects, std::size_t errors,
                                 std::span<const DrawnPart> parts) {
  POESY_EXPECTS(errors > 0 && error_effects.size() % errors == 0);
  std::vector<double> effects;
  effects.reserve(error_effects.size() / errors * parts.size());
  for (std::size_t first = 0; first < error_effects.size(); first += errors) {
    for (const DrawnPart& part : parts) {
      double sum = 0.0;
      for (const std::size_t factor : part.factors) sum += error_effects[first + factor];
      effects.push_back(stacking == Stacking::worst_case ? sum : sum * mean_square_per_tolerance(part.spread));
    }
  }
  return effects;
}

}  // namespace poesy
