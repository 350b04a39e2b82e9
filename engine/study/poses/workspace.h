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

/// Collects feasible poses and counts the others by their reason.
class PoseCollector {
 public:
  explicit PoseCollector(const Workspace& workspace) : workspace_(&workspace) {}  ///< Refers to it.

  /// The condition number of a feasible pose; none for others, which it counts.
  std::optional<double> test(std::span<const double> pose);
  void keep(std::span<const double> pose, double condition);  ///< Keeps a feasible pose.

  std::size_t kept() const { return condition_.size(); }  ///< How many feasible poses it has.
  std::span<const double> pose(std::size_t m) const;      ///< The m-th that was kept, SI.
  void keep_first(std::size_t count);                     ///< Drops all but the first `count`.
  /// Keeps `count` of the poses, evenly spread over their order. Precondition: count <= kept().
  void thin_to(std::size_t count);
  /// Throws the InputError of a box that gives fewer poses than wanted.
  [[noreturn]] void fail(std::size_t wanted, const Place& workspace_place) const;
  SelectedPoses result() &&;  ///< The poses, and what was rejected, most frequent first.

 private:
  struct Count {
    std::size_t count = 0;
    Judgement last;
  };

  const Workspace* workspace_;
  std::vector<double> values_;
  std::vector<double> condition_;
  std::map<std::string, Count> rejected_;
  std::size_t tested_ = 0;
};

/// The poses of a file; see select_poses().
SelectedPoses file_poses(const PoseSelection& selection, const Model& model);

/// The poses along a trajectory, with their times; see select_poses().
SelectedPoses trajectory_poses(const PoseSelection& selection, const Model& model);

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
/// Throws InputError when max(20 000, 100 count) lines do not give enough, or when poses coincide to rounding.
SelectedPoses boundary_poses(const PoseSelection& selection, const Model& model);

}  // namespace poesy
