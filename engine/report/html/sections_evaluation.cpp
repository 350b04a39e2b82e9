#include <fmt/format.h>

#include "engine/base/nan.h"
#include "engine/report/display.h"
#include "engine/report/html/parts.h"
#include "engine/report/html/sections.h"
#include "engine/report/tables.h"

namespace poesy {
namespace {

/// One response to one row of errors at all poses, [M]; NaN where it was not solved.
std::vector<double> response_to(const EvaluationResult& found, std::size_t r, std::size_t sample) {
  std::vector<double> values(found.poses);
  for (std::size_t m = 0; m < found.poses; ++m) {
    const std::size_t at = m * found.samples + sample;
    values[m] = solved(found.status[at]) ? found.response[r * found.poses * found.samples + at] : kNaN;
  }
  return values;
}

std::string array_of(std::string_view what, std::size_t response) { return fmt::format("{}/{}", what, response); }

/// A curve over the poses for each case, and the same as fields of the workspace.
void add_cases(const StoredResult& result, const ShownCells& shown, Page& page, Section& section) {
  ArrayPool& pool = page.figures.pool;
  Lines lines{.x = pose_axis(result, shown, pool), .panels = {}};
  std::vector<Field> fields;
  for (const std::size_t r : shown.responses) {
    const NamedUnit& response = result.responses[r];
    Panel panel{response.name, unit_text(response), {}};
    for (std::size_t c = 0; c < result.cases.size(); ++c) {
      const std::string array = fmt::format("case/{}/{}", c, r);
      const std::vector<double> values = shown.at_poses(response_to(result.evaluation, r, c));
      panel.series.push_back({result.cases[c], pool.add(array, values, display(response).si)});
      fields.push_back({fmt::format("{}, {}", response.name, result.cases[c]), unit_text(response), array});
    }
    lines.panels.push_back(std::move(panel));
  }
  for (Field& field : condition_field(result, shown, pool)) fields.push_back(std::move(field));
  add_figure(page, section, "cases", std::move(lines),
             result.time.empty() ? "Each case at each pose." : "Each case along the trajectory.");
  add_figure(page, section, "workspace",
             WorkspaceMap{pose_coordinates(result, shown, pool), std::move(fields), pose_numbers(shown, pool)},
             "Each dot is a pose of the study, coloured by what is chosen.");
}

/// Median and outer quantiles over the rows at each pose.
struct PoseQuantiles {
  std::vector<double> low;
  std::vector<double> median;
  std::vector<double> high;
  std::vector<double> max;
};

constexpr double kLow = 0.05;
constexpr double kHigh = 0.95;

PoseQuantiles quantiles_at_poses(const EvaluationResult& found, std::size_t r) {
  constexpr double kLevels[] = {kLow, 0.5, kHigh, 1.0};
  PoseQuantiles quantiles;
  for (std::size_t m = 0; m < found.poses; ++m) {
    const std::vector<double> values = order_statistics(found, r, m * found.samples, found.samples, kLevels);
    quantiles.low.push_back(values[0]);
    quantiles.median.push_back(values[1]);
    quantiles.high.push_back(values[2]);
    quantiles.max.push_back(values[3]);
  }
  return quantiles;
}

/// The distribution of a response over all poses and rows.
Series distribution(const StoredResult& result, std::size_t r, std::span<const double> levels, ArrayPool& pool) {
  const EvaluationResult& found = result.evaluation;
  const std::vector<double> values = order_statistics(found, r, 0, found.poses * found.samples, levels);
  return {"all poses and rows", pool.add(array_of("distribution", r), values, display(result.responses[r]).si)};
}

void add_distribution(const StoredResult& result, Page& page, Section& section) {
  constexpr std::size_t kLevels = 101;
  std::vector<double> levels;
  for (std::size_t n = 0; n < kLevels; ++n) levels.push_back(static_cast<double>(n) / (kLevels - 1.0));
  ArrayPool& pool = page.figures.pool;
  Lines lines{.x = {"share of the samples below", "%", pool.add("axis_levels", levels, 0.01)}, .panels = {}};
  for (const std::size_t r : headline_order(result)) {
    const NamedUnit& response = result.responses[r];
    lines.panels.push_back({response.name, unit_text(response), {distribution(result, r, levels, pool)}});
  }
  add_figure(page, section, "distribution", std::move(lines), "The distribution of each response by its quantiles.");
}

void add_rows(const StoredResult& result, const ShownCells& shown, Page& page, Section& section) {
  ArrayPool& pool = page.figures.pool;
  Lines lines{.x = pose_axis(result, shown, pool), .panels = {}};
  std::vector<Field> fields;
  for (const std::size_t r : shown.responses) {
    const NamedUnit& response = result.responses[r];
    const PoseQuantiles found = quantiles_at_poses(result.evaluation, r);
    const auto add = [&](std::string_view what, const std::vector<double>& values) {
      return pool.add(array_of(what, r), shown.at_poses(values), display(response).si);
    };
    const ArrayName median = add("median", found.median);
    const ArrayName max = add("max", found.max);
    Panel panel{
        response.name, unit_text(response), {{"median", median, add("low", found.low), add("high", found.high)}}};
    panel.series.push_back({.label = "largest", .value = max, .style = "dotted"});
    lines.panels.push_back(std::move(panel));
    fields.push_back({response.name + ", median", unit_text(response), median});
    fields.push_back({response.name + ", largest", unit_text(response), max});
  }
  for (Field& field : condition_field(result, shown, pool)) fields.push_back(std::move(field));
  add_figure(
      page, section, "rows", std::move(lines),
      "At each pose the median over the rows, in a band from the 5 % to the 95 % quantile, and the largest value.");
  add_figure(page, section, "workspace",
             WorkspaceMap{pose_coordinates(result, shown, pool), std::move(fields), pose_numbers(shown, pool)},
             "Each dot is a pose, coloured by what is chosen.");
}

std::string rows_text(const StoredResult& result) {
  const std::string poses = counted(result.poses.size(), "pose", "poses");
  if (result.pairing == Pairing::row_by_row) return fmt::format("{}, each with a row of errors of its own.", poses);
  return fmt::format("{} of errors, each at {}.", counted(result.evaluation.samples, "row", "rows"), poses);
}

}  // namespace

void add_evaluation(const StoredResult& result, Page& page) {
  const bool cases = !result.cases.empty();
  const ShownCells shown = shown_cells(result);
  std::vector<Table> tables = result_tables(result, default_ranking(result));
  add_limits(tables, page);
  Section section("responses", cases ? "What each case does" : "What the errors do");
  section.paragraph(cases ? "Each case is a fixed set of errors. Poses where it was not solved are left out."
                          : rows_text(result) + " Samples that were not solved are left out.");
  if (!cases) add_distribution(result, page, section);
  for (const Table& table : tables) section.table(table);
  page.sections.push_back(std::move(section));
  Section where("where", result.time.empty() ? "Where in the workspace" : "Along the trajectory");
  if (!shown.note().empty()) where.paragraph(shown.note());
  if (cases) {
    add_cases(result, shown, page, where);
  } else {
    add_rows(result, shown, page, where);
  }
  page.sections.push_back(std::move(where));
}

}  // namespace poesy
