#include "engine/run/effect_poses.h"

#include <algorithm>

#include "engine/stats/main_effects.h"

namespace poesy {
namespace {

/// The sums of main effects at all poses together take at most about this number of bytes.
constexpr std::size_t kMostBytes = std::size_t{2} << 20U;

}  // namespace

std::vector<PoseIndex> effect_poses(std::size_t poses, std::size_t responses, std::size_t errors) {
  const std::size_t bytes = 2 * sizeof(double) * kEffectBins * std::max<std::size_t>(1, responses * errors);
  // Two poses fewer fit, because a study of machines also has such sums for the mean and for the largest magnitude over
  // all poses.
  const std::size_t fit = std::max<std::size_t>(kMostBytes / bytes, 3) - 2;
  const std::size_t count = std::min({poses, kMostEffectPoses, fit});
  std::vector<PoseIndex> list;
  for (std::size_t n = 0; n < count; ++n) list.emplace_back(n * poses / count);
  return list;
}

}  // namespace poesy
