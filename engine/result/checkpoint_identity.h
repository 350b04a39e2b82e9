#pragma once

#include <optional>

#include "engine/run/shard.h"
#include "engine/storage/checkpoint.h"
#include "engine/study/poses/pose_selection.h"
#include "engine/study/study.h"

namespace poesy {

/// The identity of a run of this program, of the whole study or of one shard. It leaves out what a later run may change
/// in the study: title, seed, samples (except for a kind that decides by them), max_not_converged and, unless errors
/// are drawn per machine, limits.
CheckpointIdentity identity_of(const Study& study, const PoseSet& poses,
                               const std::optional<Shard>& shard = std::nullopt);

}  // namespace poesy
