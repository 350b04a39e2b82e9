#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "engine/base/contract.h"
#include "engine/base/error.h"
#include "engine/base/index.h"
#include "engine/model/model.h"

namespace poesy {

/// An immutable list of poses with the same number of coordinates, SI.
class PoseSet {
 public:
  PoseSet() = default;
  /// values: the coordinates [poses x coordinates], row-major, SI.
  PoseSet(std::size_t coordinates, std::vector<double> values) : coordinates_(coordinates), values_(std::move(values)) {
    POESY_EXPECTS(coordinates_ > 0 && values_.size() % coordinates_ == 0);
  }

  /// The number of poses.
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
  /// The values of one coordinate at all poses.
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
  PoseSet points;                      ///< coordinates of the points, SI
  std::vector<std::string> bare = {};  ///< names of the coordinates for which the file states no unit
};

/// The coordinates of the model's chart with this index; if `chart` is empty, the coordinates of a pose.
const std::vector<PoseCoordinate>& coordinates(const ModelDescription& model, std::optional<std::size_t> chart);

/// The points of a trajectory, with the times at which the trajectory passes them.
struct TimedPoints {
  std::vector<double> time;  ///< time of each point, s, strictly ascending
  PoseTable table;           ///< points, in the order of time
};

inline constexpr double kLatestTime = 1e9;  ///< largest time before or after 0, s: about 30 years, far from overflow

/// A trajectory in a study: a named curve of the model, or points of a file.
struct Trajectory {
  std::optional<std::size_t> curve = {};  ///< index of the model's curve; none: points of a file
  std::vector<double> origin = {};        ///< point that is added to the curve: coordinates of the curve's chart, SI
  std::string file = {};                  ///< name of the file in the study; empty for a curve
  TimedPoints from_file = {};             ///< points of the file, at least two; empty if the file was not opened
  std::size_t points = 0;  ///< number of poses, evenly spaced in time; 0: the poses are the points of the file
  /// Start and end of the trajectory, s; none if `points` is 0, or if the file determines them and was not opened.
  std::optional<Range> time = {};
  Place first_row = {};  ///< place of the first point in the file; each further point is one line below
};

/// The points of a trajectory. A curve gives points at evenly spaced times, including both ends. A file gives its own
/// points, or points that are interpolated at evenly spaced times. Each coordinate is interpolated independently of the
/// others, by a modified Akima spline through four or more points, or by straight lines through two or three.
/// Precondition: the file was opened, and the times are inside its range.
TimedPoints sampled(const Trajectory& trajectory, const ModelDescription& model);

/// The range in which a joint's displacement from home must be, including both ends.
struct JointLimit {
  std::size_t joint;  ///< index in the model's list of joints
  Range range;        ///< range of the displacement, SI
  Place place;        ///< place in the study, for messages
};

/// How the poses of the platform are selected.
struct PoseSelection {
  /// How poses are chosen; see select_poses().
  enum class Select { interior, file, boundary, grid, trajectory };

