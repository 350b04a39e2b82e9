#include "engine/app/find_model.h"

#include "engine/base/error.h"
#include "models/registry.h"

namespace poesy::app {

const CatalogEntry& find_model(const std::string& name) {
  if (const CatalogEntry* entry = find(registry(), name)) return *entry;
  std::string known;
  for (const CatalogEntry& entry : registry()) known += (known.empty() ? "" : ", ") + entry.description.name;
  throw InputError({}, "no model '" + name + "'", "known models: " + known);
}

}  // namespace poesy::app
