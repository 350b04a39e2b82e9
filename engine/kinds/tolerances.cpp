#include "engine/kinds/tolerances.h"

#include <algorithm>

#include "engine/base/error.h"
#include "engine/kinds/registry.h"

namespace poesy {

std::string set_tolerances(const StoredResult& result, const TolerancesOptions& options, const Catalog& catalog,
                           std::size_t width) {
  const SetTolerances set = kind_of(result).set_tolerances;
  if (set != nullptr) return set(result, options, catalog, width);
  const auto has_tolerances = [](const Kind* kind) { return kind->set_tolerances != nullptr; };
  const std::string able((*std::ranges::find_if(kinds(), has_tolerances))->study.name);
  throw InputError({options.result}, "tolerances need indices, but this is a result of kind '" + result.kind + "'",
                   "give the result of a " + able + " study");
}

}  // namespace poesy
