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

  /// The number of poses, M.
  std::size_t size() const { return coordinates_ == 0 ? 0 : values_.size() / coordinates_; }
  std::size_t coordinates() const { return coordinates_; }  ///< The number of coordinates of a pose.
  /// The coordinates of a pose, [coordinates], SI.
  std::span<const double> operator[](PoseIndex pose) const {
    return std::span(values_).subspan(pose.value * coordinates_, coordinates_);
  }
  /// The pose before this one in the list; empty for the first pose.
  std::span<const double> before(PoseIndex pose) const {
    return pose.value == 0 ? std::span<const double>() : (*this)[PoseIndex(pose.value - 1)];
  }
  /// [M] The values of one coordinate.
  std::vector<double> column(std::size_t coordinate) const {
    std::vector<double> values(size());
    for (std::size_t m = 0; m < values.size(); ++m) values[m] = values_[m * coordinates_ + coordinate];
    return values;
  }
  bool operator==(const PoseSet&) const = default;  ///< Returns true if all numbers are equal.

 private:
  std::size_t coordinates_ = 0;
  std::vector<double> values_;
};

/// A range of values that includes both ends.
struct Range {
  double lower;  ///< lower end, SI
  double upper;  ///< upper end, SI
};

/// Points, in the pose's own coordinates or in the coordinates of one of the model's charts.
struct PoseTable {
  std::optional<std::size_t> chart;    ///< index of the model's chart; none: the pose's own coordinates
  PoseSet points;                      ///< [M x coordinates], SI
  std::vector<std::string> bare = {};  ///< titles of a file's columns without a unit, in the order of the coordinates
};

/// The coordinates of the model's chart of this index; the pose's own coordinates without a chart.
const std::vector<PoseCoordinate>& coordinates(const ModelDescription& model, std::optional<std::size_t> chart);

/// Points of a trajectory, with the times at which it passes them.
struct TimedPoints {
  std::vector<double> time;  ///< [M] time of each of M points, s, strictly ascending
  PoseTable table;           ///< [M] points
};

inline constexpr double kLatestTime = 1e9;  ///< largest time before or after 0, s: about 30 years, far from overflow

/// A trajectory in a study: a named curve of the model, or points of a file.
struct Trajectory {
  std::optional<std::size_t> curve = {};  ///< index of the model's curve; none: points of a file
  std::vector<double> origin = {};        ///< [coordinates of the curve's chart], SI, point that is added to the curve
  std::string file = {};                  ///< name of the file in the study; empty for a curve
  TimedPoints from_file = {};             ///< at least two points; empty if the file was not opened
  std::size_t points = 0;  ///< number of poses, evenly spaced in time; 0: the poses are the points of the file
  /// Start and end of the trajectory, s; none if points is 0, or if the file determines them and was not opened.
  std::optional<Range> time = {};
  Place first_row = {};  ///< place of the first point in the file; point m is m lines below
};

/// The points of a trajectory. A curve gives points at evenly spaced times, including both ends. A file gives its own
/// points, or points that are interpolated at evenly spaced times. Each coordinate is interpolated alone: by a modified
/// Akima spline through four or more points, by straight lines through two or three. Precondition: the file was opened,
/// and the times are inside its range.
TimedPoints sampled(const Trajectory& trajectory, const ModelDescription& model);

/// The range of one joint's displacement from home, including its ends.
struct JointLimit {
  std::size_t joint;  ///< index of the model's joint
  Range range;        ///< range of the displacement, SI
  Place place;        ///< place in the study, for messages
};

/// How the poses of the platform are selected.
struct PoseSelection {
  /// How poses are chosen; see select_poses().
  enum class Select { interior, file, boundary, grid, trajectory };

  Select select = Select::interior;  ///< how poses are chosen; it determines which members below are used
  /// Number of poses. With grid_counts it is the product of these counts, for a trajectory the number of its points.
  std::size_t count = 0;
  std::vector<std::size_t> grid_counts;  ///< number of points for each pose coordinate, with `grid`; otherwise empty
  /// Box that is searched: one range per pose coordinate; empty for selections that do not search.
  std::vector<Range> workspace;
  std::vector<JointLimit> limits;  ///< limits of joints, for selections that search a box
  double max_condition = 1e8;      ///< largest condition number of a pose; above it a pose counts as singular
  std::string file;                ///< for `file`: name of the file in the study
  PoseTable from_file;             ///< for `file`: poses of the file
  /// For `trajectory`; none in a study for StudyUse::evaluate that states no trajectory.
  std::optional<Trajectory> trajectory;
  Place place;  ///< place of the workspace, of the file's first pose (pose m is m lines below), or of the trajectory,
                ///< for messages
  Place count_place;  ///< place of the key `count`, for messages
};

/// The number of poses that were refused for one reason.
struct RejectedPoses {
  std::string reason;  ///< the reason in words: "q_1_3 above 80 mm"
  std::size_t count;   ///< number of poses
};

/// The poses of a selection, and the poses that it rejected.
struct SelectedPoses {
  PoseSet poses;                        ///< [M] selected poses, M in number
  std::vector<double> condition;        ///< [M] condition number of each pose; see Model::condition
  std::vector<RejectedPoses> rejected;  ///< numbers of rejected poses by reason, most frequent first
  std::vector<double> time;             ///< [M] s, time of each pose of a trajectory, ascending; else empty
};

/// The progress of a search for poses.
struct PoseSearch {
  std::size_t found;       ///< number of poses that were found
  std::size_t wanted;      ///< number of poses that are wanted
  std::size_t candidates;  ///< number of poses that were examined
};

/// Called after each pose that a search examines; false stops the search.
using WatchSearch = std::function<bool(const PoseSearch&)>;

/// Selects the study's poses, deterministically. A pose of the box is feasible if the model reaches it, every limited
/// joint stays in its range, and the pose's condition number is at most max_condition.
///
/// - interior: the first `count` feasible points of the Sobol' sequence in the box. A smaller set is the beginning of a
///   larger one.
/// - boundary: points of the feasible set's boundary, uniform by area; see boundary_poses(). A smaller set is the
///   beginning of a larger one.
/// - grid: with grid_counts, all feasible points of that grid; the last coordinate changes fastest. Ranges are divided
/// evenly, both ends included; a count of 1 gives the middle of its range. Without grid_counts, it is the coarsest grid
/// that has equal numbers for all coordinates and at least `count` feasible points; `count` of these are kept, evenly
/// spread.
/// - file: the poses of the file, which may be given in the coordinates of a chart.
/// - trajectory: the poses of sampled(), in the order of time.
///
/// Throws InputError if the box gives fewer poses than wanted: at the place of the limit that rejected most poses, or,
/// if no limit did, at the place of the selection. An interior search gives up after max(100 000, 100 count)
/// candidates, or after 50 000 candidates in a row without a feasible one. For a boundary see boundary_poses(). A grid
/// search gives up if the next grid would have more candidates than a grid may have. It also gives up if the share of
/// feasible candidates, known after 100 000 candidates in all grids, would give less than a quarter of the poses.
/// Throws InputError at count_place if poses of the boundary coincide up to rounding. Throws InputError for the first
/// pose of a file or a trajectory that does not exist, is out of reach or exceeds max_condition: at its line if the
/// poses are the points of a file, else at the study's trajectory.
SelectedPoses select_poses(const PoseSelection& selection, const Model& model);

/// Selects poses like select_poses() above, and reports progress. watch: called after each examined pose; may be empty.
/// None if watch stopped the search.
std::optional<SelectedPoses> select_poses(const PoseSelection& selection, const Model& model, const WatchSearch& watch);

}  // namespace poesy
