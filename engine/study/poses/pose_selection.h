#pragma once

#include <cstddef>
#include <functional>
#include <optional>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "engine/base/contract.h"
#include "engine/base/error.h"
#include "engine/base/index.h"
#include "engine/model/model.h"

namespace poesy {

/// A set of M poses with C coordinates each, SI, row-major [M x C].
class PoseSet {
 public:
  PoseSet() = default;
  /// values: [M x coordinates], row-major, SI.
  PoseSet(std::size_t coordinates, std::vector<double> values) : coordinates_(coordinates), values_(std::move(values)) {
    POESY_EXPECTS(coordinates_ > 0 && values_.size() % coordinates_ == 0);
  }

  std::size_t size() const {
    return coordinates_ == 0 ? 0 : values_.size() / coordinates_;
  }                                                         ///< The number of poses, M.
  std::size_t coordinates() const { return coordinates_; }  ///< The number of coordinates of a pose.
  /// The coordinates of a pose, [coordinates], SI.
  std::span<const double> operator[](PoseIndex pose) const {
    return std::span(values_).subspan(pose.value * coordinates_, coordinates_);
  }
  /// The pose before this one in the list; empty if it is the first.
  std::span<const double> before(PoseIndex pose) const {
    return pose.value == 0 ? std::span<const double>() : (*this)[PoseIndex(pose.value - 1)];
  }
  /// [M] The values of one coordinate.
  std::vector<double> column(std::size_t coordinate) const {
    std::vector<double> values(size());
    for (std::size_t m = 0; m < values.size(); ++m) values[m] = values_[m * coordinates_ + coordinate];
    return values;
  }
  bool operator==(const PoseSet&) const = default;  ///< Whether all numbers are equal.

 private:
  std::size_t coordinates_ = 0;
  std::vector<double> values_;
};

/// A range of values that includes both ends.
struct Range {
  double lower;  ///< SI
  double upper;  ///< SI
};

/// Points in the pose's own coordinates, or in those of one of the model's charts.
struct PoseTable {
  std::optional<std::size_t> chart;    ///< position among the model's charts; none: the pose's own coordinates
  PoseSet points;                      ///< [M x coordinates], SI
  std::vector<std::string> bare = {};  ///< columns of a file without a unit, in the order of the coordinates
};

/// The coordinates of a chart, or of the pose if there is none.
const std::vector<PoseCoordinate>& coordinates(const ModelDescription& model, std::optional<std::size_t> chart);

/// Points with the times at which they are passed.
struct TimedPoints {
  std::vector<double> time;  ///< [M] s, strictly ascending
  PoseTable table;           ///< [M]
};

inline constexpr double kLatestTime = 1e9;  ///< s, before and after 0: 30 years, far from overflow

/// A trajectory in a study: a named curve of the model, or points of a file.
struct Trajectory {
  std::optional<std::size_t> curve = {};  ///< position among the model's curves; none: points of a file
  std::vector<double> origin = {};        ///< point at which the curve's zero is, [coordinates of its chart], SI
  std::string file = {};                  ///< name in the study; empty for a curve
  TimedPoints from_file = {};             ///< at least two points; empty if the file was not opened
  std::size_t points = 0;                 ///< number of poses, evenly spaced in time; 0: the points of the file
  std::optional<Range> time = {};         ///< s; none if points is 0, or if the file determines it and was not opened
  Place first_row = {};                   ///< first point of the file (point m is m lines below)
};

/// The points of a trajectory: those of a curve at evenly spaced times, including both ends; those of the file; or
/// those of the file interpolated at evenly spaced times. Each coordinate is interpolated alone: by a modified Akima
/// spline through four or more points, by straight lines through two or three. Precondition: the file was opened, and
/// the times are inside its range.
TimedPoints sampled(const Trajectory& trajectory, const ModelDescription& model);

/// The range of one joint's displacement from home, including its ends.
struct JointLimit {
  std::size_t joint;  ///< position among the model's joints
  Range range;        ///< SI
  Place place;        ///< place in the study, for messages
};

/// How the poses of the platform are selected.
struct PoseSelection {
  /// How poses are chosen; see select_poses().
  enum class Select { interior, file, boundary, grid, trajectory };

  Select select = Select::interior;  ///< how poses are chosen; it determines which members below are used
  std::size_t count = 0;             ///< number of poses; with grid_counts their product; for a trajectory its points
  std::vector<std::size_t> grid_counts;  ///< for `grid`: one number per pose coordinate, or empty
  std::vector<Range> workspace;          ///< one range per pose coordinate, for selections that search a box
  std::vector<JointLimit> limits;        ///< for selections that search a box
  double max_condition = 1e8;            ///< poses with a larger condition number count as singular
  std::string file;                      ///< for `file`: its name in the study
  PoseTable from_file;                   ///< poses of that file
  std::optional<Trajectory> trajectory;  ///< for `trajectory`; none if the study has none and is only evaluated
  Place place;  ///< place of the workspace, of the file's first pose (pose m is m lines below), or of the trajectory
  Place count_place;  ///< place of the count, for messages
};

/// The number of poses that were refused for one reason.
struct RejectedPoses {
  std::string reason;  ///< "q_1_3 above 80 mm"
  std::size_t count;   ///< number of poses
};

/// The result of a selection.
struct SelectedPoses {
  PoseSet poses;                        ///< [M]
  std::vector<double> condition;        ///< [M], see Model::condition
  std::vector<RejectedPoses> rejected;  ///< most frequent first
  std::vector<double> time;             ///< [M] s, ascending, for a trajectory; else empty
};

/// The progress of a search for poses.
struct PoseSearch {
  std::size_t found;       ///< poses so far
  std::size_t wanted;      ///< poses that are wanted
  std::size_t candidates;  ///< poses that were examined
};

/// Called after each pose that a search examines; false stops the search.
using WatchSearch = std::function<bool(const PoseSearch&)>;

/// Selects the study's poses, deterministically. A pose of the box is feasible if the model reaches it, every limited
/// joint stays in its range, and its condition number is at most max_condition.
///
/// - interior: the first `count` feasible points of the Sobol' sequence in the box. A smaller set is the beginning of a
/// larger one.
/// - boundary: points of the feasible set's boundary, uniform by area; see boundary_poses(). Fewer begin more.
/// - grid: with grid_counts all feasible points of that grid, the last coordinate fastest. Ranges are divided evenly,
///   both ends included; 1 means the middle. Else the coarsest grid with equal numbers for all coordinates and at least
///   `count` feasible points, thinned evenly to `count`.
/// - file: the poses of the file, which may stand in the coordinates of a chart.
/// - trajectory: the poses of sampled(), in the order of time.
///
/// Throws InputError at the place of the limit that rejected most poses, or of the selection, if the box gives fewer
/// poses than wanted. Interior: after max(100 000, 100 count) candidates, or 50 000 in a row of which none is feasible;
/// boundary: see boundary_poses(). Grid: if the candidates would be more than a grid may have, or if, after 100 000 in
/// all grids, their feasible share would give less than a quarter of the poses. At count_place, if poses of the
/// boundary coincide up to rounding. For the first pose of a file or a trajectory that does not exist, is out of reach
/// or exceeds max_condition: at its line if the poses are those of a file, else at the study's trajectory.
SelectedPoses select_poses(const PoseSelection& selection, const Model& model);

/// The same; none if the search was stopped. watch: may be empty.
std::optional<SelectedPoses> select_poses(const PoseSelection& selection, const Model& model, const WatchSearch& watch);

}  // namespace poesy
