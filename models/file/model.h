#pragma once

#include <string>

#include "engine/model/model.h"

namespace poesy::file {

/// The catalog entry of a mechanism from the text of its file. path: for messages. Throws InputError "FILE:LINE:COL:
/// ..." if the text does not describe a mechanism that its drives hold (mobility.h).
CatalogEntry catalog_entry(const std::string& text, const std::string& path);

/// The complete reference of mechanism files, as Markdown.
std::string key_reference();

}  // namespace poesy::file
