#include "engine/kinds/sensitivity/figures.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numeric>

#include "engine/kinds/sensitivity/indices.h"
#include "engine/kinds/sensitivity/ranking.h"
#include "engine/report/display.h"
#include "engine/stats/indices.h"
#include "engine/stats/rank_correlation.h"
#include "engine/stats/tolerance.h"

namespace poesy::sensitivity {
namespace {

bool same_poses(const StoredResult& a, const StoredResult& b) {
  if (a.poses.size() != b.poses.size() || a.poses.coordinates() != b.poses.coordinates()) return false;
  for (std::size_t c = 0; c < a.poses.coordinates(); ++c) {
    if (a.poses.column(c) != b.poses.column(c)) return false;
  }
  return true;
}

/// [errors x poses] The effect (local index x sigma, SI) in result b minus that in result a, for the errors that both
/// results have. response: its position in a, and in b.
ErrorCells local_differences(const StoredResult& a, const StoredResult& b, const Common& factors,
                             std::pair<std::size_t, std::size_t> response) {
  const ErrorCells in_a = local_effects(a, response.first);
  const ErrorCells in_b = local_effects(b, response.second);
  ErrorCells differences({factors.size(), a.poses.size()});
  for (std::size_t n = 0; n < factors.size(); ++n) {
    const auto& [pa, pb] = factors[n];
    const double sigma = std::max(a.factor_sigma[pa], b.factor_sigma[pb]);
    for (std::size_t m = 0; m < a.poses.size(); ++m) {
      const double difference = in_b(pb, m) - in_a(pa, m);
      differences(n, m) = std::abs(difference) < kIndexRounding * sigma ? 0.0 : difference;
    }
  }
  return differences;
}

/// The errors that both results have, in the order of their ranks in a.
Common ranked_common(const StoredResult& a, const StoredResult& b) {
  Common factors = common(names_of(a.factors), names_of(b.factors));
  const std::vector<std::size_t> ranks = ranked_errors(a, default_ranking(a)).ranks;
  std::ranges::sort(factors, {}, [&](const auto& both) { return ranks[both.first]; });
  return factors;
}

/// Appends to the page the section that shows at which poses the indices of two results, a and b, differ. If the
/// results are not at the same poses, the section only says so.
void add_where(const StoredResult& a, const StoredResult& b, Page& page) {
  if (!same_poses(a, b)) {
    page.add_section("where", "Where in the workspace they differ")
        .paragraph("A and B were not solved at the same poses, so they cannot be compared pose by pose.");
    return;
  }
  const PoseFigures figures(a, sensitivity_cells(a), page);
  const Common factors = ranked_common(a, b);
  std::vector<std::string> rows;
  for (const auto& both : factors) rows.push_back(a.factors[both.first].name);
  std::vector<HeatLayer> layers;
  std::vector<Field> fields;
  std::string order;
  for (const auto& both : common(names_of(a.responses, figures.responses()), names_of(b.responses))) {
    const std::size_t r = figures.responses()[both.first];
    const NamedUnit& response = a.responses[r];
    const ErrorCells values = local_differences(a, b, factors, {r, both.second});
    if (layers.empty()) order = first_order(a, values);
    layers.push_back({"B - A, effect on " + response.name, unit_text(response),
                      figures.add(fmt::format("difference/{}", r), values, response), true});
    fields.push_back({layers.back().label, layers.back().unit, layers.back().value, rows, true});
  }
  if (layers.empty()) return;
  Section& section = page.add_section("where", "Where in the workspace they differ");
  section.paragraph("The effect of each error at each pose in B, less that in A.");
  figures.add_note(section);
  add_figure(page, section, "heat", figures.heat_map(std::move(layers), std::move(rows), std::move(order)),
             "A row for each error that both have, the most important in A first, a column for each pose.");
  figures.add_workspace(section, std::move(fields), "Each dot is a pose, coloured by what is chosen.");
}

/// Appends to the page the section that shows the rankings of errors by two results, a and b, side by side.
void add_rankings(const ReportedResult& a, const ReportedResult& b, Page& page) {
  const auto ranked = [](const ReportedResult& one) {
    return RankedResult{one.stored, one.path, default_ranking(one.stored), sensitivity_tally(one.stored).total()};
  };
  const RankedResult ranked_a = ranked(a);
  const RankedResult ranked_b = ranked(b);
  const TwoRankings rankings = two_rankings(ranked_a, ranked_b, RowOrder::effect);
  Section& section = page.add_section("rankings", "The two rankings");
  section.paragraph(ranked_text('A', ranked_a) + ".");
  section.paragraph(ranked_text('B', ranked_b) + ".");
  for (const std::string& remark : rankings.remarks) section.paragraph(remark);
  section.table(rankings.table);
  if (differ_in_metric(a.stored, b.stored)) {
    section.paragraph("Below, responses of the same name are compared. Two metrics do not mean the same by them.");
  }
}

/// The root mean square of the response over samples and poses, predicted from the effects of single errors
/// (stats/tolerance.h), in the display unit.
double total_rms(const StoredResult& result, std::size_t response) {
  const MeanSquare squares =
      mean_square(response_study(sensitivity_of(result), result.factor_sigma, result.factor_mean, response));
  return std::sqrt(squares.at(result.factor_sigma)) / display(result.responses[response]).si;
}

}  // namespace

SolveTally sensitivity_tally(const StoredResult& result) {
  const Result& found = sensitivity_of(result);
  SolveTally made{"error", names_of(result.factors), result.poses.size(), {found.solves.begin(), found.solves.end()}};
  if (!found.fidelity) return made;
  const FidelityResult& compared = *found.fidelity;
  const auto& failed = compared.not_converged;
  made.second = {.first = compared.fidelities[0],
                 .second = compared.fidelities[1],
                 .not_converged = std::accumulate(failed.begin(), failed.end(), std::uint64_t{0}),
                 .total = made.total().total(),
                 .not_linear = static_cast<std::size_t>(std::ranges::count(compared.linear, std::uint8_t{0})),
                 .errors = compared.linear.size()};
  return made;
}

ShownCells sensitivity_cells(const StoredResult& result) {
  return shown_cells(result, result.factors.size() * (result.time.empty() ? 1 : 2));
}

std::vector<double> in_shown_units(const StoredResult& result, const Result::Indices& indices, bool as_effect) {
  std::vector<double> list;
  for (const std::size_t r : response_order(result)) {
    for (std::size_t p = 0; p < result.factors.size(); ++p) {
      const double scale = as_effect ? result.factor_sigma[p] : display(result.factors[p]).si;
      const double index = without_rounding(result, indices(r, p), r, p);
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

ErrorCells local_effects(const StoredResult& result, std::size_t response) {
  const Result& found = sensitivity_of(result);
  ErrorCells effects({found.factors(), found.poses()});
  for (std::size_t p = 0; p < found.factors(); ++p) {
    for (std::size_t m = 0; m < found.poses(); ++m) {
      effects(p, m) = without_rounding(result, found.local(response, p, m), response, p) * result.factor_sigma[p];
    }
  }
  return effects;
}

Bars error_bars(const StoredResult& result, std::vector<BarQuantity> quantities) {
  return {{}, std::move(quantities), names_of(result.factors)};
}

BarQuantity share_quantity(std::string label, const std::string& array, std::span<const double> values,
                           ArrayPool& pool) {
  return {std::move(label), {{"%"}}, pool.add(array, values, 0.01)};
}

std::string PoseOrder::name(const StoredResult& result) const {
  const std::string& coordinate_name = result.pose_coordinates[coordinate].name;
  return magnitude ? "|" + coordinate_name + "|" : coordinate_name;
}

std::vector<double> root_sum_squares(const ErrorCells& cells) {
  std::vector<double> sums(cells.length<axis::Pose>(), 0.0);
  for (std::size_t p = 0; p < cells.length<axis::Factor>(); ++p) {
    for (std::size_t m = 0; m < sums.size(); ++m) sums[m] += cells(p, m) * cells(p, m);
  }
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

std::string first_order(const StoredResult& result, const ErrorCells& cells) {
  if (!result.time.empty()) return {};
  const auto order = explaining_order(result, root_sum_squares(cells));
  return order ? order->name(result) : std::string();
}

Comparable comparable_sensitivity(const StoredResult& result, const StoredResult&) {
  const GlobalIndices indices = shown_indices(result);
  Comparable all = comparable_by_response(result, "error", names_of(result.factors));
  all.ranked = true;
  const auto add = [&](std::string label, std::string array, bool as_effect) {
    all.quantities.push_back({std::move(label), std::move(array), units_of_indices(result, as_effect),
                              in_shown_units(result, indices.value, as_effect),
                              in_shown_units(result, indices.low, as_effect),
                              in_shown_units(result, indices.high, as_effect)});
  };
  add("effect at the size each study sets (index x sigma)", "effect", true);
  add("global index", "index", false);
  all.total_label = "All errors together, predicted from each alone: root mean square over samples and poses";
  for (const std::size_t r : response_order(result)) all.totals.push_back(total_rms(result, r));
  return all;
}

std::vector<Merit> sensitivity_merits(const StoredResult& result, std::string_view response) {
  if (response.empty()) return {};
  const std::size_t r = response_named(result, response);
  return {{.what = fmt::format("predicted root mean square of {}", response),
           .unit = unit_text(result.responses[r]),
           .value = total_rms(result, r)}};
}

void compare_sensitivity(const ReportedResult& a, const ReportedResult& b, const Comparison& compared, Page& page) {
  add_rankings(a, b, page);
  add_comparison(compared, page);
  add_where(a.stored, b.stored, page);
}

}  // namespace poesy::sensitivity
