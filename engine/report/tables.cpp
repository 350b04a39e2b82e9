#include "engine/report/tables.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>
#include <utility>
#include <vector>

#include "engine/report/coupling_table.h"
#include "engine/report/display.h"
#include "engine/report/text_table.h"

namespace poesy {
namespace {

std::string chart_text(const PoseChart& chart) {
  std::string text = fmt::format("\nposes may be given by {}\n", chart.name);
  for (const PoseCoordinate& coordinate : chart.coordinates) {
    text += fmt::format("  {:<16} {:>8} {}\n", coordinate.name, si_unit(coordinate.dimension), coordinate.description);
  }
  return text;
}

std::string curve_text(const NamedCurve& curve, const ModelDescription& model) {
  const PoseChart& chart = model.charts[curve.chart];
  std::string origin;
  for (std::size_t c = 0; c < curve.origin.size(); ++c) {
    origin += (c > 0 ? ", " : "") + readable_text({curve.origin[c], chart.coordinates[c].dimension});
  }
  return fmt::format("  {:<16} {}; t from {} to {} s, by {}, from the origin ({}) unless the study sets it\n",
                     curve.name, curve.description, curve.start, curve.end, chart.name, origin);
}

void add(std::vector<Table>& tables, std::optional<Table> table) {
  if (table) tables.push_back(std::move(*table));
}

std::vector<Table> sensitivity_tables(const StoredResult& result, const RankedErrors& ranked) {
  std::vector<Table> tables{ranked_table(result, ranked)};
  add(tables, separation_table(result, ranked));
  add(tables, fidelity_table(result, ranked));
  add(tables, convergence_table(result));
  return tables;
}

/// The responses, by which metric where there is one.
std::string responses_text(const ModelDescription& model) {
  std::string text = "\nresponses";
  if (!model.metric.empty()) text += fmt::format(" by [solver] metric = \"{}\"", model.metric);
  text += model.metric == "published" ? ", which a study without the key has\n" : "\n";
  for (const Response& response : model.responses) {
    text += fmt::format("  {:<20} {:>4} {}\n", response.name, si_unit(response.dimension), response.description);
  }
  return text;
}

}  // namespace

SolveCounts solves_of(const StoredResult& result) {
  if (result.kind == "sensitivity") return result.sensitivity.total();
  if (result.kind == "identification") return result.identification.solves;
  if (result.kind == "monte-carlo") return result.monte_carlo.total();
  if (result.kind == "coupling") return result.coupling.found.total();
  return result.evaluation.total();
}

std::string summary_text(const StoredResult& result, std::size_t width) {
  const RunFacts& facts = result.facts;
  const double per_second =
      static_cast<double>(facts.solves) / std::max(facts.wall_seconds, std::numeric_limits<double>::min());
  const std::string each =
      result.sensitivity.fidelity ? fmt::format(", {} at each of two fidelities,", count_text(facts.solves / 2)) : "";
  std::string text = prose_of(result.title, width);
  text += prose_of(fmt::format("{} of {}: {}, poesy {}", result.kind, result.model,
                               counted(result.poses.size(), "pose", "poses"), result.poesy_version),
                   width);
  if (!result.metric.empty()) text += prose_of("metric: " + metric_text(result), width);
  text += prose_of(fmt::format("{}{} in {:.2f} s on {}: {} solves/s", counted(facts.solves, "solve", "solves"), each,
                               facts.wall_seconds, counted(facts.threads, "thread", "threads"),
                               count_text(static_cast<std::uint64_t>(std::llround(per_second)))),
                   width);
  return text;
}

std::string default_ranking(const StoredResult& result) {
  for (const std::size_t r : result.headline) {
    if (dimension_of(result.responses[r].unit) == Dimension::length) return result.responses[r].name;
  }
  return result.headline.empty() ? std::string() : result.responses[result.headline.front()].name;
}

std::vector<Table> result_tables(const StoredResult& result, std::string_view ranked_by, RowOrder order) {
  if (result.kind == "sensitivity") return sensitivity_tables(result, ranked_errors(result, ranked_by, order));
  if (result.kind == "identification") return identification_tables(result);
  if (result.kind == "monte-carlo") {
    std::vector<Table> tables;
    add(tables, limits_table(result));
    for (Table& table : monte_carlo_tables(result)) tables.push_back(std::move(table));
    add(tables, convergence_table(result));
    return tables;
  }
  if (result.kind == "coupling") return coupling_tables(result);
  std::vector<Table> tables;
  add(tables, limits_table(result));
  tables.push_back(result.cases.empty() ? evaluation_table(result) : cases_table(result));
  add(tables, parts_table(result));
  return tables;
}

void keep_first(std::size_t most, std::span<Table> tables) {
  for (Table& table : tables) {
    if (!table.ranked || table.rows.size() <= most) continue;
    table.notes.push_back(fmt::format("{} of {} errors shown", most, table.rows.size()));
    table.rows.resize(most);
  }
}

std::string models_text(const Catalog& catalog) {
  std::string text;
  for (const CatalogEntry& entry : catalog) {
    text += fmt::format("{:<12} {}\n", entry.description.name, entry.description.title);
  }
  return text;
}

std::string model_text(const CatalogEntry& entry) {
  const ModelDescription& model = entry.description;
  std::string text = fmt::format("{}: {}\n\ngeometry (change it in [mechanism] geometry)\n", model.name, model.title);
  for (const GeometryParameter& parameter : model.geometry) {
    const Unit& unit = display_unit(parameter.dimension);
    text += fmt::format("  {:<16} {:>8.6g} {:<4} {}\n", parameter.name, parameter.published / unit.si, unit.name,
                        parameter.description);
  }
  if (!model.fidelities.empty()) {
    text += "\nfidelity (choose it in [mechanism]; the first is the default)\n";
    for (const std::string& fidelity : model.fidelities) text += "  " + fidelity + "\n";
  }
  text += "\npose coordinates and default workspace\n";
  for (std::size_t c = 0; c < model.pose_coordinates.size(); ++c) {
    const PoseCoordinate& coordinate = model.pose_coordinates[c];
    const Unit& unit =
        coordinate.dimension == Dimension::angle ? *find_unit("rad") : display_unit(coordinate.dimension);
    text += fmt::format("  {:<16} {:>8.6g} to {:<8.6g} {:<4} {}\n", coordinate.name, model.pose_lower[c] / unit.si,
                        model.pose_upper[c] / unit.si, unit.name, coordinate.description);
  }
  text += fmt::format("  {}\n", model.workspace_note);
  for (const PoseChart& chart : model.charts) text += chart_text(chart);
  if (!model.curves.empty()) text += "\ncurves (select = \"trajectory\")\n";
  for (const NamedCurve& curve : model.curves) text += curve_text(curve, model);
  text += "\nfactor sets\n";
  for (const FactorSet& set : model.factor_sets) {
    text += fmt::format("  {:<16} {:>8} {}\n", set.name, set.factors.size(), set.description);
  }
  if (!model.sources.empty()) text += "\nsources of errors (of a coupling study that names none)\n";
  for (const CouplingSource& source : model.sources) text += fmt::format("  {:<16} {}\n", source.name, source.set);
  text += "\nerror factors\n";
  for (const Factor& factor : model.factors) {
    text += fmt::format("  {:<16} {:>8} {}\n", factor.name, si_unit(factor.dimension), factor.description);
  }
  text += responses_text(model);
  if (entry.by_platform) text += responses_text(entry.by_platform->description);
  text += "\ndetails (given by `poesy evaluate`)\n";
  for (const Detail& detail : model.details) {
    text += fmt::format("  {:<20} {:>4} {}\n", detail.name, detail.components.size(), detail.description);
  }
  return text;
}

}  // namespace poesy
