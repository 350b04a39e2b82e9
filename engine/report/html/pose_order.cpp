#include "engine/report/html/pose_order.h"

#include <algorithm>
#include <cmath>

#include "engine/stats/rank_correlation.h"

namespace poesy {

std::string PoseOrder::name(const StoredResult& result) const {
  const std::string& coordinate_name = result.pose_coordinates[coordinate].name;
  return magnitude ? "|" + coordinate_name + "|" : coordinate_name;
}

std::vector<double> root_sum_squares(std::span<const double> values, std::size_t poses) {
  std::vector<double> sums(poses, 0.0);
  for (std::size_t at = 0; at < values.size(); ++at) sums[at % poses] += values[at] * values[at];
  for (double& sum : sums) sum = std::sqrt(sum);
  return sums;
}

std::optional<PoseOrder> explaining_order(const StoredResult& result, std::span<const double> values) {
  std::optional<PoseOrder> best;
  const auto offer = [&](std::size_t c, bool magnitude, const std::vector<double>& by) {
    const double correlation = rank_correlation(by, values);
    if (std::isnan(correlation)) return;
    if (!best || std::abs(correlation) > std::abs(best->correlation)) best = {c, magnitude, correlation};
  };
  for (std::size_t c = 0; c < result.pose_coordinates.size(); ++c) {
    std::vector<double> column = result.poses.column(c);
    offer(c, false, column);
    const auto [low, high] = std::ranges::minmax(column);
    if (!(low < 0.0 && high > 0.0)) continue;
    for (double& value : column) value = std::abs(value);
    offer(c, true, column);
  }
  return best;
}

std::string first_order(const StoredResult& result, std::span<const double> values) {
  if (!result.time.empty()) return {};
  const auto order = explaining_order(result, root_sum_squares(values, result.poses.size()));
  return order ? order->name(result) : std::string();
}

}  // namespace poesy
