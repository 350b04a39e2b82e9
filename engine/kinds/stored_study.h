#pragma once

#include <optional>
#include <string>

#include "engine/files/result_file.h"
#include "engine/model/catalog.h"
#include "engine/study/study.h"

namespace poesy {

/// A study as it was run, with the poses that it was run at.
struct StoredStudy {
  Study study;          ///< as resolved when it was run
  SelectedPoses poses;  ///< those of the result, whether the study's files still exist or not
};

/// Reads a resolved study that is kept beside its poses. Nothing else is opened: a file of poses or of a trajectory
/// need not exist any more, and the study's own pose selection is not to be asked for poses.
/// Throws FileError that names `path`, the file that keeps them, when this program cannot read the text, or the poses
/// are not of its mechanism.
StoredStudy stored_study(const std::string& resolved_text, SelectedPoses poses, const std::string& path,
                         const Catalog& catalog);

/// The study of a result, with its poses; those that were rejected are not kept in memory.
StoredStudy stored_study(const StoredResult& result, const std::string& path, const Catalog& catalog);

/// The study of a result; none where this program cannot read it.
std::optional<Study> study_in(const StoredResult& result, const Catalog& catalog);

}  // namespace poesy
