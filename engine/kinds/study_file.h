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

/// Reads a study from this text. path: names the study in messages. mechanism_text: text of the mechanism's file; null:
/// the file is read.
Study study_of_text(const std::string& text, const std::string& path, const Catalog& catalog, StudyUse use,
                    const std::string* mechanism_text = nullptr);

/// Returns a complete study file of this kind for this mechanism, with comments.
std::string template_text(const CatalogEntry& entry, const StudyKind& kind);

/// The reference of all keys of study files, as Markdown.
std::string study_reference();

/// A study as it was run, with the poses at which it was run.
struct StoredStudy {
  Study study;          ///< the study, with all defaults filled in
  SelectedPoses poses;  ///< the poses at which the study was run, even if the files that list them no longer exist
};

/// Reads the study in a shard, with its poses. The study has all defaults filled in. No other file is opened, so files
/// of poses, of a trajectory or of the mechanism need not exist. Callers use the returned poses and do not select poses
/// again. Throws FileError with the shard's path if this program cannot read the text, or if the poses do not belong to
/// the mechanism.
StoredStudy stored_study(const StoredShard& shard, const Catalog& catalog);

/// Reads the study in a result, with its poses. The study has all defaults filled in. SelectedPoses::rejected is empty.
/// path: names the result in messages.
StoredStudy stored_study(const StoredResult& result, const std::string& path, const Catalog& catalog);

/// The study in a result, with all defaults filled in; none if this program cannot read the study.
std::optional<Study> study_in(const StoredResult& result, const Catalog& catalog);

}  // namespace poesy
