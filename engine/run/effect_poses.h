#pragma once

#include <cstddef>
#include <vector>

#include "engine/base/index.h"

namespace poesy {

/// The largest number of poses at which a Monte Carlo study computes main effects, which take time and memory.
inline constexpr std::size_t kMostEffectPoses = 8;

/// The poses at which main effects are computed, evenly spaced in the list of the study's poses. There are fewer than
/// kMostEffectPoses if the sums for them would take more than about 2 MiB, but at least one. errors: number of errors
/// that vary.
std::vector<PoseIndex> effect_poses(std::size_t poses, std::size_t responses, std::size_t errors);

}  // namespace poesy
