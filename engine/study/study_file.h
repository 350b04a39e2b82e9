#pragma once

#include <span>
#include <string>

#include "engine/model/model.h"
#include "engine/schema/given_key.h"
#include "engine/study/study.h"

namespace poesy {

/// The purpose for which a study file is read, which determines the sections that must be complete.
enum class StudyUse {
  run,  ///< all sections must be complete
  /// [mechanism], [solver] and [poses] must be complete; other sections are treated as for `evaluate`.
  evaluate_at_poses,
  /// [mechanism] and [solver] must be complete. Other sections may be incomplete or absent, but what they state is
  /// checked; keys that belong to other kinds of study are no error, and a pose file is not opened.
  evaluate
};

struct StudyKinds;

/// Reads and validates a study file (TOML, format "poesy-study", version 1) of one of the kinds in `kinds`. Names of
/// files in the study are relative to the study's folder. given: values of keys that replace those of the file. Throws
/// InputError with file, line and column for a mistake in the content, and for a path that is a directory or a file
/// that is not text. Throws FileError if the file cannot be read.
Study read_study(const std::string& path, const Catalog& catalog, StudyUse use, const StudyKinds& kinds,
                 std::span<const GivenKey> given = {});

/// Reads the text of a study. path: name of the text in messages. mechanism_text: content that replaces the mechanism
/// file; null: the file is read. given: values of keys that replace those of the text. Throws as read_study() does.
Study study_of_text(const std::string& text, const std::string& path, const Catalog& catalog, StudyUse use,
                    const StudyKinds& kinds, const std::string* mechanism_text = nullptr,
                    std::span<const GivenKey> given = {});

/// The study as TOML with every default filled in. Reading the text gives the same study.
std::string resolved_text(const Study& study);

/// A complete study of this kind and mechanism, with comments, which runs unchanged. Precondition:
/// StudyKind::no_template is null or gives no reason for this mechanism.
std::string template_text(const CatalogEntry& entry, const StudyKind& kind, const StudyKinds& kinds);

std::string study_reference(const StudyKinds& kinds);  ///< The whole reference of study files, as Markdown.

}  // namespace poesy
