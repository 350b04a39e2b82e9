#include "engine/io/result_parts.h"

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

}  // namespace poesy
