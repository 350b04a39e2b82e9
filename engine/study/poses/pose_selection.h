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

/// An immutable list of poses with the same number of coordinates. Coordinates are in SI.
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

/// Points that give poses, in the model's pose coordinates or in the coordinates of one of its charts (PoseChart).
struct PoseTable {
  std::optional<std::size_t> chart;    ///< index in ModelDescription::charts; none: the model's pose coordinates
  PoseSet points;                      ///< [points] coordinates of each point, SI
  std::vector<std::string> bare = {};  ///< names of the coordinates for which the file states no unit
};

/// The coordinates of the model's chart with this index; if `chart` is empty, the model's pose coordinates.
const std::vector<PoseCoordinate>& coordinates(const ModelDescription& model, std::optional<std::size_t> chart);

/// The points of a trajectory, with the times at which the trajectory passes them.
struct TimedPoints {
  std::vector<double> time;  ///< time of each point, s, strictly ascending
  PoseTable table;           ///< points, in the order of time
};

inline constexpr double kLatestTime = 1e9;  ///< largest magnitude of a time, s: about 30 years, far from overflow

/// A trajectory in a study: a named curve of the model, or points of a file.
struct Trajectory {
  std::optional<std::size_t> curve = {};  ///< index in ModelDescription::curves; none: points of a file
  /// Point that is added to every point of the curve: coordinates of the curve's chart, SI.
  std::vector<double> origin = {};
  std::string file = {};       ///< name of the file in the study; empty for a curve
  TimedPoints from_file = {};  ///< points of the file, at least two; empty if the file was not opened
  std::size_t points = 0;      ///< number of poses, evenly spaced in time; 0: the poses are the points of the file
  /// Start and end of the trajectory, s. None if `points` is 0, or if they follow from a file that was not opened.
  std::optional<Range> time = {};
  Place first_row = {};  ///< place of the first point in the file; each further point is one line further down
};

/// The points of a trajectory. For a curve: its points at evenly spaced times, including both ends. For a file: the
/// points in the file if Trajectory::points is 0, otherwise points that are interpolated at evenly spaced times. Each
/// coordinate is interpolated independently of the others, by a modified Akima spline through four or more points, or
/// by straight lines through two or three. Precondition: a file was opened, and the times are inside its range.
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
  /// Number of poses. With grid_counts it is the product of these numbers; for a trajectory it is the number of its
  /// points; for `file` it is unused.
  std::size_t count = 0;
  std::vector<std::size_t> grid_counts;  ///< number of points for each pose coordinate, with `grid`; otherwise empty
  /// [pose coordinates] Box in which `interior`, `boundary` and `grid` search poses; empty for other selections.
  std::vector<Range> workspace;
  std::vector<JointLimit> limits;  ///< limits of joints, for selections with a box
  /// Largest condition number (Model::condition) of a pose; above it a pose counts as singular.
  double max_condition = 1e8;
  std::string file;     ///< for `file`: name of the file in the study
  PoseTable from_file;  ///< for `file`: poses of the file
  /// For `trajectory`: the trajectory; none if the study is read for StudyUse::evaluate and states none.
  std::optional<Trajectory> trajectory;
  /// Place of the workspace, of the file's first pose (each further pose is one line further down), or of the
  /// trajectory; for messages.
  Place place;
  Place count_place;  ///< place of the key `count`, for messages
};

/// The number of poses that a search rejected for one reason.
struct RejectedPoses {
  std::string reason;  ///< reason in words: "q_1_3 above 80 mm"
  std::size_t count;   ///< number of poses that were rejected for this reason
};

/// The beginning of RejectedPoses::reason for poses that the mechanism cannot reach.
inline constexpr std::string_view kOutOfReach = "out of reach: ";

/// Returns true if some of these poses were rejected because the mechanism cannot reach them.
bool some_out_of_reach(std::span<const RejectedPoses> rejected);

