#pragma once

#include <string>

#include "engine/model/model.h"
#include "engine/study/study.h"

namespace poesy {

/// Which parts of a study a command needs.
enum class StudyUse {
  run,      ///< all sections complete
  evaluate  ///< [mechanism] and [solver]; others are checked if present but may be incomplete or absent, keys of
            ///< other kinds are ignored, and a pose file is not opened
};

struct StudyKinds;

/// Reads and validates a study file (TOML, format "poesy-study", version 1) of one of these kinds. A pose file is found
/// relative to the study's folder. Throws InputError with file, line and column for everything that is wrong with its
/// content (also for a directory or a file that is not text), FileError if the file cannot be read.
Study read_study(const std::string& path, const Catalog& catalog, StudyUse use, const StudyKinds& kinds);

/// Reads the text of a study; `path` names it in messages. mechanism_text: the content of the mechanism file, used
/// instead of the present file; null: the file is read.
Study study_of_text(const std::string& text, const std::string& path, const Catalog& catalog, StudyUse use,
                    const StudyKinds& kinds, const std::string* mechanism_text = nullptr);

/// The study with every default filled in, as TOML that reads back to the same study.
std::string resolved_text(const Study& study);

/// A complete study of this kind and mechanism, with comments, which runs unchanged. Precondition: there is a template
/// for the mechanism (StudyKind::no_template).
std::string template_text(const CatalogEntry& entry, const StudyKind& kind, const StudyKinds& kinds);

std::string study_reference(const StudyKinds& kinds);  ///< The whole reference of study files, as Markdown.

}  // namespace poesy
