#include <algorithm>
#include <boost/math/interpolators/makima.hpp>
#include <cmath>
#include <functional>

#include "engine/study/poses/workspace.h"

namespace poesy {
namespace {

constexpr int kDigits = 6;
constexpr const char* kSi = " (numbers in the file are SI: metres and radians, unless its first line names units)";

using Function = std::function<double(double time)>;

/// Interpolates values over time by a modified Akima spline, or by straight lines if there are only two or three
/// points.
Function interpolated(std::vector<double> time, std::vector<double> values) {
  constexpr std::size_t kSplinePoints = 4;
  if (time.size() >= kSplinePoints) {
    return boost::math::interpolators::makima<std::vector<double>>(std::move(time), std::move(values));
  }
  return [time = std::move(time), values = std::move(values)](double t) {
    const auto after = std::clamp(std::ranges::upper_bound(time, t), time.begin() + 1, time.end() - 1);
    const auto k = static_cast<std::size_t>(after - time.begin());
    return std::lerp(values[k - 1], values[k], (t - time[k - 1]) / (time[k] - time[k - 1]));
  };
}

/// The point of a trajectory as a function of time (s). The point is in the coordinates of the trajectory
/// (PoseTable::chart), SI. The trajectory and the model must outlive the function.
std::function<std::vector<double>(double time)> path_of(const Trajectory& trajectory, const ModelDescription& model) {
  if (trajectory.curve) {
    return [&at = model.curves[*trajectory.curve].at, &origin = trajectory.origin](double time) {
      std::vector<double> point = at(time);
      POESY_EXPECTS(point.size() == origin.size());
      for (std::size_t c = 0; c < point.size(); ++c) point[c] = origin[c] + point[c];
      return point;
    };
  }
  const TimedPoints& known = trajectory.from_file;
  POESY_EXPECTS(known.time.size() >= 2 && known.time.size() == known.table.points.size());
  std::vector<Function> coordinates;
  for (std::size_t c = 0; c < known.table.points.coordinates(); ++c) {
    coordinates.push_back(interpolated(known.time, known.table.points.column(c)));
  }
  return [coordinates](double time) {
    std::vector<double> point;
    for (const Function& coordinate : coordinates) point.push_back(coordinate(time));
    return point;
  };
}

/// A point as text. If `as_in_file`, values are in SI, and angles also in degrees: "z = 0.5 m, beta = 20 rad = 1145.92
/// deg". Otherwise values are in the units that results show.
std::string point_text(std::span<const double> point, const std::vector<PoseCoordinate>& coordinates, bool as_in_file) {
  std::string text;
  for (std::size_t c = 0; c < point.size(); ++c) {
    const Quantity value{point[c], coordinates[c].dimension};
    text += (c > 0 ? ", " : "") + coordinates[c].name + " = ";
    if (as_in_file) text += to_text(value);
    if (as_in_file && value.dimension == Dimension::angle) text += " = ";
    if (!as_in_file || value.dimension == Dimension::angle) text += readable_text(value, kDigits);
  }
  return text;
}

/// The parts of the message that refuses point m of a table.
struct PointRefusal {
  std::function<Place(std::size_t m)> place;        ///< place of point m
  std::function<std::string(std::size_t m)> point;  ///< name of point m in messages, such as "pose 1 (...)"
  std::string if_unreachable;                       ///< advice for a point out of reach
  std::string if_singular;                          ///< advice for a singular point
  std::string note;                                 ///< text that follows the advice
};

/// The poses of all points of a table. Throws InputError for the first point that gives no pose, is out of reach or
/// singular, and SearchStopped if `watch` stops the search.
SelectedPoses poses_of(const PoseTable& table, const PointRefusal& refusal, const Model& model, double max_condition,
                       const WatchSearch& watch) {
  SelectedPoses selected;
  std::vector<double> values;
  for (std::size_t m = 0; m < table.points.size(); ++m) {
    tell(watch, {.found = m, .wanted = table.points.size(), .candidates = m});
    const auto refuse = [&](const std::string& why, const std::string& remedy) {
      throw InputError(refusal.place(m), refusal.point(m) + why, remedy + refusal.note);
    };
    const auto point = table.points[PoseIndex(m)];
    const auto pose = table.chart ? model.pose_from_chart(*table.chart, point)
                                  : std::optional(std::vector(point.begin(), point.end()));
    if (!pose) {
      const std::string why = model.no_pose_because(*table.chart, point);
      refuse(why.empty() ? "does not exist: no pose has these coordinates" : "is out of reach: " + why,
             model.description().charts[*table.chart].advice);
    }
    if (const auto reason = model.unreachable(*pose)) refuse("is out of reach: " + *reason, refusal.if_unreachable);
    const double condition = model.condition(*pose);
    if (!(condition <= max_condition)) {
      refuse("is singular or nearly so: its condition number " +
                 readable_text({condition, Dimension::number}, kDigits) + " is above max_condition, " +
                 shortest(max_condition),
             refusal.if_singular);
    }
    selected.condition.push_back(condition);
    values.insert(values.end(), pose->begin(), pose->end());
  }
  selected.poses = PoseSet(model.description().pose_coordinates.size(), std::move(values));
  return selected;
}

Place below(Place first, std::size_t lines) {
  first.line += lines;
  return first;
}

}  // namespace

const std::vector<PoseCoordinate>& coordinates(const ModelDescription& model, std::optional<std::size_t> chart) {
  return chart ? model.charts[*chart].coordinates : model.pose_coordinates;
}

TimedPoints sampled(const Trajectory& trajectory, const ModelDescription& model) {
  if (!trajectory.curve && trajectory.points == 0) return trajectory.from_file;
  TimedPoints found{{}, {trajectory.from_file.table.chart, {}}};
  if (trajectory.curve) found.table.chart = model.curves[*trajectory.curve].chart;
  const auto path = path_of(trajectory, model);
  std::vector<double> values;
  for (std::size_t k = 0; k < trajectory.points; ++k) {
    const double share = static_cast<double>(k) / static_cast<double>(trajectory.points - 1);
    found.time.push_back(std::lerp(trajectory.time->lower, trajectory.time->upper, share));
    const std::vector<double> point = path(found.time.back());
    values.insert(values.end(), point.begin(), point.end());
  }
  found.table.points = PoseSet(coordinates(model, found.table.chart).size(), std::move(values));
  return found;
}

SelectedPoses file_poses(const PoseSelection& selection, const Model& model, const WatchSearch& watch) {
  const PoseTable& table = selection.from_file;
  const auto& names = coordinates(model.description(), table.chart);
  const auto point = [&](std::size_t m) {
    return "pose " + std::to_string(m + 1) + " (" + point_text(table.points[PoseIndex(m)], names, true) + ") ";
  };
  return poses_of(table,
                  {.place = [&](std::size_t m) { return below(selection.place, m); },
                   .point = point,
                   .if_unreachable = "correct or remove this pose",
                   .if_singular = "remove this pose",
                   .note = kSi},
                  model, selection.max_condition, watch);
}

SelectedPoses trajectory_poses(const PoseSelection& selection, const Model& model, const WatchSearch& watch) {
  POESY_EXPECTS(selection.trajectory.has_value());
  const Trajectory& trajectory = *selection.trajectory;
  TimedPoints points = sampled(trajectory, model.description());
  const auto& names = coordinates(model.description(), points.table.chart);
  const auto point = [&](std::size_t m) {
    return "point " + std::to_string(m + 1) + " of " + std::to_string(points.time.size()) +
           ", at t = " + readable_text({points.time[m], Dimension::time}, kDigits) + " (" +
           point_text(points.table.points[PoseIndex(m)], names, false) + "), ";
  };
  const std::string elsewhere = trajectory.curve ? "move its origin or shorten its time" : "move the curve";
  SelectedPoses selected = poses_of(
      points.table,
      {.place = [&](std::size_t m) { return trajectory.points > 0 ? selection.place : below(trajectory.first_row, m); },
       .point = point,
       .if_unreachable = elsewhere + ", or change the geometry",
       .if_singular = elsewhere + " away from singular poses, or raise max_condition",
       .note = trajectory.curve ? "" : kSi},
      model, selection.max_condition, watch);
  selected.time = std::move(points.time);
  return selected;
}

}  // namespace poesy
