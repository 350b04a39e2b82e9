#include "models/registry.h"

#include "models/three_prs/model.h"
#include "models/two_upr_rpu/model.h"

namespace poesy {

const Catalog& registry() {
  static const Catalog catalog{two_upr_rpu::catalog_entry(), three_prs::catalog_entry(),
                               three_prs::machine_catalog_entry()};
  return catalog;
}

}  // namespace poesy
