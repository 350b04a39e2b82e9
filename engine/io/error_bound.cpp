#include "engine/io/error_bound.h"

#include <cmath>

namespace poesy {

std::optional<std::string> beyond_bound(const Model& model, FactorIndex factor, double size, std::string_view what) {
  const ErrorBound bound = model.error_bound(factor);
  if (std::abs(size) < bound.size) return std::nullopt;
  const Factor& named = model.description().factors[factor.value];
  return "gives " + named.name + " " + std::string(what) + " of " + readable_text({size, named.dimension}) +
         ", no less than " + bound.part + " (" + readable_text({bound.size, named.dimension}) + ")";
}

}  // namespace poesy