/// A sentence on the poses of a boundary, which says that they can be at the end of the mechanism's reach. Empty if it
/// reaches all poses that the search examined.
std::string end_of_reach_text(std::span<const RejectedPoses> rejected);

/// A sentence that says how many of the examined poses of a workspace were rejected, and why. Empty if none was.
/// candidates: number of poses that the search examined; if it is 0 (not known), the sentence is empty.
std::string rejected_text(std::span<const RejectedPoses> rejected, std::size_t candidates);

/// The poses that select_poses() found, and statistics of the poses that it rejected.
struct SelectedPoses {
  PoseSet poses;                        ///< selected poses
  std::vector<double> condition;        ///< condition number at each pose; see Model::condition
  std::vector<RejectedPoses> rejected;  ///< numbers of rejected poses by reason, most frequent first
  /// Number of poses that an interior search, or a grid search in its last grid, examined; 0 for other selections. A
  /// boundary search rejects poses in any workspace, so its number would say nothing about the workspace.
  std::uint64_t candidates = 0;
  std::vector<double> time;  ///< [poses] time of each pose of a trajectory, s, ascending; empty for other selections
};

/// The progress of a search for poses.
struct PoseSearch {
  std::size_t found;       ///< number of poses that were found
  std::size_t wanted;      ///< number of poses that are wanted
  std::size_t candidates;  ///< number of poses that were examined
};

/// A function that a search calls for each pose that it examines; the search stops if the function returns false.
using WatchSearch = std::function<bool(const PoseSearch&)>;

/// Selects the study's poses; the result depends only on the arguments. The box is PoseSelection::workspace. A pose in
/// it is feasible if the model reaches it, every joint with a limit is within its range, and the condition number is at
/// most max_condition.
///
/// - interior: the first `count` feasible points of the Sobol' sequence in the box. The poses for a smaller `count` are
/// the first of those for a larger one.
/// - boundary: points on the boundary of the feasible set, uniform by area; see boundary_poses(). Also here the poses
/// for a smaller `count` are the first of those for a larger one.
/// - grid: with grid_counts, all feasible points of the grid that has these numbers of points; the last coordinate
/// changes fastest. The points divide each range evenly, both ends included; a count of 1 gives the middle of the
/// range. Without grid_counts, the coarsest grid is used that has the same number of points along each coordinate and
/// at least `count` feasible points, of which `count` are kept, evenly spread.
/// - file: the poses of the file, which may state them in the coordinates of a chart.
/// - trajectory: the poses of sampled(), in the order of time.
///
/// Throws InputError if the box gives fewer than `count` poses (with grid_counts: no pose): at the place of a joint
/// limit if this limit is the most frequent reason of rejection, otherwise at the place of the selection. A search
/// gives up, with N = max(100 000, 100 count):
///
/// - interior: after N candidates; after 50 000 candidates in a row without a feasible one; or if the first 3000
/// candidates are all out of reach.
/// - boundary: see boundary_poses().
/// - grid with grid_counts: never, all points are examined.
/// - grid without grid_counts: before a grid with more than N points; after a grid of at least 3000 points that are all
/// out of reach; or if 100 000 points were examined in all grids together, and with their share of feasible points a
/// grid of N points would give fewer than count / 4 poses.
///
/// Throws InputError at count_place if poses of the boundary coincide up to rounding. Throws InputError for the first
/// pose of a file or a trajectory that does not exist, is out of reach or has a condition number above max_condition:
/// at the line of the file if the poses are the points of a file, otherwise at the study's trajectory.
SelectedPoses select_poses(const PoseSelection& selection, const Model& model);

/// Selects poses like select_poses() above, and reports progress to `watch`, which may be empty. None if `watch` stops
/// the search.
std::optional<SelectedPoses> select_poses(const PoseSelection& selection, const Model& model, const WatchSearch& watch);

}  // namespace poesy
