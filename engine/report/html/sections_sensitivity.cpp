#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <numeric>
#include <span>

#include "engine/io/tolerance_files.h"
#include "engine/report/display.h"
#include "engine/report/html/outcomes.h"
#include "engine/report/html/parts.h"
#include "engine/report/html/pose_order.h"
#include "engine/report/html/sections.h"
#include "engine/report/ranking.h"
#include "engine/report/tables.h"
#include "engine/run/sensitivity.h"
#include "engine/stats/tolerance.h"

namespace poesy {
namespace {

/// Indices [R x P] in the units shown and the order of response_order: as effects, index x sigma, or as they are.
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

/// Positions of all errors.
std::vector<std::size_t> all_errors(const StoredResult& result) {
  std::vector<std::size_t> all(result.factors.size());
  std::iota(all.begin(), all.end(), std::size_t{0});
  return all;
}

BarQuantity bar_quantity(const StoredResult& result, bool as_effect, ArrayPool& pool) {
  const GlobalIndices shown = shown_indices(result);
  const std::string name = as_effect ? "global_effect" : "global_index";
  const auto add = [&](const std::string& suffix, const std::vector<double>& indices) {
    return pool.add(name + suffix, in_shown_units(result, indices, as_effect));
  };
  return {.label = as_effect ? "effect at the size the study sets (index x sigma)" : "global index",
          .units = as_effect ? response_units(result, response_order(result))
                             : index_units(result, response_order(result), all_errors(result)),
          .value = add("", shown.value),
          .low = add("_low", shown.low),
          .high = add("_high", shown.high)};
}

/// Positions of values, the largest first.
std::vector<std::size_t> largest_first(const std::vector<double>& values) {
  std::vector<std::size_t> order(values.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::ranges::stable_sort(order, std::ranges::greater{}, [&](std::size_t p) { return values[p]; });
  return order;
}

/// The errors that make most of the mean square, and those that together make next to none; empty where not all of
/// their effects are known, or none has one.
std::string few_matter_text(const StoredResult& result) {
  constexpr double kMost = 0.8;
  constexpr double kHardly = 0.01;
  if (!has_tolerances(result)) return {};
  const std::size_t response = response_named(result, default_ranking(result));
  const MeanSquare found = mean_square(response_study(result.sensitivity, result.factor_sigma, response));
  const std::vector<double> shares = mean_square_shares(found, result.factor_sigma);
  if (std::ranges::any_of(shares, [](double share) { return std::isnan(share); })) return {};
  const std::vector<std::size_t> order = largest_first(shares);
  std::vector<std::string> names;
  double sum = 0.0;
  while (sum < kMost && names.size() < order.size()) {
    const std::size_t p = order[names.size()];
    names.push_back(result.factors[p].name);
    sum += shares[p];
  }
  std::size_t hardly = 0;
  for (double tail = 0.0; hardly < order.size(); ++hardly) {
    tail += shares[order[order.size() - 1 - hardly]];
    if (tail >= kHardly) break;
  }
  std::string text = fmt::format(
      "{} of {} {} {:.0f} % of what the study's sizes add to the mean square of {} over samples and poses: {}.",
      names.size(), counted(order.size(), "error", "errors"), names.size() == 1 ? "makes" : "make", 100.0 * sum,
      result.responses[response].name, some_names(names));
  if (hardly > 0)
    text += fmt::format(" {} hardly {} (below 1 % together).", hardly, hardly == 1 ? "matters" : "matter");
  return text;
}

constexpr std::string_view kCorrected =
    "The published estimator counts the noise of sampling as spread between poses; the value shown is without that "
    "noise, and 'published' in the table is with it.";
constexpr std::string_view kPublished =
    "The value shown is the published estimator, which counts the noise of sampling as spread between poses, because "
    "an older poesy wrote this result.";

Section which_errors_matter(const StoredResult& result, std::vector<Table>& tables, Page& page) {
  Section section("which-errors-matter", "Which errors matter");
  section.paragraph(fmt::format(
      "The global index of an error is the scatter of a response for each unit of scatter of the error, its mean over "
      "the {} plus its spread between them. Times the size that the study gives the error it is the effect, which "
      "compares lengths with angles. Bars end at the value; the thin lines are {:.3g} % intervals. {}",
      counted(result.poses.size(), "pose", "poses"), 100.0 * result.sensitivity.conf_level,
      has_corrected_indices(result) ? kCorrected : kPublished));
  if (const std::string text = few_matter_text(result); !text.empty()) section.paragraph(text);
  Bars bars{{{"response", names_of(result.responses, response_order(result))}},
            {bar_quantity(result, true, page.figures.pool), bar_quantity(result, false, page.figures.pool)},
            names_of(result.factors)};
  add_figure(page, section, "ranking", std::move(bars),
             "The errors " + order_by_effect(mixed_units(result.factors)) + ".");
  for (const Table& table : take_tables(tables, std::vector<std::string_view>{"ranked"})) section.table(table);
  return section;
}

/// Local indices x sigma of one response, [P x M], SI.
std::vector<double> local_effects(const StoredResult& result, std::size_t response) {
  const SensitivityResult& found = result.sensitivity;
  const std::size_t cells = found.factors * found.poses;
  std::vector<double> effects(cells);
  for (std::size_t cell = 0; cell < cells; ++cell) {
    const std::size_t p = cell / found.poses;
    effects[cell] =
        without_rounding(result, found.local[response * cells + cell], response, p) * result.factor_sigma[p];
  }
  return effects;
}

/// Rows of values [P x M] in this order.
std::vector<double> in_order(const std::vector<double>& values, std::span<const std::size_t> rows) {
  const std::size_t columns = rows.empty() ? 0 : values.size() / rows.size();
  std::vector<double> list;
  list.reserve(values.size());
  for (const std::size_t row : rows) {
    const auto begin = values.begin() + static_cast<std::ptrdiff_t>(row * columns);
    list.insert(list.end(), begin, begin + static_cast<std::ptrdiff_t>(columns));
  }
  return list;
}

/// Effects at each pose and samples not converged, as layers of rows x poses, the most important error first.
std::vector<HeatLayer> layers(const StoredResult& result, const ShownCells& shown, ArrayPool& pool) {
  std::vector<HeatLayer> list;
  const std::vector<std::size_t> rows = ranked_errors(result, default_ranking(result)).rows;
  for (const std::size_t r : shown.responses) {
    const NamedUnit& response = result.responses[r];
    const std::vector<double> effects = shown.at_poses(in_order(local_effects(result, r), rows));
    list.push_back({"effect on " + response.name, unit_text(response),
                    pool.add(fmt::format("effect/{}", r), effects, display(response).si)});
  }
  list.push_back({"not converged", "%",
                  pool.add("not_converged", shown.at_poses(in_order(tally_of(result).shares(), rows)), 0.01)});
  return list;
}

/// The layers as fields of the workspace.
std::vector<Field> fields(const StoredResult& result, const std::vector<HeatLayer>& layers, const ShownCells& shown,
                          ArrayPool& pool) {
  std::vector<Field> list;
  const std::vector<std::string> rows = names_of(result.factors, ranked_errors(result, default_ranking(result)).rows);
  for (const HeatLayer& layer : layers) list.push_back({layer.label, layer.unit, layer.value, rows});
  for (Field& field : condition_field(result, shown, pool)) list.push_back(std::move(field));
  return list;
}

/// Curves of the local effects over the time of a trajectory, those of the most important errors first.
Lines along_trajectory(const StoredResult& result, const ShownCells& shown, ArrayPool& pool) {
  Lines lines{.x = pose_axis(result, shown, pool), .panels = {}};
  const std::size_t poses = result.poses.size();
  for (const std::size_t r : shown.responses) {
    const NamedUnit& response = result.responses[r];
    Panel panel{response.name, unit_text(response), {}};
    const std::vector<double> effects = local_effects(result, r);
    for (const std::size_t p : ranked_errors(result, response.name).rows) {
      const std::vector<double> curve = shown.at_poses(std::span(effects).subspan(p * poses, poses));
      const std::string array = fmt::format("curve/{}/{}", r, p);
      panel.series.push_back({result.factors[p].name, pool.add(array, curve, display(response).si)});
    }
    lines.panels.push_back(std::move(panel));
  }
  return lines;
}

/// With which coordinate the effects of all errors grow or fall; empty where none is clear.
std::string trend_text(const StoredResult& result) {
  const std::size_t r = response_named(result, default_ranking(result));
  const auto order = explaining_order(result, root_sum_squares(local_effects(result, r), result.poses.size()));
  if (!order || !(std::abs(order->correlation) >= kClearCorrelation)) return {};
  return fmt::format(
      "The effect of all errors on {}, the root sum square of theirs, {} with {}: their rank correlation over the "
      "poses "
      "is {:.2f}.",
      result.responses[r].name, order->correlation > 0.0 ? "grows" : "falls", order->name(result), order->correlation);
}

/// Where the most important error has its largest effect; empty where poses hardly differ.
std::string worst_place_text(const StoredResult& result) {
  constexpr double kHardlyDiffers = 1.05;
  const RankedErrors ranked = ranked_errors(result, default_ranking(result));
  if (ranked.rows.empty()) return {};
  const std::size_t error = ranked.rows.front();
  const std::vector<double> all = local_effects(result, ranked.response);
  const auto effects = std::span(all).subspan(error * result.poses.size(), result.poses.size());
  std::size_t worst = 0;
  double sum = 0.0;
  for (std::size_t m = 0; m < effects.size(); ++m) {
    sum += effects[m];
    if (effects[m] > effects[worst]) worst = m;
  }
  const double ratio = effects.empty() ? 0.0 : effects[worst] * static_cast<double>(effects.size()) / sum;
  if (!(ratio >= kHardlyDiffers)) return {};  // neither where an effect is not known
  return fmt::format("The effect of {} on {} is largest at {}, {:.1f} times its mean over the poses.",
                     result.factors[error].name, result.responses[ranked.response].name, place_text(result, worst),
                     ratio);
}

Section where(const StoredResult& result, Page& page) {
  ArrayPool& pool = page.figures.pool;
  const ShownCells shown = shown_cells(result);
  Section section("where", "Where in the workspace");
  section.paragraph(
      "The effect of each error at each pose: its local index there times the size that the study gives it. The last "
      "layer is the share of samples that did not converge.");
  for (const std::string& text : {trend_text(result), worst_place_text(result)}) {
    if (!text.empty()) section.paragraph(text);
  }
  if (!shown.note().empty()) section.paragraph(shown.note());
  const std::vector<HeatLayer> shown_layers = layers(result, shown, pool);
  if (!result.time.empty()) {
    add_figure(page, section, "trajectory", along_trajectory(result, shown, pool),
               "The effect of each error along the trajectory.");
  }
  add_figure(
      page, section, "heat",
      HeatMap{shown_layers, names_of(result.factors, ranked_errors(result, default_ranking(result)).rows), "pose",
              column_coordinates(result, shown, pool), pose_numbers(shown, pool),
              first_order(result, local_effects(result, response_named(result, default_ranking(result))))},
      "A row for each error, the most important first, a column for each pose. Choose above in which order poses "
      "stand.");
  add_figure(page, section, "workspace",
             WorkspaceMap{pose_coordinates(result, shown, pool), fields(result, shown_layers, shown, pool),
                          pose_numbers(shown, pool)},
             "Each dot is a pose of the study, coloured by what is chosen.");
  return section;
}

}  // namespace

void add_sensitivity(const StoredResult& result, Page& page) {
  std::vector<Table> tables = result_tables(result, default_ranking(result));
  page.sections.push_back(which_errors_matter(result, tables, page));
  page.sections.push_back(where(result, page));
  add_certainty(result, tables, page);
  add_tolerances(result, page);
  add_separation(result, tables, page);
  add_fidelity(result, tables, page);
  if (!tables.empty()) page.sections[0].folded("More tables", tables);
}

}  // namespace poesy
