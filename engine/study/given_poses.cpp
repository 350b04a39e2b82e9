#include "engine/study/given_poses.h"

#include <string>

#include "engine/base/contract.h"
#include "engine/base/units.h"

namespace poesy {
namespace {

constexpr int kDigits = 6;
constexpr const char* kSi = " (numbers in the file are SI: metres and radians)";

/// "z = 0.5 m, beta = 20 rad = 1145.92 deg", or with `readable` "z = 500 mm, beta = 1145.92 deg".
std::string described(std::span<const double> point, const std::vector<PoseCoordinate>& coordinates, bool readable) {
  std::string text;
  for (std::size_t c = 0; c < point.size(); ++c) {
    const Quantity value{point[c], coordinates[c].dimension};
    text += (c > 0 ? ", " : "") + coordinates[c].name;
    if (!readable) text += " = " + to_text(value);
    if (readable || value.dimension == Dimension::angle) text += " = " + readable_text(value, kDigits);
  }
  return text;
}

std::optional<std::vector<double>> pose_of(const PoseTable& table, std::size_t m, const Model& model) {
  const auto point = table.points[PoseIndex(m)];
  if (table.chart) return model.pose_from_chart(*table.chart, point);
  return std::vector(point.begin(), point.end());
}

/// What to do where no pose has a point's coordinates. Only a chart has such points.
std::string advice(const PoseTable& table, const Model& model) {
  return table.chart ? model.description().charts[*table.chart].advice : std::string();
}

/// The poses of a table, whose values follow; judge(m, pose) throws where one cannot be had, and gives its condition.
template <class Judge>
SelectedPoses poses_of(const PoseTable& table, const Model& model, const Judge& judge) {
  SelectedPoses selected;
  std::vector<double> values;
  for (std::size_t m = 0; m < table.points.size(); ++m) {
    const auto pose = pose_of(table, m, model);
    selected.condition.push_back(judge(m, pose));
    values.insert(values.end(), pose->begin(), pose->end());
  }
  selected.poses = PoseSet(model.description().pose_coordinates.size(), std::move(values));
  return selected;
}

}  // namespace

SelectedPoses file_poses(const PoseSelection& selection, const Model& model) {
  const PoseTable& table = selection.from_file;
  const auto judge = [&](std::size_t m, const std::optional<std::vector<double>>& pose) {
    const auto refuse = [&](const std::string& why, const std::string& remedy) {
      Place line = selection.place;
      line.line += m;
      const std::string who =
          described(table.points[PoseIndex(m)], coordinates(model.description(), table.chart), false);
      throw InputError(line, "pose " + std::to_string(m + 1) + " (" + who + ") " + why, remedy + kSi);
    };
    if (!pose) refuse("does not exist: no pose has these coordinates", advice(table, model));
    if (const auto reason = model.unreachable(*pose)) {
      refuse("is out of reach: " + *reason, "correct or remove this pose");
    }
    return model.condition(*pose);
  };
  return poses_of(table, model, judge);
}

SelectedPoses trajectory_poses(const PoseSelection& selection, const Model& model) {
  POESY_EXPECTS(selection.trajectory.has_value());
  const Trajectory& trajectory = *selection.trajectory;
  TimedPoints points = sampled(trajectory, model.description());
  const PoseTable& table = points.table;
  const auto judge = [&](std::size_t m, const std::optional<std::vector<double>>& pose) {
    const auto refuse = [&](const std::string& why, const std::string& remedy) {
      Place place = selection.place;
      if (trajectory.points == 0) {
        place = trajectory.first_row;
        place.line += m;
      }
      const std::string who =
          "point " + std::to_string(m + 1) + " of " + std::to_string(table.points.size()) +
          ", at t = " + readable_text({points.time[m], Dimension::time}, kDigits) + " (" +
          described(table.points[PoseIndex(m)], coordinates(model.description(), table.chart), true) + "), ";
      throw InputError(place, who + why, remedy + (trajectory.curve ? "" : kSi));
    };
    const std::string elsewhere = trajectory.curve ? "move its origin or shorten its time" : "move the curve";
    if (!pose) refuse("does not exist: no pose has these coordinates", advice(table, model));
    if (const auto reason = model.unreachable(*pose)) {
      refuse("is out of reach: " + *reason, elsewhere + ", or change the geometry");
    }
    const double condition = model.condition(*pose);
    if (!(condition <= selection.max_condition)) {
      refuse("is singular or nearly so: its condition number " +
                 readable_text({condition, Dimension::number}, kDigits) + " is above max_condition, " +
                 shortest(selection.max_condition),
             elsewhere + " away from singular poses, or raise max_condition");
    }
    return condition;
  };
  SelectedPoses selected = poses_of(table, model, judge);
  selected.time = std::move(points.time);
  return selected;
}

}  // namespace poesy
