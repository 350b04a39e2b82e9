#pragma once

#include <optional>
#include <string>

#include "engine/model/model.h"
#include "engine/result/result_file.h"
#include "engine/result/shard_file.h"
#include "engine/study/study.h"
#include "engine/study/study_file.h"

/// Study files of every kind; engine/study/study_file.h describes the functions.
namespace poesy {

/// Reads a study file.
Study read_study(const std::string& path, const Catalog& catalog, StudyUse use);

/// Reads the text of a study; `path` names it in messages.
Study study_of_text(const std::string& text, const std::string& path, const Catalog& catalog, StudyUse use,
                    const std::string* mechanism_text = nullptr);

/// A complete study of this kind and mechanism with comments.
std::string template_text(const CatalogEntry& entry, const StudyKind& kind);

/// The whole reference of study files, as Markdown.
std::string study_reference();

/// A study as it was run, with the poses that it was run at.
struct StoredStudy {
  Study study;          ///< as resolved when it was run
  SelectedPoses poses;  ///< the poses of the result, whether or not the study's files still exist
};

/// Reads the resolved study in a shard, with its poses. No other file is opened: files of poses, of a trajectory or of
/// the mechanism need not exist any more, and the study must not be asked to select poses again. Throws FileError,
/// which names the shard's file, if this program cannot read the text, or if the poses are not of its mechanism.
StoredStudy stored_study(const StoredShard& shard, const Catalog& catalog);

/// The study of a result with its poses, without the rejected ones.
StoredStudy stored_study(const StoredResult& result, const std::string& path, const Catalog& catalog);

/// The study of a result; none if this program cannot read it.
std::optional<Study> study_in(const StoredResult& result, const Catalog& catalog);

}  // namespace poesy
