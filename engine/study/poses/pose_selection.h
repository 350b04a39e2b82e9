#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "engine/base/error.h"
#include "engine/model/model.h"
#include "engine/model/pose_set.h"
#include "engine/study/poses/trajectory.h"

namespace poesy {

/// The values from one end to the other, both included.
struct Range {
  double lower;  ///< SI
  double upper;  ///< SI
};

/// The range that one joint's displacement from home must stay in, ends included.
struct JointLimit {
  std::size_t joint;  ///< position among the model's joints
  Range range;        ///< SI
  Place place;        ///< in the study, for messages
};

/// Which poses of the platform.
struct PoseSelection {
  /// How poses are chosen; see select_poses().
  enum class Select { interior, file, boundary, grid, trajectory };

  Select select = Select::interior;      ///< decides which of the members below hold something
  std::size_t count = 0;                 ///< with grid_counts their product; of a trajectory its points
  std::vector<std::size_t> grid_counts;  ///< for `grid`: one number per pose coordinate, or empty
  std::vector<Range> workspace;          ///< one range per pose coordinate; for all that search a box
  std::vector<JointLimit> limits;        ///< for all that search a box
  double max_condition = 1e8;            ///< poses above it count as singular
  std::string file;                      ///< as written in the study, for `file`
  PoseTable from_file;                   ///< its poses
  std::optional<Trajectory> trajectory;  ///< for `trajectory`; none in a study that is only evaluated and has none
  Place place;        ///< of the workspace, of the file's first pose (pose m is m lines below), or of the trajectory
  Place count_place;  ///< of the count, for messages
};

/// How many poses were tried and refused for one reason.
struct RejectedPoses {
  std::string reason;  ///< "q_1_3 above 80 mm"
  std::size_t count;   ///< poses
};

/// What a selection comes to.
struct SelectedPoses {
  PoseSet poses;                        ///< [M]
  std::vector<double> condition;        ///< [M], see Model::condition
  std::vector<RejectedPoses> rejected;  ///< most frequent first
  std::vector<double> time;             ///< [M] s, ascending, of a trajectory; else empty
};

/// The study's poses. Deterministic. A pose of the box is feasible when the model reaches it, every limited joint stays
/// in its range, and its condition number is at most max_condition.
///
/// - interior: Sobol' points in the box, in order; the first `count` feasible ones. Fewer poses are the first of more.
/// - boundary: points of the feasible set's boundary, uniform by area; see boundary_poses(). Fewer are the first of
/// more.
/// - grid: with grid_counts all feasible points of that grid, the last coordinate fastest. Ranges are divided evenly,
///   both ends included; 1 means the middle. Else the coarsest grid with equal numbers for all coordinates and at least
///   `count` feasible points, thinned evenly to `count`.
/// - file: the poses of the file, which may stand in the coordinates of a chart.
/// - trajectory: the poses of sampled(), in the order of time.
///
/// Throws InputError at the place of the limit that rejected most, or of the selection, when the box gives fewer poses
/// than wanted (interior and grid: after max(100 000, 100 count) candidates); at count_place when poses of the boundary
/// coincide to rounding; at the line of a file's first pose that does not exist, is out of reach or above
/// max_condition; for the first point of a trajectory to which no pose belongs, or one out of reach or above
/// max_condition: at its line where the poses are a file's own, else at the study's trajectory.
SelectedPoses select_poses(const PoseSelection& selection, const Model& model);

}  // namespace poesy
