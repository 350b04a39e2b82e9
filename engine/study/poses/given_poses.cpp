#include "engine/study/poses/given_poses.h"

#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "engine/base/contract.h"
#include "engine/base/units.h"

namespace poesy {
namespace {

constexpr int kDigits = 6;
constexpr const char* kSi = " (numbers in the file are SI: metres and radians, unless its first line names units)";
constexpr const char* kNoPose = "does not exist: no pose has these coordinates";

/// "z = 0.5 m, beta = 20 rad = 1145.92 deg", as a file has them.
std::string as_written(std::span<const double> point, const std::vector<PoseCoordinate>& coordinates) {
  std::string text;
  for (std::size_t c = 0; c < point.size(); ++c) {
    const Quantity value{point[c], coordinates[c].dimension};
    text += (c > 0 ? ", " : "") + coordinates[c].name + " = " + to_text(value);
    if (value.dimension == Dimension::angle) text += " = " + readable_text(value, kDigits);
  }
  return text;
}

/// "z = 500 mm, beta = 1145.92 deg".
std::string readable(std::span<const double> point, const std::vector<PoseCoordinate>& coordinates) {
  std::string text;
  for (std::size_t c = 0; c < point.size(); ++c) {
    text += (c > 0 ? ", " : "") + coordinates[c].name + " = " +
            readable_text({point[c], coordinates[c].dimension}, kDigits);
  }
  return text;
}

/// What to do where no pose has a point's coordinates. Only a chart has such points.
std::string advice(const PoseTable& table, const Model& model) {
  return table.chart ? model.description().charts[*table.chart].advice : std::string();
}

std::string near_singular(double condition, double largest) {
  return "is singular or nearly so: its condition number " + readable_text({condition, Dimension::number}, kDigits) +
         " is above max_condition, " + shortest(largest);
}

/// A file's poses: refused with their line.
class FileJudge {
 public:
  FileJudge(const PoseSelection& selection, const Model& model) : selection_(&selection), model_(&model) {}

  const PoseTable& table() const { return selection_->from_file; }

  [[noreturn]] void refuse(std::size_t m, const std::string& why, const std::string& remedy) const {
    Place line = selection_->place;
    line.line += m;
    const auto& names = coordinates(model_->description(), table().chart);
    throw InputError(
        line, "pose " + std::to_string(m + 1) + " (" + as_written(table().points[PoseIndex(m)], names) + ") " + why,
        remedy + kSi);
  }

  static std::string if_unreachable() { return "correct or remove this pose"; }
  static std::string if_singular() { return "remove this pose"; }

 private:
  const PoseSelection* selection_;
  const Model* model_;
};

/// The points of a trajectory: refused with their time, singular ones too.
class TrajectoryJudge {
 public:
  TrajectoryJudge(const PoseSelection& selection, const TimedPoints& points, const Model& model)
      : selection_(&selection),
        trajectory_(&*selection.trajectory),
        points_(&points),
        model_(&model),
        elsewhere_(trajectory_->curve ? "move its origin or shorten its time" : "move the curve") {}

  const PoseTable& table() const { return points_->table; }

  [[noreturn]] void refuse(std::size_t m, const std::string& why, const std::string& remedy) const {
    const auto& names = coordinates(model_->description(), table().chart);
    throw InputError(place_of(m),
                     "point " + std::to_string(m + 1) + " of " + std::to_string(table().points.size()) +
                         ", at t = " + readable_text({points_->time[m], Dimension::time}, kDigits) + " (" +
                         readable(table().points[PoseIndex(m)], names) + "), " + why,
                     remedy + (trajectory_->curve ? "" : kSi));
  }

  std::string if_unreachable() const { return elsewhere_ + ", or change the geometry"; }
  std::string if_singular() const { return elsewhere_ + " away from singular poses, or raise max_condition"; }

 private:
  Place place_of(std::size_t m) const {
    if (trajectory_->points > 0) return selection_->place;
    Place line = trajectory_->first_row;
    line.line += m;
    return line;
  }

  const PoseSelection* selection_;
  const Trajectory* trajectory_;
  const TimedPoints* points_;
  const Model* model_;
  std::string elsewhere_;
};

std::optional<std::vector<double>> pose_of(const PoseTable& table, std::size_t m, const Model& model) {
  const auto point = table.points[PoseIndex(m)];
  if (table.chart) return model.pose_from_chart(*table.chart, point);
  return std::vector(point.begin(), point.end());
}

/// The condition number of point m's pose. The judge refuses it where the mechanism cannot take it.
template <class Judge>
double condition_of(const Judge& judge, std::size_t m, const std::optional<std::vector<double>>& pose,
                    const Model& model, double max_condition) {
  if (!pose) judge.refuse(m, kNoPose, advice(judge.table(), model));
  if (const auto reason = model.unreachable(*pose))
    judge.refuse(m, "is out of reach: " + *reason, judge.if_unreachable());
  const double condition = model.condition(*pose);
  if (condition <= max_condition) return condition;
  judge.refuse(m, near_singular(condition, max_condition), judge.if_singular());
}

/// All poses of the judge's table. Throws what the judge throws.
template <class Judge>
SelectedPoses poses_of(const Judge& judge, const Model& model, double max_condition) {
  SelectedPoses selected;
  std::vector<double> values;
  for (std::size_t m = 0; m < judge.table().points.size(); ++m) {
    const auto pose = pose_of(judge.table(), m, model);
    selected.condition.push_back(condition_of(judge, m, pose, model, max_condition));
    values.insert(values.end(), pose->begin(), pose->end());
  }
  selected.poses = PoseSet(model.description().pose_coordinates.size(), std::move(values));
  return selected;
}

}  // namespace

SelectedPoses file_poses(const PoseSelection& selection, const Model& model) {
  return poses_of(FileJudge(selection, model), model, selection.max_condition);
}

SelectedPoses trajectory_poses(const PoseSelection& selection, const Model& model) {
  POESY_EXPECTS(selection.trajectory.has_value());
  TimedPoints points = sampled(*selection.trajectory, model.description());
  SelectedPoses selected = poses_of(TrajectoryJudge(selection, points, model), model, selection.max_condition);
  selected.time = std::move(points.time);
  return selected;
}

}  // namespace poesy
