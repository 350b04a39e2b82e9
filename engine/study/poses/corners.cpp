#include "engine/study/poses/corners.h"

#include <cstddef>
#include <utility>
#include <vector>

#include "engine/study/poses/workspace.h"

namespace poesy {

PoseSet feasible_corners(const PoseSelection& selection, const Model& model) {
  constexpr std::size_t kMostCoordinates = 8;
  const Workspace workspace(selection, model);
  const std::size_t coordinates = workspace.coordinates();
  if (coordinates == 0 || coordinates > kMostCoordinates) return {};
  std::vector<double> values;
  std::vector<double> scaled(coordinates);
  std::vector<double> pose(coordinates);
  for (std::size_t corner = 0; corner < std::size_t{1} << coordinates; ++corner) {
    for (std::size_t c = 0; c < coordinates; ++c) scaled[c] = (corner >> (coordinates - 1 - c)) & 1U ? 1.0 : 0.0;
    workspace.unscale(scaled, pose);
    if (workspace.judge(pose).feasible()) values.insert(values.end(), pose.begin(), pose.end());
  }
  return {coordinates, std::move(values)};
}

}  // namespace poesy
