#include "engine/io/result_parts.h"
#include "engine/run/points_radius.h"

namespace poesy {
namespace {

constexpr std::string_view kMeaning =
    "How mismatch of angle is weighed against mismatch of position. platform: by the root mean square displacement of "
    "points of the platform; published: radians against metres at the origin of the base frame";

void add_points(ResultBuilder& result, const std::vector<PlatformPoint>& points) {
  std::vector<double> values;
  for (const PlatformPoint& point : points) values.insert(values.end(), point.begin(), point.end());
  result.add_axis("metric_point", positions(points.size()), {"1", "Number of the point, from 0"});
  result.add_axis("axis", std::vector<std::string>{"x", "y", "z"}, {"1", "Axis of the platform's frame"});
  result.show_axes("/metric", {"metric_point", "axis"});
  result.add("/metric/points", {"metric_point", "axis"}, values,
             {"m", "Points of the platform by whose displacement mismatch is judged, in its frame"});
}

}  // namespace

void add_metric(ResultBuilder& result, const Study& study) {
  if (study.model().metric.empty()) return;
  result.file().make_group("/metric");
  result.file().set_attribute("/metric", "name", study.model().metric);
  result.file().set_attribute("/metric", "description", std::string(kMeaning));
  const std::vector<PlatformPoint> points = build_model(study.mechanism)->metric_points();
  if (!points.empty()) add_points(result, points);
}

void read_metric(const h5::File& file, StoredResult& result) {
  if (!file.exists("/metric")) return;
  result.metric = file.attribute<std::string>("/metric", "name").at(0);
  if (!file.exists("/metric/points")) return;
  const std::size_t count = axis_length(file, "metric_point");
  const auto values = read_exactly<double>(file, "/metric/points", 3 * count);
  result.metric_points.resize(count);
  for (std::size_t k = 0; k < values.size(); ++k) result.metric_points[k / 3][k % 3] = values[k];
}

void add_radius_tau(ResultBuilder& result, const std::vector<double>& tau) {
  result.add_axis("radius_multiple", std::vector<double>(kPointsRadii.begin(), kPointsRadii.end()),
                  {"1", "Distance of the metric's points from their middle, over that in /metric/points"});
  result.add("/metric/radius_tau", {"radius_multiple", "response"}, tau,
             {"1",
              "Kendall's tau of the errors' effects with the metric's points so far from their middle and as they are, "
              "to first order, without the background's errors, at up to 32 of the poses"});
}

std::vector<double> read_radius_tau(const h5::File& file) {
  if (!file.exists("/metric/radius_tau")) return {};
  return read_exactly<double>(file, "/metric/radius_tau", kPointsRadii.size() * axis_length(file, "response"));
}

}  // namespace poesy
