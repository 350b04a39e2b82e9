#pragma once

#include <optional>
#include <span>
#include <string>

#include "engine/model/model.h"
#include "engine/result/result_file.h"
#include "engine/result/shard_file.h"
#include "engine/study/study.h"
#include "engine/study/study_file.h"

/// Functions that read and describe study files of every kind; engine/study/study_file.h has the full descriptions.
namespace poesy {

/// Reads a study file.
Study read_study(const std::string& path, const Catalog& catalog, StudyUse use, std::span<const GivenKey> given = {});

/// Reads the text of a study; `path` names it in messages.
Study study_of_text(const std::string& text, const std::string& path, const Catalog& catalog, StudyUse use,
                    const std::string* mechanism_text = nullptr);

/// A complete study file for this kind and mechanism, with comments.
std::string template_text(const CatalogEntry& entry, const StudyKind& kind);

/// The reference of all keys of study files, as Markdown.
std::string study_reference();

/// A study as it was run, with the poses that it was run at.
struct StoredStudy {
  Study study;          ///< the study, with all defaults filled in
  SelectedPoses poses;  ///< the poses of the result, even if the study's files no longer exist
};

/// Reads the study in a shard, which has all defaults filled in, with its poses. Opens no other file: files of poses,
/// of a trajectory or of the mechanism need not exist. Use the poses that are returned; do not select poses from the
/// study again. Throws FileError with the shard's path if this program cannot read the text, or if the poses do not
/// belong to the mechanism.
StoredStudy stored_study(const StoredShard& shard, const Catalog& catalog);

/// The study in a result, which has all defaults filled in, with its poses. Rejected poses are not listed. path: names
/// the result in messages.
StoredStudy stored_study(const StoredResult& result, const std::string& path, const Catalog& catalog);

/// The study in a result, which has all defaults filled in; none if this program cannot read it.
std::optional<Study> study_in(const StoredResult& result, const Catalog& catalog);

}  // namespace poesy
