#include "engine/kinds/study_file.h"

#include <utility>

#include "engine/base/error.h"
#include "engine/kinds/registry.h"

namespace poesy {

Study read_study(const std::string& path, const Catalog& catalog, StudyUse use, std::span<const GivenKey> given) {
  return read_study(path, catalog, use, study_kinds(), given);
}

Study study_of_text(const std::string& text, const std::string& path, const Catalog& catalog, StudyUse use,
                    const std::string* mechanism_text) {
  return study_of_text(text, path, catalog, use, study_kinds(), mechanism_text);
}

std::string template_text(const CatalogEntry& entry, const StudyKind& kind) {
  return template_text(entry, kind, study_kinds());
}

std::string study_reference() { return study_reference(study_kinds()); }

namespace {

/// Reads a study and its mechanism from these texts, and returns them with the poses. path: the file that contains the
/// texts, for messages.
StoredStudy stored_study(const std::string& text, const std::string& mechanism, SelectedPoses poses,
                         const std::string& path, const Catalog& catalog) {
  constexpr const char* kOther = "use the poesy that wrote it";
  try {
    StoredStudy stored{study_of_text(text, "its study", catalog, StudyUse::evaluate, &mechanism), std::move(poses)};
    if (stored.poses.poses.coordinates() == stored.study.model().pose_coordinates.size()) return stored;
  } catch (const InputError& error) {
    throw FileError(path, std::string("keeps a study that this program cannot read: ") + error.what(), kOther);
  }
  throw FileError(path, "keeps poses that are not of its mechanism", kOther);
}

}  // namespace

StoredStudy stored_study(const StoredShard& shard, const Catalog& catalog) {
  return stored_study(shard.study_text, shard.mechanism_text, shard.poses, shard.path, catalog);
}

StoredStudy stored_study(const StoredResult& result, const std::string& path, const Catalog& catalog) {
  SelectedPoses poses{
      .poses = result.poses, .condition = result.condition, .rejected = {}, .candidates = 0, .time = result.time};
  return stored_study(result.study_text, result.mechanism_text, std::move(poses), path, catalog);
}

std::optional<Study> study_in(const StoredResult& result, const Catalog& catalog) {
  try {
    return study_of_text(result.study_text, "the study in the result", catalog, StudyUse::evaluate,
                         &result.mechanism_text);
  } catch (const InputError&) {
    return std::nullopt;
  }
}

}  // namespace poesy
