#pragma once

#include <cstddef>
#include <vector>

#include "engine/base/index.h"

namespace poesy {

/// Main effects are added up pose by pose at no more poses than this, because that takes time and memory at each.
inline constexpr std::size_t kMostEffectPoses = 8;

/// The poses at which main effects of so many errors on so many responses are added up: evenly spaced over the order of
/// the study's poses; fewer where they would take more than a few megabytes, but one if there is any.
std::vector<PoseIndex> effect_poses(std::size_t poses, std::size_t responses, std::size_t errors);

}  // namespace poesy
