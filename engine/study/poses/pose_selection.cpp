#include "engine/study/poses/pose_selection.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <functional>
#include <numeric>

#include "engine/random/low_discrepancy.h"
#include "engine/study/poses/workspace.h"

namespace poesy {
namespace {

/// The largest number of candidates that a search for this many poses examines.
std::size_t most_candidates(std::size_t count) { return std::max<std::size_t>(100'000, 100 * count); }

SelectedPoses interior_poses(const PoseSelection& selection, const Model& model, const WatchSearch& watch) {
  const Workspace workspace(selection, model);
  PoseCollector collector(workspace, selection.count, watch);
  SobolSequence sequence(workspace.coordinates());
  std::vector<double> scaled(workspace.coordinates());
  std::vector<double> pose(workspace.coordinates());
  const std::size_t most = most_candidates(selection.count);
  for (std::size_t candidate = 0; collector.kept() < selection.count; ++candidate) {
    if (candidate == most || collector.in_vain()) collector.fail(selection.place);
    sequence.next(scaled);
    workspace.unscale(scaled, pose);
    if (const auto condition = collector.test(pose)) collector.keep(pose, *condition);
  }
  return std::move(collector).result();
}

/// Adds all feasible points of a grid to an empty collector and returns it. The last coordinate changes fastest.
/// counts: the number of points along each coordinate.
PoseCollector grid_points(PoseCollector collector, std::span<const std::size_t> counts, const Workspace& workspace) {
  std::vector<double> scaled(counts.size());
  std::vector<double> pose(counts.size());
  const std::size_t points = std::accumulate(counts.begin(), counts.end(), std::size_t{1}, std::multiplies());
  for (std::size_t point = 0; point < points; ++point) {
    std::size_t rest = point;
    for (std::size_t c = counts.size(); c-- > 0; rest /= counts[c]) {
      const std::size_t step = rest % counts[c];
      scaled[c] = counts[c] == 1 ? 0.5 : static_cast<double>(step) / static_cast<double>(counts[c] - 1);
    }
    workspace.unscale(scaled, pose);
    if (const auto condition = collector.test(pose)) collector.keep(pose, *condition);
  }
  return collector;
}

/// The number of points of a grid with `number` points along each coordinate. If it exceeds `most`, the result is only
/// some number above `most`, because the exact number might overflow.
std::size_t grid_size(std::size_t number, std::size_t coordinates, std::size_t most) {
  std::size_t size = 1;
  for (std::size_t c = 0; c < coordinates && size <= most; ++c) size *= number;
  return size;
}

SelectedPoses grid_poses(const PoseSelection& selection, const Model& model, const WatchSearch& watch) {
  const Workspace workspace(selection, model);
  if (!selection.grid_counts.empty()) {
    PoseCollector points =
        grid_points(PoseCollector(workspace, selection.count, watch), selection.grid_counts, workspace);
    if (points.kept() == 0) points.fail(selection.place);
    return std::move(points).result();
  }
  const std::size_t most = most_candidates(selection.count);
  std::size_t number = 1;
  while (grid_size(number, workspace.coordinates(), most) < selection.count) ++number;
  std::size_t tested = 0;  // number of points of all grids so far, of which `feasible` are feasible
  std::size_t feasible = 0;
  for (;; ++number) {
    PoseCollector points = grid_points(PoseCollector(workspace, selection.count, watch, tested),
                                       std::vector<std::size_t>(workspace.coordinates(), number), workspace);
    tested += points.tested();
    feasible += points.kept();
    if (points.kept() >= selection.count) {
      points.thin_to(selection.count);
      return std::move(points).result();
    }
    const bool scarce = tested >= 2 * kMostInVain && 4 * feasible * most < selection.count * tested;
    if (scarce || points.out_of_reach() || grid_size(number + 1, workspace.coordinates(), most) > most)
      points.fail(selection.place);
  }
}

/// Returns the poses with the number of candidates set to 0, because the candidates that a boundary search rejects say
/// nothing about the workspace.
SelectedPoses without_candidates(SelectedPoses selected) {
  selected.candidates = 0;
  return selected;
}

SelectedPoses watched_poses(const PoseSelection& selection, const Model& model, const WatchSearch& watch) {
  using Select = PoseSelection::Select;
  switch (selection.select) {
    case Select::interior:
      return interior_poses(selection, model, watch);
    case Select::boundary:
      return without_candidates(boundary_poses(selection, model, watch));
    case Select::grid:
      return grid_poses(selection, model, watch);
    case Select::trajectory:
      return trajectory_poses(selection, model, watch);
    case Select::file:
      break;
  }
  return file_poses(selection, model, watch);
}

}  // namespace

bool some_out_of_reach(std::span<const RejectedPoses> rejected) {
  return std::ranges::any_of(rejected, [](const RejectedPoses& one) { return one.reason.starts_with(kOutOfReach); });
}

std::string end_of_reach_text(std::span<const RejectedPoses> rejected) {
  if (!some_out_of_reach(rejected)) return {};
  return "the mechanism does not reach all of the stated workspace, so poses of this boundary can be at the end of its "
         "reach, where small errors do much";
}

std::string rejected_text(std::span<const RejectedPoses> rejected, std::size_t candidates) {
  constexpr std::size_t kMost = 3;  // largest number of reasons in the sentence, without "out of reach"
  if (rejected.empty() || candidates == 0) return {};
  std::size_t all = 0;
  // the exact reason differs from pose to pose, so only the number of these poses is stated
  std::size_t out_of_reach = 0;
  std::size_t others = 0;
  std::vector<std::string> reasons;
  for (const RejectedPoses& one : rejected) {
    all += one.count;
    if (one.reason.starts_with(kOutOfReach)) {
      out_of_reach += one.count;
    } else if (reasons.size() < kMost) {
      reasons.push_back(fmt::format("{} {}", one.count, one.reason));
    } else {
      others += one.count;
    }
  }
  if (out_of_reach > 0) reasons.insert(reasons.begin(), fmt::format("{} out of reach", out_of_reach));
  if (others > 0) reasons.push_back(fmt::format("{} for other reasons", others));
  return fmt::format("{} of {} poses examined in the workspace {} not in this study: {}", all, candidates,
                     all == 1 ? "is" : "are", fmt::join(reasons, "; "));
}

std::optional<SelectedPoses> select_poses(const PoseSelection& selection, const Model& model,
                                          const WatchSearch& watch) {
  try {
    return watched_poses(selection, model, watch);
  } catch (const SearchStopped&) {
    return std::nullopt;
  }
}

SelectedPoses select_poses(const PoseSelection& selection, const Model& model) {
  return watched_poses(selection, model, {});
}

}  // namespace poesy
