#include "engine/study/poses/corners.h"

#include <cstddef>

#include "engine/base/error.h"

namespace poesy {

PoseSet feasible_corners(const PoseSelection& selection, const Model& model) {
  constexpr std::size_t kMostCoordinates = 8;
  const std::size_t coordinates = selection.workspace.size();
  if (coordinates == 0 || coordinates > kMostCoordinates) return {};
  PoseSelection corners = selection;
  corners.select = PoseSelection::Select::grid;
  corners.grid_counts.assign(coordinates, 2);
  corners.count = std::size_t{1} << coordinates;
  try {
    return select_poses(corners, model).poses;
  } catch (const InputError&) {  // no corner is feasible
    return {};
  }
}

}  // namespace poesy
