#include "engine/kinds/sensitivity/figures.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numeric>

#include "engine/kinds/sensitivity/ranking.h"
#include "engine/kinds/sensitivity/result.h"
#include "engine/report/display.h"
#include "engine/stats/rank_correlation.h"

namespace poesy {

SolveTally sensitivity_tally(const StoredResult& result) {
  const SensitivityResult& found = sensitivity_of(result);
  SolveTally made{"error", names_of(result.factors), result.poses.size(), found.solves};
  if (!found.fidelity) return made;
  const std::vector<std::uint64_t>& failed = found.fidelity->not_converged;
  const std::vector<std::uint8_t>& linear = found.fidelity->linear;
  const std::vector<std::string>& fidelities = sensitivity_of(result).fidelities;
  made.second = {.first = fidelities[0],
                 .second = fidelities[1],
                 .not_converged = std::accumulate(failed.begin(), failed.end(), std::uint64_t{0}),
                 .total = made.total().total(),
                 .not_linear = static_cast<std::size_t>(std::ranges::count(linear, std::uint8_t{0})),
                 .errors = linear.size()};
  return made;
}

ShownCells sensitivity_cells(const StoredResult& result) {
  return shown_cells(result, result.factors.size() * (result.time.empty() ? 1 : 2));
}

std::vector<double> in_shown_units(const StoredResult& result, const std::vector<double>& indices, bool as_effect) {
  std::vector<double> list;
  const std::size_t factors = result.factors.size();
  for (const std::size_t r : response_order(result)) {
    for (std::size_t p = 0; p < factors; ++p) {
      const double scale = as_effect ? result.factor_sigma[p] : display(result.factors[p]).si;
      const double index = without_rounding(result, indices[r * factors + p], r, p);
      list.push_back(index * scale / display(result.responses[r]).si);
    }
  }
  return list;
}

std::vector<std::vector<std::string>> units_of_indices(const StoredResult& result, bool as_effect) {
  if (as_effect) return response_units(result, response_order(result));
  std::vector<std::vector<std::string>> units;
  for (const std::size_t r : response_order(result)) {
    std::vector<std::string>& of_errors = units.emplace_back();
    for (const NamedUnit& factor : result.factors) {
      of_errors.push_back(fmt::format("{}/{}", display(result.responses[r]).name, display(factor).name));
    }
  }
  return units;
}

std::vector<double> local_effects(const StoredResult& result, std::size_t response) {
  const SensitivityResult& found = sensitivity_of(result);
  const std::size_t cells = found.factors * found.poses;
  std::vector<double> effects(cells);
  for (std::size_t cell = 0; cell < cells; ++cell) {
    const std::size_t p = cell / found.poses;
    effects[cell] =
        without_rounding(result, found.local[response * cells + cell], response, p) * result.factor_sigma[p];
  }
  return effects;
}

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
