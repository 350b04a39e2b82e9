#pragma once

#include <cstddef>
#include <vector>

#include "engine/base/index.h"

namespace poesy {

/// The largest number of poses at which main effects are summed. It is limited because each pose takes time and memory.
inline constexpr std::size_t kMostEffectPoses = 8;

/// The poses at which main effects are summed, evenly spaced over the order of the study's poses. There are fewer than
/// kMostEffectPoses if the sums would take more than about 2 MiB, but at least one if the study has poses.
std::vector<PoseIndex> effect_poses(std::size_t poses, std::size_t responses, std::size_t errors);

}  // namespace poesy
