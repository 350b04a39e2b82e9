#pragma once

#include <string>

#include "engine/study/study_file.h"

/// Study files of every kind; engine/study/study_file.h says what the functions do.

namespace poesy {

/// Reads a study file.
Study read_study(const std::string& path, const Catalog& catalog, StudyUse use);

/// The same for a study's text; `path` names it in messages.
Study study_of_text(const std::string& text, const std::string& path, const Catalog& catalog, StudyUse use,
                    const std::string* mechanism_text = nullptr);

/// A complete, commented study of this kind and mechanism.
std::string template_text(const CatalogEntry& entry, const StudyKind& kind);

/// The whole reference of study files, as Markdown.
std::string study_reference();

}  // namespace poesy
