#pragma once

#include <algorithm>
#include <cstddef>

#include "engine/base/index.h"

namespace poesy {

/// The most poses at which a sensitivity study is checked a second time.
inline constexpr std::size_t kSomePoses = 32;

/// The number of such poses in a study with this many poses.
constexpr std::size_t some_poses(std::size_t poses) { return std::min(kSomePoses, poses); }

/// The n-th of them: evenly spaced over the order of the study's poses. Precondition: n < some_poses(poses).
constexpr PoseIndex some_pose(std::size_t n, std::size_t poses) { return PoseIndex(n * poses / some_poses(poses)); }

}  // namespace poesy
