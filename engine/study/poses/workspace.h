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
  double condition = 0.0;        ///< of a feasible pose
  std::string reason;            ///< why it is not feasible; else empty
  const Place* place = nullptr;  ///< where the study sets what refuses it
  std::string_view remedy;       ///< what makes such poses feasible

  bool feasible() const { return reason.empty(); }  ///< Whether no reason stands against it.
};

/// The box of a selection and what is feasible in it, in coordinates scaled to the box: each range is [0, 1].
class Workspace {
 public:
  /// Both must outlive it.
  Workspace(const PoseSelection& selection, const Model& model) : selection_(&selection), model_(&model) {}

  std::size_t coordinates() const { return selection_->workspace.size(); }  ///< Numbers of a pose.
  /// The pose (SI) at scaled coordinates in [0, 1]; 0 and 1 give the ends of the ranges exactly. Both [coordinates].
  void unscale(std::span<const double> scaled, std::span<double> pose) const;
  double scaled(std::size_t coordinate, double value) const;  ///< The scaled coordinate of a pose's coordinate (SI).
  Judgement judge(std::span<const double> pose) const;        ///< Pose: SI, [coordinates].

 private:
  const PoseSelection* selection_;
  const Model* model_;
};

/// Thrown where a search is stopped; select_poses() catches it.
struct SearchStopped {};

/// Calls watch, if it is not empty. Throws SearchStopped.
void tell(const WatchSearch& watch, const PoseSearch& search);

/// After so many candidates in a row of which none is feasible a search gives up.
inline constexpr std::size_t kMostInVain = 50'000;

/// Collects feasible poses and counts the others by their reason.
class PoseCollector {
 public:
  /// Refers to both. wanted: poses; before: candidates that the search has looked at already.
  PoseCollector(const Workspace& workspace, std::size_t wanted, const WatchSearch& watch, std::size_t before = 0)
      : workspace_(&workspace), watch_(&watch), wanted_(wanted), before_(before) {}

  /// The condition number of a feasible pose; none for others, which it counts. Throws SearchStopped.
  std::optional<double> test(std::span<const double> pose);
  void keep(std::span<const double> pose, double condition);  ///< Keeps a feasible pose.

  std::size_t kept() const { return condition_.size(); }  ///< How many feasible poses it has.
  std::size_t tested() const { return tested_; }          ///< How many candidates it has looked at.
  /// Whether the last kMostInVain candidates gave no pose.
  bool in_vain() const { return in_vain_ >= kMostInVain; }
  std::span<const double> pose(std::size_t m) const;  ///< The m-th that was kept, SI.
  void keep_first(std::size_t count);                 ///< Drops all but the first `count`.
  /// Keeps `count` of the poses, evenly spread over their order. Precondition: count <= kept().
  void thin_to(std::size_t count);
  /// Throws the InputError of a box that gives fewer poses than wanted.
  [[noreturn]] void fail(const Place& workspace_place) const;
  SelectedPoses result() &&;  ///< The poses, and what was rejected, most frequent first.

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

/// The first `count` poses of a sequence on the boundary of the feasible set, its faces on the box included, uniform by
/// area. Area is that in coordinates scaled to the box (each range is [0, 1]), because metres and radians have no
/// common measure. Any number of coordinates C; for C = 1 the boundary is the ends of intervals.
///
/// Lines distributed by the kinematic measure meet a surface in points uniform by area (Crofton): so a shifted Sobol'
/// sequence gives lines, of uniform direction and with a uniform offset from the cube's centre in a ball of dimension
/// C - 1 that covers the cube, and every crossing of the feasible set's boundary along a line is a pose. The chord that
/// the box leaves of a line is scanned in 32 intervals; where the ends of one differ, bisection refines to
/// rounding and the feasible side is kept. A pose on a face of the box lies on it exactly. A feasible piece or gap
/// shorter than a scan interval can be missed, and a piece shorter than rounding is left out. Among rejected poses the
/// points of the scans count.
///
/// Throws InputError when max(20 000, 100 count) lines do not give enough, or kMostInVain points of the scans in a row
/// give no pose, or when poses coincide to rounding.
SelectedPoses boundary_poses(const PoseSelection& selection, const Model& model, const WatchSearch& watch = {});

}  // namespace poesy
