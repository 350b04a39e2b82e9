#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <span>

#include "engine/base/nan.h"
#include "engine/kinds/evaluate/stored.h"
#include "engine/kinds/registry.h"
#include "engine/report/display.h"
#include "engine/run/evaluation.h"

namespace poesy {
namespace {

ShownCells cells(const StoredResult& result) {
  const std::size_t cases = evaluation_of(result).cases.size();
  return shown_cells(result, cases == 0 ? kSummaryRows : cases);
}

/// One response to one row of errors at all poses, [M]; NaN where it was not solved.
std::vector<double> response_to(const EvaluationResult& found, std::size_t r, std::size_t sample) {
  std::vector<double> values(found.poses);
  for (std::size_t m = 0; m < found.poses; ++m) {
    const std::size_t at = m * found.samples + sample;
    values[m] = solved(found.status[at]) ? found.response[r * found.poses * found.samples + at] : kNaN;
  }
  return values;
}

/// A curve over the poses for each case, and the same as fields of the workspace.
void add_cases(const StoredResult& result, const PoseFigures& figures, Page& page, Section& section) {
  const std::vector<std::string>& cases = evaluation_of(result).cases;
  Lines lines{.x = figures.axis(), .panels = {}};
  std::vector<Field> fields;
  for (const std::size_t r : figures.responses()) {
    const NamedUnit& response = result.responses[r];
    Panel panel{response.name, unit_text(response), {}};
    for (std::size_t c = 0; c < cases.size(); ++c) {
      const ArrayName array =
          figures.add(fmt::format("case/{}/{}", c, r), response_to(evaluation_of(result).evaluation, r, c), response);
      panel.series.push_back({cases[c], array});
      fields.push_back({fmt::format("{}, {}", response.name, cases[c]), unit_text(response), array});
    }
    lines.panels.push_back(std::move(panel));
  }
  add_figure(page, section, "cases", std::move(lines),
             result.time.empty() ? "Each case at each pose." : "Each case along the trajectory.");
  figures.add_condition(fields);
  figures.add_workspace(section, std::move(fields));
}

/// Order statistics of a response over these samples (positions pose x samples + sample) that were solved, NaN of none.
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

/// Median and outer quantiles over the rows at each pose.
struct PoseQuantiles {
  std::vector<double> low;
  std::vector<double> median;
  std::vector<double> high;
  std::vector<double> max;
};

PoseQuantiles quantiles_at_poses(const EvaluationResult& found, std::size_t r) {
  constexpr double kLevels[] = {0.05, 0.5, 0.95, 1.0};
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

/// The distribution of each response over all poses and rows.
void add_distribution(const StoredResult& result, Page& page, Section& section) {
  constexpr std::size_t kLevels = 101;
  const EvaluationResult& found = evaluation_of(result).evaluation;
  std::vector<double> levels;
  for (std::size_t n = 0; n < kLevels; ++n) levels.push_back(static_cast<double>(n) / (kLevels - 1.0));
  ArrayPool& pool = page.figures.pool;
  Lines lines{.x = {"share of the samples below", "%", pool.add("axis_levels", levels, 0.01)}, .panels = {}};
  for (const std::size_t r : headline_order(result)) {
    const NamedUnit& response = result.responses[r];
    const std::vector<double> values = order_statistics(found, r, 0, found.poses * found.samples, levels);
    const ArrayName array = pool.add(fmt::format("distribution/{}", r), values, display(response).si);
    lines.panels.push_back({response.name, unit_text(response), {{"all poses and rows", array}}});
  }
  add_figure(page, section, "distribution", std::move(lines), "The distribution of each response by its quantiles.");
}

void add_rows(const StoredResult& result, const PoseFigures& figures, Page& page, Section& section) {
  Lines lines{.x = figures.axis(), .panels = {}};
  std::vector<Field> fields;
  for (const std::size_t r : figures.responses()) {
    const NamedUnit& response = result.responses[r];
    const std::string unit = unit_text(response);
    const PoseQuantiles found = quantiles_at_poses(evaluation_of(result).evaluation, r);
    const auto add = [&](std::string_view what, const std::vector<double>& values) {
      return figures.add(fmt::format("{}/{}", what, r), values, response);
    };
    const ArrayName median = add("median", found.median);
    const ArrayName max = add("max", found.max);
    Panel panel{response.name, unit, {{"median", median, add("low", found.low), add("high", found.high)}}};
    panel.series.push_back({.label = "largest", .value = max, .style = "dotted"});
    lines.panels.push_back(std::move(panel));
    fields.push_back({response.name + ", median", unit, median});
    fields.push_back({response.name + ", largest", unit, max});
  }
  add_figure(
      page, section, "rows", std::move(lines),
      "At each pose the median over the rows, in a band from the 5 % to the 95 % quantile, and the largest value.");
  figures.add_condition(fields);
  figures.add_workspace(section, std::move(fields), "Each dot is a pose, coloured by what is chosen.");
}

std::string rows_text(const StoredResult& result) {
  const std::string poses = counted(result.poses.size(), "pose", "poses");
  if (evaluation_of(result).pairing == Pairing::row_by_row)
    return fmt::format("{}, each with a row of errors of its own.", poses);
  return fmt::format("{} of errors, each at {}.", counted(evaluation_of(result).evaluation.samples, "row", "rows"),
                     poses);
}

void add_page(const StoredResult& result, std::span<const Table> tables, Page& page) {
  const bool cases = !evaluation_of(result).cases.empty();
  add_limits(tables, page);
  Section& section = page.add_section("responses", cases ? "What each case does" : "What the errors do");
  section.paragraph(cases ? "Each case is a fixed set of errors. Poses where it was not solved are left out."
                          : rows_text(result) + " Samples that were not solved are left out.");
  if (!cases) add_distribution(result, page, section);
  for (const std::string_view name : {"evaluation", "cases", "parts"}) section.table(tables, name);
  const PoseFigures figures(result, cells(result), page);
  Section& where = page.add_section("where", result.time.empty() ? "Where in the workspace" : "Along the trajectory");
  figures.add_note(where);
  if (cases) {
    add_cases(result, figures, page, where);
  } else {
    add_rows(result, figures, page, where);
  }
}

/// Samples that are no cases are one row together.
SolveTally tally(const StoredResult& result) {
  const std::vector<std::string>& cases = evaluation_of(result).cases;
  const EvaluationResult& found = evaluation_of(result).evaluation;
  SolveTally outcomes{"case", cases, found.poses, {}};
  if (cases.empty()) outcomes.names = {"all rows"};
  outcomes.cells.resize(outcomes.names.size() * found.poses);
  for (std::size_t m = 0; m < found.poses; ++m) {
    for (std::size_t s = 0; s < found.samples; ++s) {
      const std::size_t row = cases.empty() ? 0 : s;
      const std::size_t at = m * found.samples + s;
      outcomes.cells[row * found.poses + m].add(found.status[at], found.iterations[at]);
    }
  }
  return outcomes;
}

StudyWords words(const StoredResult& result) {
  const StoredEvaluation& stored = evaluation_of(result);
  if (stored.cases.empty()) {
    return {.from_tables = true, .samples = counted(stored.evaluation.samples, "row of errors", "rows of errors")};
  }
  return {.samples = counted(stored.cases.size(), "case", "cases")};
}

Comparable comparable(const StoredResult& result, const StoredResult&) {
  const StoredEvaluation& stored = evaluation_of(result);
  if (stored.cases.empty()) {
    constexpr double kLevels[] = {0.0, 0.05, 0.25, 0.5, 0.75, 0.95, 1.0};
    const EvaluationResult& found = stored.evaluation;
    Comparable all = comparable_by_response(
        result, "number",
        {"smallest", "5 % quantile", "25 % quantile", "median", "75 % quantile", "95 % quantile", "largest"});
    std::vector<std::vector<double>> statistics;
    for (std::size_t r = 0; r < result.responses.size(); ++r) {
      statistics.push_back(order_statistics(found, r, 0, found.poses * found.samples, kLevels));
    }
    add_quantity(all, result, "over all poses and rows", "rows",
                 [&](std::size_t r, std::size_t n) { return statistics[r][n]; });
    return all;
  }
  const std::size_t cases = stored.cases.size();
  Comparable all = comparable_by_response(result, "case", stored.cases);
  add_quantity(all, result, "mean over the poses", "case_mean",
               [&](std::size_t r, std::size_t c) { return stored.mean[r * cases + c]; });
  add_quantity(all, result, "largest over the poses", "case_max",
               [&](std::size_t r, std::size_t c) { return stored.max[r * cases + c]; });
  return all;
}

}  // namespace

constinit const ReportKind kEvaluationReport{.tally = tally,
                                             .tables = evaluation_tables,
                                             .words = words,
                                             .shown_cells = cells,
                                             .page = add_page,
                                             .comparable = comparable};

}  // namespace poesy
