#include "engine/kinds/allocation/drawn_part.h"

#include "engine/base/contract.h"

namespace poesy::allocation {

double sigma_per_tolerance(const Spread& spread) {
  POESY_EXPECTS(spread.sigmas > 0.0 && spread.shift >= 0.0 && spread.shift < 1.0);
  return (1.0 - spread.shift) / spread.sigmas;
}

double mean_square_per_tolerance(const Spread& spread) {
  const double sigma = sigma_per_tolerance(spread);
  return sigma * sigma + spread.shift * spread.shift;
}

std::vector<double> part_effects(std::span<const double> error_effects, std::size_t errors,
                                 std::span<const DrawnPart> parts) {
  POESY_EXPECTS(errors > 0 && error_effects.size() % errors == 0);
  std::vector<double> effects;
  effects.reserve(error_effects.size() / errors * parts.size());
  for (std::size_t first = 0; first < error_effects.size(); first += errors) {
    for (const DrawnPart& part : parts) {
      double effect = 0.0;
      for (const auto& [list, mean_square] : part.groups) {
        double sum = 0.0;
        for (const std::size_t error : list) sum += error_effects[first + error];
        effect += sum * mean_square;
      }
      effects.push_back(effect);
    }
  }
  return effects;
}

}  // namespace poesy::allocation
