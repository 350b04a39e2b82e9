#pragma once

#include <optional>
#include <string>

#include "engine/model/model.h"
#include "engine/result/result_file.h"
#include "engine/result/shard_file.h"
#include "engine/study/study.h"
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

/// A study as it was run, with the poses that it was run at.
struct StoredStudy {
  Study study;          ///< as resolved when it was run
  SelectedPoses poses;  ///< those of the result, whether the study's files still exist or not
};

/// Reads the resolved study that a shard keeps beside its poses. Nothing else is opened: a file of poses, of a
/// trajectory or of the mechanism need not exist any more, and the study's own pose selection is not to be asked for
/// poses. Throws FileError that names the file that keeps them, when this program cannot read the text, or the poses
/// are not of its mechanism.
StoredStudy stored_study(const StoredShard& shard, const Catalog& catalog);

/// The study of a result, with its poses; those that were rejected are not kept in memory.
StoredStudy stored_study(const StoredResult& result, const std::string& path, const Catalog& catalog);

/// The study of a result; none where this program cannot read it.
std::optional<Study> study_in(const StoredResult& result, const Catalog& catalog);

}  // namespace poesy
