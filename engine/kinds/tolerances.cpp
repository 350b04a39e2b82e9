#include "engine/kinds/tolerances.h"

#include "engine/base/error.h"
#include "engine/kinds/result_kinds.h"

namespace poesy {

std::string set_tolerances(const StoredResult& result, const TolerancesOptions& options, const Catalog& catalog,
                           std::size_t width) {
  const SetTolerances set = kind_of(result).set_tolerances;
  if (set != nullptr) return set(result, options, catalog, width);
  throw InputError({options.result}, "tolerances need indices, but this is a result of kind '" + result.kind + "'",
                   "give the result of a sensitivity study");
}

}  // namespace poesy
