#include "models/registry.h"

#include "models/file/model.h"
#include "models/three_prs/model.h"
#include "models/two_upr_rpu/model.h"

namespace poesy {

const Catalog& registry() {
  static const Catalog catalog = [] {
    Catalog all{two_upr_rpu::catalog_entry(), three_prs::catalog_entry(), three_prs::machine_catalog_entry()};
    all.from_text = file::catalog_entry;
    all.file_reference = file::key_reference;
    return all;
  }();
  return catalog;
}

}  // namespace poesy
