#pragma once

#include <cstddef>
#include <map>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "engine/study/poses/pose_selection.h"

namespace poesy {

/// Says whether a pose of the box is feasible, and if it is not, gives the reason.
struct Judgement {
  double condition = 0.0;  ///< condition number of a feasible pose
  std::string reason;      ///< reason why the pose is not feasible; empty if it is
  /// Place in the study of the limit that refuses the pose; null if the pose is feasible.
  const Place* place = nullptr;
  std::string_view remedy;  ///< advice on how to make such poses feasible

  bool feasible() const { return reason.empty(); }  ///< Returns true if the pose is feasible.
};

/// The box of a selection and its feasible poses. Scaled coordinates go from 0 to 1 over each range of the box.
class Workspace {
 public:
  /// Both arguments must outlive the workspace.
  Workspace(const PoseSelection& selection, const Model& model) : selection_(&selection), model_(&model) {}

  std::size_t coordinates() const { return selection_->workspace.size(); }  ///< The number of coordinates of a pose.
  /// Converts scaled coordinates in [0, 1] to a pose in SI, both [coordinates]. 0 and 1 give the ends of the ranges
  /// exactly.
  void unscale(std::span<const double> scaled, std::span<double> pose) const;
  /// Converts one coordinate of a pose (SI) to its scaled coordinate.
  double scaled(std::size_t coordinate, double value) const;
  Judgement judge(std::span<const double> pose) const;  ///< Tells whether a pose, [coordinates] in SI, is feasible.

 private:
  const PoseSelection* selection_;
  const Model* model_;
};

/// Ends a search that the watcher stopped; select_poses() catches it.
struct SearchStopped {};

/// Reports the progress of a search, if watch is not empty. Throws SearchStopped if watch returns false.
void tell(const WatchSearch& watch, const PoseSearch& search);

/// A search gives up after this many candidates in a row without a feasible one.
inline constexpr std::size_t kMostInVain = 50'000;

/// Collects feasible poses, and counts infeasible ones by reason.
class PoseCollector {
 public:
  /// Refers to both arguments. wanted: number of poses to find; before: number of candidates that the search examined
  /// earlier.
  PoseCollector(const Workspace& workspace, std::size_t wanted, const WatchSearch& watch, std::size_t before = 0)
      : workspace_(&workspace), watch_(&watch), wanted_(wanted), before_(before) {}

  /// Examines a candidate. Returns the condition number of a feasible pose; otherwise counts the reason and returns
  /// none. Throws SearchStopped.
  std::optional<double> test(std::span<const double> pose);
  void keep(std::span<const double> pose, double condition);  ///< Adds a feasible pose and its condition number.

  std::size_t kept() const { return condition_.size(); }  ///< The number of poses that are kept.
  std::size_t tested() const { return tested_; }          ///< The number of candidates that were examined here.
  /// Returns true if the last kMostInVain candidates were all infeasible.
  bool in_vain() const { return in_vain_ >= kMostInVain; }
  std::span<const double> pose(std::size_t m) const;  ///< The m-th pose that was kept, SI.
  void keep_first(std::size_t count);                 ///< Keeps only the first `count` poses.
  /// Keeps `count` of the poses, evenly spread over their order. Precondition: count <= kept().
  void thin_to(std::size_t count);
  /// Throws the InputError that the box gives fewer poses than wanted. workspace_place: used if no limit rejected
  /// poses.
  [[noreturn]] void fail(const Place& workspace_place) const;
  SelectedPoses result() &&;  ///< The kept poses, and the numbers of rejected ones by reason, most frequent first.

 private:
  struct Count {
    std::size_t count = 0;
    Judgement last;
  };

  const Workspace* workspace_;
  const WatchSearch* watch_;
  std::size_t wanted_;
  std::size_t before_;
  std::vector<double> values_;
  std::vector<double> condition_;
  std::map<std::string, Count> rejected_;
  std::size_t tested_ = 0;
  std::size_t in_vain_ = 0;  ///< candidates since the last feasible one
};

/// The poses of a selection from a file; see select_poses().
SelectedPoses file_poses(const PoseSelection& selection, const Model& model, const WatchSearch& watch = {});

/// The poses of a selection along a trajectory, with their times; see select_poses().
SelectedPoses trajectory_poses(const PoseSelection& selection, const Model& model, const WatchSearch& watch = {});

/// Finds the first `count` poses of a sequence that is uniform by area on the boundary of the feasible set. The
/// boundary includes parts of the box's faces. Area is measured in coordinates scaled to the box (each range is [0,
/// 1]), because metres and radians have no common measure. Works for any number of coordinates C; for C = 1 the
/// boundary consists of the ends of intervals.
///
/// Random lines, distributed by the kinematic measure, meet a surface in points that are uniform by area (Crofton). A
/// shifted Sobol' sequence generates such lines. Their direction is uniform, and their offset from the cube's centre is
/// uniform in a ball of dimension C - 1 that covers the cube. Every point where a line crosses the boundary of the
/// feasible set is a pose. The chord of a line in the box is scanned in 32 intervals. If feasibility differs at the
/// ends of an interval, bisection refines the crossing to rounding and keeps the feasible side. A pose on a face of the
/// box is exactly on it. The scan may miss a feasible piece or gap shorter than an interval, and it leaves out a piece
/// shorter than rounding. Counts of rejected poses include the points of the scans.
///
/// Throws InputError if max(20 000, 100 count) lines do not give enough poses, if kMostInVain scanned points in a row
/// give no pose, or if poses coincide up to rounding.
SelectedPoses boundary_poses(const PoseSelection& selection, const Model& model, const WatchSearch& watch = {});

}  // namespace poesy
