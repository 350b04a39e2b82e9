#include "engine/study/outside_poses.h"

#include <fmt/format.h>

#include <algorithm>
#include <vector>

#include "engine/base/units.h"

namespace poesy {

std::optional<OutsidePose> outside_pose(const PoseSet& poses, const ModelDescription& model, double share) {
  for (std::size_t c = 0; c < model.pose_coordinates.size(); ++c) {
    const double width = model.pose_upper[c] - model.pose_lower[c];
    if (width <= 0.0) continue;  // a workspace of a single value says nothing about units or signs
    const double margin = share * width;
    const double lower = model.pose_lower[c] - margin;
    const double upper = model.pose_upper[c] + margin;
    const std::vector<double> values = poses.column(c);
    const auto at = std::ranges::find_if(values, [&](double value) { return value < lower || value > upper; });
    if (at != values.end()) return OutsidePose{static_cast<std::size_t>(at - values.begin()), c};
  }
  return std::nullopt;
}

std::string outside_clause(const OutsidePose& outside, const PoseSet& poses, const ModelDescription& model,
                           std::string (*text)(Quantity)) {
  const std::size_t c = outside.coordinate;
  const PoseCoordinate& coordinate = model.pose_coordinates[c];
  const auto words = [&](double si) { return text({si, coordinate.dimension}); };
  return fmt::format("pose {} has {} = {}, outside the workspace from {} to {}", outside.pose + 1, coordinate.name,
                     words(poses[PoseIndex(outside.pose)][c]), words(model.pose_lower[c]), words(model.pose_upper[c]));
}

std::string far_outside_clause(const PoseSet& poses, const ModelDescription& model) {
  const auto outside = outside_pose(poses, model, 1.0);
  if (!outside) return {};
  return outside_clause(*outside, poses, model, [](Quantity value) { return readable_text(value, 6); });
}

}  // namespace poesy
