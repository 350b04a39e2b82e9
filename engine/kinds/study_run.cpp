#include "engine/kinds/study_run.h"

#include <string>

#include "engine/base/error.h"
#include "engine/kinds/drawing_study.h"
#include "engine/kinds/registry.h"
#include "engine/study/study_file.h"

namespace poesy {

std::optional<StudyResult> run_study(const Study& study, const Model& model, const PoseSet& poses,
                                     const RunOptions& options) {
  Checkpoints not_kept;
  RunOptions with_checkpoints = options;
  if (options.checkpoints == nullptr) with_checkpoints.checkpoints = &not_kept;
  const StudyRun run{.study = study, .model = model, .poses = poses, .options = with_checkpoints};
  const RunKind& kind = kind_of(study).run;
  std::optional<StudyResult> result = kind.run(run);
  // A kind with RunKind::confirms changes the tolerances, so the study's own drawing would not describe the result.
  if (result && !kind.confirms) result->drawing = drawing_result(run);
  return result;
}

std::optional<StudyResult> run_study(const Study& study, const RunOptions& options) {
  const std::unique_ptr<Model> model = build_model(study.mechanism);
  return run_study(study, *model, select_poses(study.poses, *model).poses, options);
}

void check_shard(const Shard& shard, const Study& study, std::size_t poses) {
  const auto most_shards = kind_of(study).run.most_shards;
  if (most_shards == nullptr) {
    throw InputError({},
                     "--shard divides no study of kind " + std::string(study.analysis.kind->name) +
                         ", each step of which needs all poses of the one before",
                     "run it whole, or with mpirun");
  }
  if (study.analysis.adaptive) {
    throw InputError(
        {}, "--shard divides no study with adaptive samples: when an error has enough is decided over all poses",
        "write samples = N, or run it with mpirun");
  }
  if (const std::size_t most = most_shards(study, poses); shard.count > most) {
    throw InputError({},
                     "--shard asks for " + std::to_string(shard.count) + " shards, but this study divides into " +
                         std::to_string(most) + " at most",
                     "take fewer shards");
  }
}

Outlook outlook(const Study& study, const Model& model, const PoseSet& poses) {
  // Bytes of a result file that contains no numbers yet: about 90 HDF5 datasets and groups, with their attributes.
  constexpr std::size_t kEmptyFile = 55'000;
  Outlook expected = kind_of(study).run.outlook(study, model, poses);
  expected.memory.file += kEmptyFile + resolved_text(study).size();
  return expected;
}

}  // namespace poesy
