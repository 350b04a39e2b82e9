#pragma once

#include <optional>

#include "engine/run/shard.h"
#include "engine/storage/checkpoint.h"
#include "engine/study/poses/pose_selection.h"
#include "engine/study/study.h"

namespace poesy {

/// The identity of a run of the whole study, or of one shard, by this program. It leaves out what a later run may
/// change in the study: title, seed, max_not_converged, samples (except for a kind that decides by them) and, if errors
/// are drawn per pose, limits on magnitudes.
CheckpointIdentity identity_of(const Study& study, const PoseSet& poses,
                               const std::optional<Shard>& shard = std::nullopt);

}  // namespace poesy
