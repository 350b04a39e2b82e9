#include "engine/study/poses/trajectory.h"

#include <algorithm>
#include <boost/math/interpolators/makima.hpp>
#include <cmath>
#include <functional>

#include "engine/base/contract.h"

namespace poesy {
namespace {

/// A spline through fewer points does not exist.
constexpr std::size_t kSplinePoints = 4;

using Function = std::function<double(double time)>;

Function straight_lines(std::vector<double> time, std::vector<double> values) {
  return [time = std::move(time), values = std::move(values)](double t) {
    const auto after = std::clamp(std::ranges::upper_bound(time, t), time.begin() + 1, time.end() - 1);
    const auto k = static_cast<std::size_t>(after - time.begin());
    return std::lerp(values[k - 1], values[k], (t - time[k - 1]) / (time[k] - time[k - 1]));
  };
}

Function interpolated(std::vector<double> time, std::vector<double> values) {
  if (time.size() < kSplinePoints) return straight_lines(std::move(time), std::move(values));
  return boost::math::interpolators::makima<std::vector<double>>(std::move(time), std::move(values));
}

std::vector<double> evenly_spaced(const TimeRange& range, std::size_t points) {
  std::vector<double> time(points);
  for (std::size_t k = 0; k < points; ++k) {
    time[k] = std::lerp(range.start, range.end, static_cast<double>(k) / static_cast<double>(points - 1));
  }
  return time;
}

TimedPoints of_curve(const Trajectory& trajectory, const NamedCurve& curve) {
  TimedPoints found{evenly_spaced(*trajectory.time, trajectory.points), {curve.chart, {}}};
  std::vector<double> values;
  for (const double t : found.time) {
    const std::vector<double> at = curve.at(t);
    POESY_EXPECTS(at.size() == trajectory.origin.size());
    for (std::size_t c = 0; c < at.size(); ++c) values.push_back(trajectory.origin[c] + at[c]);
  }
  found.table.points = PoseSet(trajectory.origin.size(), std::move(values));
  return found;
}

TimedPoints of_file(const Trajectory& trajectory) {
  const TimedPoints& known = trajectory.from_file;
  POESY_EXPECTS(known.time.size() >= 2 && known.time.size() == known.table.points.size());
  const std::size_t width = known.table.points.coordinates();
  TimedPoints found{evenly_spaced(*trajectory.time, trajectory.points), {known.table.chart, {}}};
  std::vector<double> values(found.time.size() * width);
  for (std::size_t c = 0; c < width; ++c) {
    const Function coordinate = interpolated(known.time, known.table.points.column(c));
    for (std::size_t m = 0; m < found.time.size(); ++m) values[m * width + c] = coordinate(found.time[m]);
  }
  found.table.points = PoseSet(width, std::move(values));
  return found;
}

}  // namespace

const std::vector<PoseCoordinate>& coordinates(const ModelDescription& model, std::optional<std::size_t> chart) {
  return chart ? model.charts[*chart].coordinates : model.pose_coordinates;
}

TimedPoints sampled(const Trajectory& trajectory, const ModelDescription& model) {
  if (trajectory.curve) return of_curve(trajectory, model.curves[*trajectory.curve]);
  return trajectory.points == 0 ? trajectory.from_file : of_file(trajectory);
}

}  // namespace poesy
