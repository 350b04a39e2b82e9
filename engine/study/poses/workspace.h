#pragma once

#include <cstddef>
#include <map>
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

  /// Whether no reason stands against it.
  bool feasible() const { return reason.empty(); }
};

/// The box of a selection and what is feasible in it, in coordinates scaled to the box: each range is [0, 1].
class Workspace {
 public:
  /// Both must outlive it.
  Workspace(const PoseSelection& selection, const Model& model);

  /// Numbers of a pose.
  std::size_t coordinates() const { return selection_->workspace.size(); }
  /// The pose (SI) at scaled coordinates in [0, 1]; 0 and 1 give the ends of the ranges exactly. Both [coordinates].
  void unscale(std::span<const double> scaled, std::span<double> pose) const;
  /// The scaled coordinate of a pose's coordinate (SI).
  double scaled(std::size_t coordinate, double value) const;
  /// Pose: SI, [coordinates].
  Judgement judge(std::span<const double> pose) const;

 private:
  struct LimitReasons {
    std::string below;
    std::string above;
  };

  const PoseSelection* selection_;
  const Model* model_;
  std::vector<LimitReasons> limit_reasons_;
  std::string singular_;
};

/// Collects feasible poses and counts the others by their reason.
class PoseCollector {
 public:
  /// Refers to it.
  explicit PoseCollector(const Workspace& workspace) : workspace_(&workspace) {}

  /// Judges the pose and counts it if it is rejected. Returns whether it is feasible.
  bool test(std::span<const double> pose);
  /// Keeps a feasible pose.
  void keep(std::span<const double> pose);
  /// Judges the pose, then keeps or counts it.
  void offer(std::span<const double> pose);

  /// How many feasible poses it has.
  std::size_t kept() const { return condition_.size(); }
  /// The m-th that was kept, SI.
  std::span<const double> pose(std::size_t m) const;
  /// Drops all but the first `count`.
  void keep_first(std::size_t count);
  /// Keeps `count` of the poses, evenly spread over their order. Precondition: count <= kept().
  void thin_to(std::size_t count);
  /// Throws the InputError of a box that gives fewer poses than wanted.
  [[noreturn]] void fail(std::size_t wanted, const Place& workspace_place) const;
  /// The poses, and what was rejected, most frequent first.
  SelectedPoses result() &&;

 private:
  struct Count {
    std::size_t count = 0;
    const Place* place = nullptr;
    std::string_view remedy;
  };

  void reject(const Judgement& judgement);
  void keep(std::span<const double> pose, double condition);

  const Workspace* workspace_;
  std::vector<double> values_;
  std::vector<double> condition_;
  std::map<std::string, Count> rejected_;
  std::size_t tested_ = 0;
};

}  // namespace poesy
