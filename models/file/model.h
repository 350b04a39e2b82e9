#pragma once

#include <string>

#include "engine/model/model.h"

namespace poesy::file {

/// A mechanism from the text of its file, as a study may name it. `path` is for messages.
/// Throws InputError "FILE:LINE:COL: ..." where the text describes no mechanism that its drives hold (mobility.h).
CatalogEntry catalog_entry(const std::string& text, const std::string& path);

/// The whole reference of mechanism files, as Markdown.
std::string reference();

}  // namespace poesy::file
