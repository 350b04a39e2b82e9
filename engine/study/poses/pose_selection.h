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

/// M poses of C coordinates each, SI, row-major [M x C].
class PoseSet {
 public:
  PoseSet() = default;
  /// Values: [M x coordinates], row-major, SI.
  PoseSet(std::size_t coordinates, std::vector<double> values) : coordinates_(coordinates), values_(std::move(values)) {
    POESY_EXPECTS(coordinates_ > 0 && values_.size() % coordinates_ == 0);
  }

  std::size_t size() const { return coordinates_ == 0 ? 0 : values_.size() / coordinates_; }  ///< M.
  std::size_t coordinates() const { return coordinates_; }                                    ///< Numbers of a pose.
  /// [coordinates], SI.
  std::span<const double> operator[](PoseIndex pose) const {
    return std::span(values_).subspan(pose.value * coordinates_, coordinates_);
  }
  /// All values of one coordinate, [M].
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

/// The values from one end to the other, both included.
struct Range {
  double lower;  ///< SI
  double upper;  ///< SI
};

/// Points in the pose's own coordinates, or in those of one of the model's charts.
struct PoseTable {
  std::optional<std::size_t> chart;    ///< position among the model's charts; none: the pose's own coordinates
  PoseSet points;                      ///< [M x coordinates], SI
  std::vector<std::string> bare = {};  ///< columns of a file that name no unit, in the order of the coordinates
};

/// The coordinates of the pose, or of a chart.
const std::vector<PoseCoordinate>& coordinates(const ModelDescription& model, std::optional<std::size_t> chart);

/// Points run through in time.
struct TimedPoints {
  std::vector<double> time;  ///< [M] s, strictly ascending
  PoseTable table;           ///< [M]
};

inline constexpr double kLatestTime = 1e9;  ///< s, from 0, before and after: 30 years, far from where times overflow

/// What a study says of a trajectory: a named curve of the model, or points of a file.
struct Trajectory {
  std::optional<std::size_t> curve = {};  ///< position among the model's curves; none: of a file
  std::vector<double> origin = {};        ///< where the curve's zero stands, [coordinates of its chart], SI
  std::string file = {};                  ///< as written in the study; empty for a curve
  TimedPoints from_file = {};             ///< at least two; empty where the file was not opened
  std::size_t points = 0;                 ///< poses, evenly spaced in time; 0: those of the file as they are
  std::optional<Range> time = {};         ///< s; none where points is 0, or where the file was not opened and sets it
  Place first_row = {};                   ///< of the file (point m is m lines below)
};

/// The trajectory's points: of a curve at evenly spaced times, both ends included; those of the file as they are; or
/// those of the file interpolated over time at evenly spaced times, each coordinate by itself: a modified Akima spline
/// through four points or more, straight lines through two or three. Precondition: the file was opened, the times lie
/// inside its range.
TimedPoints sampled(const Trajectory& trajectory, const ModelDescription& model);

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

/// How far a search for poses is.
struct PoseSearch {
  std::size_t found;       ///< poses so far
  std::size_t wanted;      ///< poses
  std::size_t candidates;  ///< poses that were looked at
};

/// Called after each pose that a search looks at; false stops the search.
using WatchSearch = std::function<bool(const PoseSearch&)>;

/// The study's poses. Deterministic. A pose of the box is feasible when the model reaches it, every limited joint stays
/// in its range, and its condition number is at most max_condition.
///
/// - interior: Sobol' points in the box, in order; the first `count` feasible ones. Fewer poses are the first of more.
/// - boundary: points of the feasible set's boundary, uniform by area; see boundary_poses(). Fewer begin more.
/// - grid: with grid_counts all feasible points of that grid, the last coordinate fastest. Ranges are divided evenly,
///   both ends included; 1 means the middle. Else the coarsest grid with equal numbers for all coordinates and at least
///   `count` feasible points, thinned evenly to `count`.
/// - file: the poses of the file, which may stand in the coordinates of a chart.
/// - trajectory: the poses of sampled(), in the order of time.
///
/// Throws InputError at the place of the limit that rejected most, or of the selection, when the box gives fewer poses
/// than wanted: interior after max(100 000, 100 count) candidates, or 50 000 in a row of which none is feasible;
/// boundary likewise, see boundary_poses(); grid when so many candidates are more than a grid may have, or when, after
/// 100 000 in all grids, their feasible share would give less than a quarter of the poses there; at count_place when
/// poses of the boundary coincide to rounding; for the first pose of a file or a trajectory that does not exist, is out
/// of reach or above max_condition: at its line where the poses are a file's own, else at the study's trajectory.
SelectedPoses select_poses(const PoseSelection& selection, const Model& model);

/// The same; none where the search was stopped. watch: may be empty.
std::optional<SelectedPoses> select_poses(const PoseSelection& selection, const Model& model, const WatchSearch& watch);

}  // namespace poesy
