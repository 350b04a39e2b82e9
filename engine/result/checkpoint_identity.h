#pragma once

#include <optional>

#include "engine/run/shard.h"
#include "engine/storage/checkpoint.h"
#include "engine/study/poses/pose_selection.h"
#include "engine/study/study.h"

namespace poesy {

/// The identity of a run of the whole study, or of one shard, by this program. Its text of the study leaves out title
/// and max_not_converged, which a later run may change, and, if errors are drawn per pose, limits on magnitudes. It
/// also leaves out the seed and the number of samples, which are separate members; for a kind with
/// StudyKind::decides_by_samples, the text keeps the number of samples.
CheckpointIdentity identity_of(const Study& study, const PoseSet& poses,
                               const std::optional<Shard>& shard = std::nullopt);

}  // namespace poesy
