#include "engine/app/find_model.h"

#include "engine/base/error.h"
#include "engine/base/text.h"
#include "models/registry.h"

namespace poesy::app {

const CatalogEntry& find_model(const std::string& name) {
  if (const CatalogEntry* entry = find(registry(), name)) return *entry;
  std::vector<std::string_view> known;
  for (const CatalogEntry& entry : registry()) known.push_back(entry.description.name);
  throw InputError({}, "no model '" + printable(name) + "'", suggestion(lower_case(name), known));
}

}  // namespace poesy::app
