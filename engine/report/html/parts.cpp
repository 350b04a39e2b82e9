#include "engine/report/html/parts.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "engine/base/units.h"
#include "engine/report/ranking.h"
#include "engine/report/tables.h"

namespace poesy {
namespace {

Coordinate time_axis(const StoredResult& result, const ShownCells& shown, ArrayPool& pool) {
  return {"time", "s", pool.add("axis_time", shown.at_poses(result.time))};
}

Coordinate number_axis(const ShownCells& shown, ArrayPool& pool) {
  const std::vector<double> numbers(shown.poses.begin(), shown.poses.end());
  return {"pose number", "", pool.add("axis_number", numbers)};
}

/// Numbers that figures by pose show of each response at each pose.
std::size_t rows_of_cells(const StoredResult& result) {
  constexpr std::size_t kSummaries = 4;  // mean or median, quantiles and the like
  std::size_t rows = kSummaries;
  if (result.kind == "sensitivity") rows = result.factors.size() * (result.time.empty() ? 1 : 2);
  if (result.kind == "coupling") rows = result.coupling.found.sizes * (2 * result.coupling.found.subsets + 3);
  if (result.kind == "evaluate" && !result.cases.empty()) rows = result.cases.size();
  return std::max<std::size_t>(rows, 1);
}

}  // namespace

std::vector<std::string> names_of(const std::vector<NamedUnit>& things, std::span<const std::size_t> positions) {
  std::vector<std::string> list;
  for (const std::size_t at : positions) list.push_back(things[at].name);
  return list;
}

std::vector<std::size_t> headline_order(const StoredResult& result) {
  std::vector<std::size_t> order = result.headline;
  const auto first = std::ranges::find(order, response_named(result, default_ranking(result)));
  if (first != order.end()) std::rotate(order.begin(), first, first + 1);
  return order;
}

std::vector<std::size_t> response_order(const StoredResult& result) {
  std::vector<std::size_t> order = headline_order(result);
  for (std::size_t r = 0; r < result.responses.size(); ++r) {
    if (std::ranges::find(result.headline, r) == result.headline.end()) order.push_back(r);
  }
  return order;
}

std::vector<std::vector<std::string>> index_units(const StoredResult& result, std::span<const std::size_t> responses,
                                                  std::span<const std::size_t> factors) {
  std::vector<std::vector<std::string>> units;
  for (const std::size_t r : responses) {
    std::vector<std::string> of_items;
    for (const std::size_t p : factors) {
      of_items.push_back(fmt::format("{}/{}", display(result.responses[r]).name, display(result.factors[p]).name));
    }
    units.push_back(std::move(of_items));
  }
  return units;
}

std::vector<std::vector<std::string>> response_units(const StoredResult& result,
                                                     std::span<const std::size_t> responses) {
  std::vector<std::vector<std::string>> units;
  for (const std::size_t r : responses) units.push_back({unit_text(result.responses[r])});
  return units;
}

std::string order_by_effect(bool mixed) {
  return std::string("by their effect, the largest first") +
         (mixed ? "; indices per mm and per deg do not compare" : "");
}

bool mixed_units(const std::vector<NamedUnit>& things) {
  return std::ranges::any_of(things, [&](const NamedUnit& one) { return one.unit != things[0].unit; });
}

std::vector<double> order_statistics(const EvaluationResult& found, std::size_t response, std::size_t first,
                                     std::size_t count, std::span<const double> levels) {
  std::vector<double> values;
  for (std::size_t at = first; at < first + count; ++at) {
    if (solved(found.status[at])) values.push_back(found.response[response * found.poses * found.samples + at]);
  }
  std::ranges::sort(values);
  std::vector<double> list;
  for (const double level : levels) {
    const double at = std::round(level * (static_cast<double>(values.size()) - 1.0));
    list.push_back(values.empty() ? std::nan("") : values[static_cast<std::size_t>(at)]);
  }
  return list;
}

double share_not_converged(const SolveCounts& solves) {
  if (solves.total() == 0) return std::numeric_limits<double>::quiet_NaN();
  return static_cast<double>(solves.not_converged()) / static_cast<double>(solves.total());
}

SolveCounts sum_of(std::span<const SolveCounts> solves) {
  SolveCounts sum;
  for (const SolveCounts& one : solves) sum.merge(one);
  return sum;
}

std::vector<Table> take_tables(std::vector<Table>& tables, std::span<const std::string_view> names) {
  std::vector<Table> taken;
  for (const std::string_view name : names) {
    const auto at = std::ranges::find(tables, name, &Table::name);
    if (at == tables.end()) continue;
    taken.push_back(std::move(*at));
    tables.erase(at);
  }
  return taken;
}

std::vector<double> ShownCells::at_poses(std::span<const double> values) const {
  std::vector<double> kept;
  if (poses.empty()) return kept;
  kept.reserve(values.size() / all_poses * poses.size());
  for (std::size_t row = 0; row < values.size(); row += all_poses) {
    for (const std::size_t m : poses) kept.push_back(values[row + m]);
  }
  return kept;
}

std::string ShownCells::note() const {
  std::string text;
  if (responses.size() < all_responses) {
    text += fmt::format("So that the report stays small, its figures by pose show {} of the {} responses. ",
                        responses.size(), all_responses);
  }
  if (thinned()) {
    text += fmt::format(
        "So that the report stays small, its figures by pose show {} of the {} poses, evenly spread over their order; "
        "tables and indices are of all. ",
        count_text(poses.size()), count_text(all_poses));
  }
  if (!text.empty()) text += "The result file and 'poesy export' have everything.";
  return text;
}

ShownCells shown_cells(const StoredResult& result) {
  // Norms have no sign and cannot tell what cancels, so of a coupling they are no loss.
  const bool coupling = result.kind == "coupling";
  const std::size_t rows = rows_of_cells(result);
  ShownCells shown;
  shown.responses = coupling ? result.signed_headline : response_order(result);
  shown.all_responses = shown.responses.size();
  shown.all_poses = result.poses.size();
  const bool all = rows * shown.all_poses * shown.all_responses <= ShownCells::kMostWithAllResponses;
  if (!all && !coupling) shown.responses = headline_order(result);
  const std::size_t layers = std::max<std::size_t>(shown.responses.size(), 1);
  const std::size_t most =
      std::max<std::size_t>(1, std::min(ShownCells::kMostInLayer / rows, ShownCells::kMost / (rows * layers)));
  const std::size_t kept = std::min(shown.all_poses, most);
  for (std::size_t n = 0; n < kept; ++n) shown.poses.push_back(n * shown.all_poses / kept);
  return shown;
}

std::vector<Coordinate> pose_coordinates(const StoredResult& result, const ShownCells& shown, ArrayPool& pool) {
  std::vector<Coordinate> coordinates;
  for (std::size_t c = 0; c < result.pose_coordinates.size(); ++c) {
    const NamedUnit& named = result.pose_coordinates[c];
    const std::vector<double> values = shown.at_poses(result.poses.column(c));
    coordinates.push_back(
        {named.name, unit_text(named), pool.add(fmt::format("pose/{}", c), values, display(named).si)});
  }
  return coordinates;
}

std::vector<Coordinate> column_coordinates(const StoredResult& result, const ShownCells& shown, ArrayPool& pool) {
  std::vector<Coordinate> coordinates = pose_coordinates(result, shown, pool);
  if (!result.time.empty()) coordinates.push_back(time_axis(result, shown, pool));
  return coordinates;
}

ArrayName pose_numbers(const ShownCells& shown, ArrayPool& pool) {
  return shown.thinned() ? number_axis(shown, pool).value : ArrayName();
}

Coordinate pose_axis(const StoredResult& result, const ShownCells& shown, ArrayPool& pool) {
  return result.time.empty() ? number_axis(shown, pool) : time_axis(result, shown, pool);
}

Field pose_field(const std::string& array, std::string label, std::string unit, std::span<const double> values,
                 const ShownCells& shown, ArrayPool& pool, double scale) {
  return {std::move(label), std::move(unit), pool.add(array, shown.at_poses(values), scale)};
}

std::vector<Field> condition_field(const StoredResult& result, const ShownCells& shown, ArrayPool& pool) {
  if (result.condition.empty()) return {};
  return {pose_field("condition", "condition number of the pose", "", result.condition, shown, pool)};
}

void add_figure(Page& page, Section& section, const std::string& key, Figure figure, std::string_view caption) {
  page.figures.figures.emplace(key, std::move(figure));
  section.figure(key, caption);
}

}  // namespace poesy
