#pragma once

#include <string>

#include "engine/model/catalog.h"

namespace poesy::app {

/// The mechanism of that name, in capitals or small letters. Throws InputError that lists the known ones.
const CatalogEntry& find_model(const std::string& name);

}  // namespace poesy::app
