#include "engine/result/checkpoint_identity.h"

#include "engine/base/bytes.h"
#include "engine/storage/content_hash.h"
#include "engine/storage/version.h"
#include "engine/study/study_file.h"
#include "engine/study/study_kind.h"

namespace poesy {
namespace {

std::string hash_of(const PoseSet& poses) {
  ByteWriter bytes;
  bytes.number(poses.size());
  for (std::size_t m = 0; m < poses.size(); ++m) bytes.reals(poses[PoseIndex(m)]);
  return hex(sha256(bytes.take()));
}

}  // namespace

CheckpointIdentity identity_of(const Study& study, const PoseSet& poses, const std::optional<Shard>& shard) {
  Study rest = study;
  rest.seed = 0;
  rest.title.clear();
  rest.max_not_converged = 1.0;  // may differ, because it is checked only at the end of a run
  // Limits that are applied only at the end of a run may differ: limits on magnitudes, if errors are drawn per pose.
  // All other limits are needed during the run, to judge machines, or to keep the draws near the ends of a limit on
  // signed values.
  if (study.analysis.draws == Draws::per_pose) {
    std::erase_if(rest.analysis.limits, [](const ResponseLimit& limit) { return limit.allowed.is_magnitude(); });
  }
  if (!study.analysis.kind->decides_by_samples) rest.analysis.samples = 0;
  return {.poesy_version = poesy_version(),
          .git_commit = git_commit(),
          .model = study.model().name,
          .seed = study.seed,
          .samples = study.analysis.samples,
          .study = resolved_text(rest) + (study.mechanism.file ? study.mechanism.file->text : ""),
          .poses = hash_of(poses),
          .shard = shard ? to_string(*shard) : ""};
}

}  // namespace poesy
