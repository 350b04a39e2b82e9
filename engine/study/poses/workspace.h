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

/// The result of Workspace::judge(): whether a pose is feasible and, if it is not, why.
struct Judgement {
  double condition = 0.0;  ///< condition number of a feasible pose
  std::string reason;      ///< reason why the pose is not feasible; empty for a feasible pose
  /// Place in the study of the joint limit that rejects the pose, or of the selection if no joint limit does; null for
  /// a feasible pose.
  const Place* place = nullptr;
  std::string_view remedy;  ///< advice on how to make such poses feasible

  bool feasible() const { return reason.empty(); }  ///< Returns true if the pose is feasible.
};

/// The box of a selection (PoseSelection::workspace), with the rules for feasible poses. Scaled coordinates go from 0
/// to 1 over each range of the box.
class Workspace {
 public:
  /// Both arguments must outlive the workspace.
  Workspace(const PoseSelection& selection, const Model& model) : selection_(&selection), model_(&model) {}

  std::size_t coordinates() const { return selection_->workspace.size(); }  ///< The number of coordinates of a pose.
  /// Converts scaled coordinates, each in [0, 1], to a pose in SI. The scaled coordinates 0 and 1 give the ends of the
  /// ranges exactly.
  void unscale(std::span<const double> scaled, std::span<double> pose) const;
  /// Converts one coordinate of a pose (SI) to its scaled coordinate.
  double scaled(std::size_t coordinate, double value) const;
  Judgement judge(std::span<const double> pose) const;  ///< Tells whether a pose (SI) is feasible.
  /// The apart_clause() of the box: empty if it overlaps the workspace that the mechanism states.
  std::string apart() const;

 private:
  const PoseSelection* selection_;
  const Model* model_;
};

/// The exception by which tell() ends a search. The overload of select_poses() with a parameter `watch` catches it.
struct SearchStopped {};

/// Reports the progress of a search to `watch`, if it is not empty. Throws SearchStopped if `watch` returns false.
void tell(const WatchSearch& watch, const PoseSearch& search);

/// An interior or boundary search gives up after this many candidates in a row that gave no pose.
inline constexpr std::size_t kMostInVain = 50'000;

/// A search gives up after this many candidates if all of them are out of reach. The number is smaller than
/// kMostInVain, because it takes some 20 ms to find that a mechanism from a file does not reach a pose.
inline constexpr std::size_t kMostOutOfReach = 3'000;

/// Collects feasible poses, and counts infeasible ones by reason.
class PoseCollector {
 public:
  /// The object refers to the workspace and to `watch`. wanted: number of poses to find. before: number of candidates
  /// that the search examined earlier.
  PoseCollector(const Workspace& workspace, std::size_t wanted, const WatchSearch& watch, std::size_t before = 0)
      : workspace_(&workspace), watch_(&watch), wanted_(wanted), before_(before) {}

  /// Examines a candidate. If it is feasible, returns its condition number; otherwise counts the reason and returns
  /// none. Throws SearchStopped if `watch` stops the search.
  std::optional<double> test(std::span<const double> pose);
  void keep(std::span<const double> pose, double condition);  ///< Adds a feasible pose and its condition number.

  std::size_t kept() const { return condition_.size(); }  ///< The number of poses that are kept.
  std::size_t tested() const { return tested_; }          ///< The number of candidates that this object examined.
  /// Returns true if the candidates so far are kMostOutOfReach or more, and all of them are out of reach.
  bool out_of_reach() const { return tested_ >= kMostOutOfReach && unreached_ == tested_; }
  /// Returns true if the search gives up: no pose was kept during the last kMostInVain candidates, or out_of_reach().
  bool in_vain() const { return in_vain_ >= kMostInVain || out_of_reach(); }
  std::span<const double> pose(std::size_t m) const;  ///< The m-th pose that was kept, SI.
  void keep_first(std::size_t count);                 ///< Keeps only the first `count` poses.
  /// Keeps `count` of the poses, evenly spread over their order. Precondition: count <= kept().
  void thin_to(std::size_t count);
  /// Throws an InputError that says that the box gives fewer poses than wanted, at the place of the most frequent
  /// reason of rejection, or at workspace_place if no candidate was rejected.
  [[noreturn]] void fail(const Place& workspace_place) const;
  SelectedPoses result() &&;  ///< The kept poses, and the numbers of rejected poses by reason, most frequent first.

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
  std::size_t unreached_ = 0;  ///< number of candidates that are out of reach
  std::size_t in_vain_ = 0;    ///< number of candidates since the last pose that was kept
};

/// The poses of a selection from a file; see select_poses().
SelectedPoses file_poses(const PoseSelection& selection, const Model& model, const WatchSearch& watch = {});

/// The poses of a selection along a trajectory, with their times; see select_poses().
SelectedPoses trajectory_poses(const PoseSelection& selection, const Model& model, const WatchSearch& watch = {});

/// Finds the first `count` poses of a sequence that is uniform by area on the boundary of the feasible set. The
/// boundary includes parts of the box's faces. Area is measured in coordinates that are scaled so that the box is the
/// unit cube, because metres and radians have no common measure. The function works for any number C of coordinates;
/// for C = 1 the boundary consists of the ends of intervals.
///
/// Random lines that prefer no place and no direction (distributed by the kinematic measure) meet a surface in points
/// that are uniform by area (Crofton). A shifted Sobol' sequence generates such lines: their direction is uniform, and
/// their offset from the cube's centre is uniform in a ball of dimension C - 1 that covers the cube. Every point where
/// a line crosses the boundary of the feasible set is a pose. To find these points, the part of the line in the box is
/// divided into 32 intervals. If one end of an interval is feasible and the other is not, bisection finds the crossing
/// up to rounding, and the point on the feasible side is taken. A pose on a face of the box is exactly on this face.
/// The search may miss a feasible piece or an infeasible gap of the line that is shorter than an interval, and it
/// leaves out pieces whose length is below rounding. The infeasible ends of the intervals count as rejected poses.
///
/// Throws InputError if max(20 000, 100 count) lines do not give enough poses, if kMostInVain examined points in a row
/// give no pose, if kMostOutOfReach or more are examined and all are out of reach, or if poses coincide up to rounding.
SelectedPoses boundary_poses(const PoseSelection& selection, const Model& model, const WatchSearch& watch = {});

}  // namespace poesy