  Select select = Select::interior;  ///< how poses are chosen; it determines which members below are used
  /// Number of poses. With grid_counts it is the product of these numbers, for a trajectory the number of its points.
  std::size_t count = 0;
  std::vector<std::size_t> grid_counts;  ///< number of points for each pose coordinate, with `grid`; otherwise empty
  /// Box that is searched: a range for each pose coordinate; empty for selections that do not search.
  std::vector<Range> workspace;
  std::vector<JointLimit> limits;  ///< limits of joints, for selections that search a box
  double max_condition = 1e8;      ///< largest condition number of a pose; above it a pose counts as singular
  std::string file;                ///< for `file`: name of the file in the study
  PoseTable from_file;             ///< for `file`: poses of the file
  /// For `trajectory`: the trajectory; none if the study is read for StudyUse::evaluate and states none.
  std::optional<Trajectory> trajectory;
  /// Place of the workspace, of the file's first pose (each further pose is one line below), or of the trajectory; for
  /// messages.
  Place place;
  Place count_place;  ///< place of the key `count`, for messages
};

/// The number of poses that were refused for one reason.
struct RejectedPoses {
  std::string reason;  ///< the reason in words: "q_1_3 above 80 mm"
  std::size_t count;   ///< number of poses that were refused for this reason
};

/// The beginning of RejectedPoses::reason for poses that the mechanism cannot reach.
inline constexpr std::string_view kOutOfReach = "out of reach: ";

/// Returns true if the mechanism cannot reach some of these poses, so that not only limits of the study reject poses.
bool some_out_of_reach(std::span<const RejectedPoses> rejected);

/// A sentence on the poses of a workspace that are not in a study: how many of the examined poses, and why. Empty if
/// there are none. candidates: number of poses that the search examined; if it is 0 (not known), the sentence is empty.
std::string rejected_text(std::span<const RejectedPoses> rejected, std::size_t candidates);

/// The poses of a selection, and the poses that it rejected.
struct SelectedPoses {
  PoseSet poses;                        ///< selected poses
  std::vector<double> condition;        ///< condition number at each pose; see Model::condition
  std::vector<RejectedPoses> rejected;  ///< numbers of rejected poses by reason, most frequent first
  /// Number of poses that an interior or grid search examined; 0 for other selections. A boundary search rejects poses
  /// in any workspace, so its numbers say nothing about the workspace.
  std::uint64_t candidates = 0;
  std::vector<double> time;  ///< [poses] time of each pose of a trajectory, s, ascending; empty for other selections
};

/// The progress of a search for poses.
struct PoseSearch {
  std::size_t found;       ///< number of poses that were found
  std::size_t wanted;      ///< number of poses that are wanted
  std::size_t candidates;  ///< number of poses that were examined
};

/// A function that a search calls after each pose that it examined; the search stops if the function returns false.
using WatchSearch = std::function<bool(const PoseSearch&)>;

/// Selects the study's poses; the result depends only on the arguments. A pose of the box is feasible if the model
/// reaches it, every limited joint stays in its range, and the condition number at the pose is at most max_condition.
///
/// - interior: the first `count` feasible points of the Sobol' sequence in the box. A smaller set is the beginning of a
/// larger one.
/// - boundary: points of the feasible set's boundary, uniform by area; see boundary_poses(). A smaller set is the
/// beginning of a larger one.
/// - grid: with grid_counts, all feasible points of the grid that has these numbers of points; the last coordinate
/// changes fastest. The points divide each range evenly, both ends included; a count of 1 gives the middle of the
/// range. Without grid_counts, it is the coarsest grid that has the same number of points along each coordinate and at
/// least `count` feasible points; `count` of these are kept, evenly spread.
/// - file: the poses of the file, which may be given in the coordinates of a chart.
/// - trajectory: the poses of sampled(), in the order of time.
///
/// Throws InputError if the box gives fewer poses than wanted: at the place of a joint limit if this limit is the most
/// frequent reason of rejection, otherwise at the place of the selection. An interior search gives up after max(100
/// 000, 100 count) candidates, or after 50 000 candidates in a row without a feasible one. For a boundary see
/// boundary_poses(). Every search gives up if the first 3000 candidates are all out of reach. A grid search gives up
/// before a grid with more than max(100 000, 100 count) candidates. It also gives up after 100 000 candidates in all
/// grids if, with the share of them that is feasible, the largest such grid would give less than a quarter of the
/// poses. Throws InputError at count_place if poses of the boundary coincide up to rounding. Throws InputError for the
/// first pose of a file or a trajectory that does not exist, is out of reach or exceeds max_condition: at the line of
/// the file if the poses are the points of a file, otherwise at the study's trajectory.
SelectedPoses select_poses(const PoseSelection& selection, const Model& model);

/// Selects poses like select_poses() above, and reports progress to `watch`, which may be empty. None if `watch`
/// stopped the search.
std::optional<SelectedPoses> select_poses(const PoseSelection& selection, const Model& model, const WatchSearch& watch);

}  // namespace poesy
