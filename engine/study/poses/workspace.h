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

/// Whether a pose of the box is feasible.
struct Judgement {
  double condition = 0.0;        ///< condition number of a feasible pose
  std::string reason;            ///< reason why it is not feasible; else empty
  const Place* place = nullptr;  ///< place of the limit in the study that refuses it
  std::string_view remedy;       ///< advice that makes such poses feasible

  bool feasible() const { return reason.empty(); }  ///< Whether the pose is feasible.
};

/// The box of a selection and its feasible poses, in coordinates scaled to the box: each range is [0, 1].
class Workspace {
 public:
  /// Both arguments must outlive it.
  Workspace(const PoseSelection& selection, const Model& model) : selection_(&selection), model_(&model) {}

  std::size_t coordinates() const { return selection_->workspace.size(); }  ///< The number of coordinates of a pose.
  /// Converts scaled coordinates in [0, 1] to a pose (SI); 0 and 1 give the ends of the ranges exactly. Both
  /// [coordinates].
  void unscale(std::span<const double> scaled, std::span<double> pose) const;
  double scaled(std::size_t coordinate, double value) const;  ///< The scaled coordinate of a pose's coordinate (SI).
  Judgement judge(std::span<const double> pose) const;        ///< Judges a pose, [coordinates], SI.

 private:
  const PoseSelection* selection_;
  const Model* model_;
};

/// Thrown where a search is stopped; select_poses() catches it.
struct SearchStopped {};

/// Calls watch, if it is not empty. Throws SearchStopped.
void tell(const WatchSearch& watch, const PoseSearch& search);

/// The number of candidates in a row without a feasible one after which a search gives up.
inline constexpr std::size_t kMostInVain = 50'000;

/// Collects feasible poses, and counts the others by reason.
class PoseCollector {
 public:
  /// Refers to both arguments. wanted: number of poses; before: candidates that the search has already examined.
  PoseCollector(const Workspace& workspace, std::size_t wanted, const WatchSearch& watch, std::size_t before = 0)
      : workspace_(&workspace), watch_(&watch), wanted_(wanted), before_(before) {}

  /// The condition number of a feasible pose; none for others, which are counted. Throws SearchStopped.
  std::optional<double> test(std::span<const double> pose);
  void keep(std::span<const double> pose, double condition);  ///< Keeps a feasible pose.

  std::size_t kept() const { return condition_.size(); }  ///< The number of feasible poses.
  std::size_t tested() const { return tested_; }          ///< The number of candidates that were examined.
  /// Whether the last kMostInVain candidates were all infeasible.
  bool in_vain() const { return in_vain_ >= kMostInVain; }
  std::span<const double> pose(std::size_t m) const;  ///< The m-th pose that was kept, SI.
  void keep_first(std::size_t count);                 ///< Removes all poses but the first `count`.
  /// Keeps `count` of the poses, evenly spread over their order. Precondition: count <= kept().
  void thin_to(std::size_t count);
  /// Throws the InputError for a box that gives fewer poses than wanted.
  [[noreturn]] void fail(const Place& workspace_place) const;
  SelectedPoses result() &&;  ///< The poses, and the rejected ones by reason, most frequent first.

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
  std::size_t in_vain_ = 0;  ///< candidates since the last pose
};

/// The poses of a file; see select_poses().
SelectedPoses file_poses(const PoseSelection& selection, const Model& model, const WatchSearch& watch = {});

/// The poses along a trajectory, with their times; see select_poses().
SelectedPoses trajectory_poses(const PoseSelection& selection, const Model& model, const WatchSearch& watch = {});

/// The first `count` poses of a sequence on the boundary of the feasible set, including its faces on the box, uniform
/// by area. Area is measured in coordinates scaled to the box (each range is [0, 1]), because metres and radians have
/// no common measure. Any number of coordinates C; for C = 1 the boundary is the ends of intervals.
///
/// Lines with the kinematic measure meet a surface in points that are uniform by area (Crofton). So a shifted Sobol'
/// sequence generates lines, with uniform direction and uniform offset from the cube's centre in a ball of dimension C
/// - 1 that covers the cube. Every crossing of the feasible set's boundary along a line is a pose. The chord of a line
/// in the box is scanned in 32 intervals; if feasibility differs at the ends of one, bisection refines to rounding, and
/// the feasible side is kept. A pose on a face of the box is exactly on it. A feasible piece or gap shorter than a scan
/// interval may be missed, and a piece shorter than rounding is left out. Rejected poses include the points of the
/// scans.
///
/// Throws InputError if max(20 000, 100 count) lines do not give enough poses, if kMostInVain points of the scans in a
/// row give none, or if poses coincide up to rounding.
SelectedPoses boundary_poses(const PoseSelection& selection, const Model& model, const WatchSearch& watch = {});

}  // namespace poesy
