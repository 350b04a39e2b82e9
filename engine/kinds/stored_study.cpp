#include "engine/kinds/stored_study.h"

#include <utility>

#include "engine/base/error.h"
#include "engine/kinds/study_file.h"

namespace poesy {
namespace {

constexpr const char* kOther = "use the poesy that wrote it";

Study study_of_stored_text(const std::string& text, const std::string& path, const Catalog& catalog) {
  try {
    return study_of_text(text, "its study", catalog, StudyUse::evaluate);
  } catch (const InputError& error) {
    throw FileError(path, std::string("keeps a study that this program cannot read: ") + error.what(), kOther);
  }
}

}  // namespace

StoredStudy stored_study(const std::string& resolved_text, SelectedPoses poses, const std::string& path,
                         const Catalog& catalog) {
  StoredStudy stored{study_of_stored_text(resolved_text, path, catalog), std::move(poses)};
  if (stored.poses.poses.coordinates() != stored.study.model().pose_coordinates.size()) {
    throw FileError(path, "keeps poses that are not of its mechanism", kOther);
  }
  return stored;
}

StoredStudy stored_study(const StoredResult& result, const std::string& path, const Catalog& catalog) {
  SelectedPoses poses{.poses = result.poses, .condition = result.condition, .rejected = {}, .time = result.time};
  return stored_study(result.study_text, std::move(poses), path, catalog);
}

std::optional<Study> study_in(const StoredResult& result, const Catalog& catalog) {
  try {
    return study_of_text(result.study_text, "the study in the result", catalog, StudyUse::evaluate);
  } catch (const InputError&) {
    return std::nullopt;
  }
}

}  // namespace poesy
