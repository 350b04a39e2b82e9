#include "engine/kinds/sensitivity/ranking.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "engine/kinds/sensitivity/indices.h"
#include "engine/stats/rounding.h"

namespace poesy {
namespace {

/// What the errors are put in order by, the largest first.
double key(const StoredResult& result, std::size_t response, std::size_t p, RowOrder order) {
  const SensitivityResult& found = sensitivity_of(result);
  switch (order) {
    case RowOrder::effect:
      return effect(result, response, p);
    case RowOrder::index:
      return shown_indices(result).value[response * found.factors + p] * display(result.factors[p]).si;
    case RowOrder::not_converged:
      return share_not_converged(found, p);
    case RowOrder::name:
    case RowOrder::study:
      break;
  }
  return 0.0;
}

std::vector<std::size_t> ordered(const StoredResult& result, std::size_t response, RowOrder order) {
  std::vector<std::size_t> rows = positions(sensitivity_of(result).factors);
  if (order == RowOrder::name) {
    std::ranges::stable_sort(rows, {}, [&](std::size_t p) { return result.factors[p].name; });
    return rows;
  }
  std::ranges::stable_sort(rows, std::ranges::greater(), [&](std::size_t p) {
    const double value = key(result, response, p, order);
    return std::isnan(value) ? -std::numeric_limits<double>::infinity() : value;
  });
  return rows;
}

}  // namespace

bool has_corrected_indices(const StoredResult& result) { return !sensitivity_of(result).global_corrected.empty(); }

GlobalIndices published_indices(const StoredResult& result) {
  const SensitivityResult& found = sensitivity_of(result);
  return {found.global, found.global_ci_low, found.global_ci_high};
}

GlobalIndices shown_indices(const StoredResult& result) {
  const SensitivityResult& found = sensitivity_of(result);
  if (!has_corrected_indices(result)) return published_indices(result);
  return {found.global_corrected, found.global_corrected_ci_low, found.global_corrected_ci_high};
}

double index_rounding(const StoredResult& result, std::size_t response, std::size_t factor) {
  return index_rounding(sensitivity_of(result), response, result.factor_sigma[factor]);
}

double without_rounding(const StoredResult& result, double index, std::size_t response, std::size_t factor) {
  return told_from_rounding(index, index_rounding(result, response, factor));
}

bool has_effect(const StoredResult& result, std::size_t response, std::size_t factor) {
  return has_effect(shown_indices(result).value[response * sensitivity_of(result).factors + factor],
                    index_rounding(result, response, factor));
}

double effect(const StoredResult& result, std::size_t response, std::size_t factor) {
  return shown_indices(result).value[response * sensitivity_of(result).factors + factor] * result.factor_sigma[factor];
}

FilledColumn index_column(const StoredResult& result, const std::vector<double>& values, std::size_t response,
                          std::string name, std::string heading, int dispensable) {
  const Unit& unit = display(result.responses[response]);
  return {number_column(std::move(name), std::move(heading), fmt::format("{}/unit", unit.name), dispensable),
          [&result, &values, &unit, response](std::size_t p) {
            return index_cell(values[response * result.factors.size() + p], display(result.factors[p]).si / unit.si,
                              index_rounding(result, response, p));
          }};
}

double share_not_converged(const SensitivityResult& result, std::size_t factor) {
  SolveCounts solves;
  for (std::size_t m = 0; m < result.poses; ++m) solves.merge(result.solves[factor * result.poses + m]);
  return solves.total() == 0 ? 0.0 : static_cast<double>(solves.not_converged()) / static_cast<double>(solves.total());
}

RankedErrors ranked_errors(const StoredResult& result, std::string_view response, RowOrder order) {
  RankedErrors found{response_named(result, response), {}, std::vector<std::size_t>(sensitivity_of(result).factors)};
  const std::vector<std::size_t> by_effect = ordered(result, found.response, RowOrder::effect);
  for (std::size_t n = 0; n < by_effect.size(); ++n) found.ranks[by_effect[n]] = n + 1;
  found.rows = order == RowOrder::effect ? by_effect : ordered(result, found.response, order);
  return found;
}

}  // namespace poesy
