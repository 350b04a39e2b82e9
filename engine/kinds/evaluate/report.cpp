#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "engine/base/nan.h"
#include "engine/kinds/evaluate/cases.h"
#include "engine/kinds/evaluate/kind.h"
#include "engine/report/display.h"
#include "engine/report/far_limits.h"
#include "engine/report/tables.h"
#include "engine/run/evaluation.h"

namespace poesy::evaluate {
namespace {

/// The number of significant digits in tables. It is larger than for estimates, because these numbers have no sampling
/// uncertainty.
constexpr int kDigits = 6;

/// The mean and the extremes of a response over the solved samples; NaN if no sample is solved.
struct Summary {
  double mean = kNaN;
  double smallest = mean;
  double largest = mean;
};

Summary summary(const EvaluationResult& found, std::size_t r) {
  double sum = 0.0;
  double smallest = std::numeric_limits<double>::infinity();
  double largest = -smallest;
  std::size_t count = 0;
  const std::span<const double> values = found.response.row(r);
  for (std::size_t n = 0; n < values.size(); ++n) {
    if (!solved(found.status.all()[n])) continue;
    const double value = values[n];
    sum += value;
    smallest = std::min(smallest, value);
    largest = std::max(largest, value);
    ++count;
  }
  return count == 0 ? Summary() : Summary{sum / static_cast<double>(count), smallest, largest};
}

/// "; 38 of 40 pass" if the study limits the response; otherwise empty.
std::string passes(const StoredResult& result, std::size_t r) {
  const LimitVerdict* verdict = verdict_on(result, r);
  return verdict == nullptr ? "" : fmt::format("; {} of {} pass", verdict->within, verdict->tried);
}

/// A note like "part 17 is worst in linear_deformation: 0.123 mm at pose 4; 38 of 40 pass". Empty if the rows of errors
/// have no labels, if no row was solved, or if the response is zero except for rounding.
std::string worst_note(const StoredResult& result, std::size_t r) {
  const RowLabels& labels = evaluation_of(result).labels;
  if (labels.names.empty()) return {};
  const std::vector<RowOutcome> outcomes = row_outcomes(evaluation_of(result), r);
  const std::size_t worst = worst_row(outcomes);
  constexpr double kRounding = 1e-12;  // SI
  if (worst == outcomes.size() || std::abs(outcomes[worst].extreme) <= kRounding) return {};
  const NamedUnit& response = result.responses[r];
  return fmt::format("{} {} is worst in {}: {} at {}{}", labels.column, labels.names[worst], response.name,
                     response_text(response, outcomes[worst].extreme), place_text(result, outcomes[worst].pose),
                     passes(result, r));
}

/// Adds the column that says which rows of errors are within all limits, if the study states limits.
void add_kept(const Evaluation& found, std::vector<FilledColumn>& columns) {
  if (found.within_limits.empty()) return;
  columns.push_back({text_column("kept", "limits kept"),
                     [&found](std::size_t row) { return text_cell(found.within_limits[row] == 1 ? "PASS" : "FAIL"); }});
}

/// A note that names the rows of errors beyond some limit, "fail: SN001, SN007". Rows without labels are named by their
/// lines in the table. Empty if there are no such rows, and for named cases.
std::string fail_note(const Evaluation& found) {
  constexpr std::size_t kMostNamed = 40;
  if (!found.cases.empty()) return {};
  const bool is_named = !found.labels.names.empty();
  std::vector<std::string> failed;
  for (std::size_t row = 0; row < found.within_limits.size(); ++row) {
    if (found.within_limits[row] == 1) continue;
    failed.push_back(is_named ? found.labels.names[row] : std::to_string(line_of_row(row)));
  }
  if (failed.empty()) return {};
  const std::size_t named = std::min(failed.size(), kMostNamed);
  std::string list = fmt::format("fail: {}{}",
                                 is_named             ? ""
                                 : failed.size() == 1 ? "line "
                                                      : "lines ",
                                 fmt::join(std::span(failed).first(named), ", "));
  if (named < failed.size()) list += fmt::format(" and {} more", failed.size() - named);
  return is_named ? list : list + " of the table of errors; a column 'part' whose cells all differ names its rows";
}

Table parts_table(const StoredResult& result) {
  const RowLabels& labels = evaluation_of(result).labels;
  Table table{.name = "parts",
              .caption = "Each " + labels.column + " over its poses: mean, and the value of the largest magnitude",
              .columns = {},
              .notes = {"poses: those that were solved"}};
  // For each response that a summary shows (the headline), the outcome of each row of errors.
  std::vector<std::vector<RowOutcome>> outcomes;
  for (const std::size_t r : result.headline) outcomes.push_back(row_outcomes(evaluation_of(result), r));
  std::vector<FilledColumn> columns{
      {text_column("label", labels.column), [&](std::size_t row) { return text_cell(labels.names[row]); }},
      {number_column("poses", "poses"),
       [&](std::size_t row) { return count_cell(outcomes.empty() ? 0 : outcomes.front()[row].solved); }}};
  add_kept(evaluation_of(result), columns);
  for (std::size_t h = 0; h < outcomes.size(); ++h) {
    const NamedUnit& response = result.responses[result.headline[h]];
    const std::vector<RowOutcome>& of = outcomes[h];
    const std::string_view unit = display(response).name;
    // A narrow table first omits the columns with the largest `dispensable`, which are those of the last response.
    const int dispensable = 3 * static_cast<int>(h);
    columns.push_back({number_column(response.name + "_mean", response.name + " mean", unit, dispensable + 2),
                       [&](std::size_t row) { return value_cell(of[row].mean, response, kDigits); }});
    columns.push_back({number_column(response.name + "_extreme", response.name + " extreme", unit, dispensable),
                       [&](std::size_t row) { return value_cell(of[row].extreme, response, kDigits); }});
    columns.push_back(
        {number_column(response.name + "_extreme_pose", "at pose", "", dispensable + 1),
         [&](std::size_t row) { return of[row].solved == 0 ? text_cell("") : count_cell(of[row].pose); }});
  }
  fill(table, positions(labels.names.size()), columns);
  return table;
}

Table cases_table(const StoredResult& result) {
  const Evaluation& found = evaluation_of(result);
  Table table{.name = "cases",
              .caption = "Each case over its poses: mean, and the value of the largest magnitude",
              .columns = {},
              .notes = {"poses: those whose solve counts"}};
  std::vector<FilledColumn> columns{
      {text_column("case", "case"), [&](std::size_t c) { return text_cell(found.cases[c]); }},
      {number_column("poses", "poses"), [&](std::size_t c) { return count_cell(found.count.all()[c]); }}};
  add_kept(found, columns);
  // A narrow table first omits the columns with the largest `dispensable`, which are those of the last response.
  // Columns with 0 are never omitted.
  int dispensable = 0;
  for (const std::size_t r : result.headline) {
    const NamedUnit& response = result.responses[r];
    const std::string_view unit = display(response).name;
    columns.push_back({number_column(response.name + "_mean", response.name + " mean", unit, dispensable),
                       [&, r](std::size_t c) { return value_cell(found.mean(r, c), response, kDigits); }});
    columns.push_back({number_column(response.name + "_extreme", response.name + " extreme", unit,
                                     dispensable == 0 ? 0 : dispensable + 1),
                       [&, r](std::size_t c) { return value_cell(found.extreme(r, c), response, kDigits); }});
    dispensable += 2;
  }
  fill(table, positions(found.cases.size()), columns);
  return table;
}

ShownCells cells(const StoredResult& result) {
  const std::size_t cases = evaluation_of(result).cases.size();
  return shown_cells(result, cases == 0 ? kSummaryRows : cases);
}

/// [poses] One response to one row of errors, SI; NaN at poses where the row was not solved.
std::vector<double> response_to(const EvaluationResult& found, std::size_t r, std::size_t sample) {
  std::vector<double> values;
  for (std::size_t m = 0; m < found.poses(); ++m) {
    values.push_back(solved(found.status(m, sample)) ? found.response(r, m, sample) : kNaN);
  }
  return values;
}

/// Adds two figures to the page: a curve over the poses for each case, and a map of the same values over the workspace.
void add_cases(const StoredResult& result, const PoseFigures& figures, Page& page, Section& section) {
  const std::vector<std::string>& cases = evaluation_of(result).cases;
  Lines lines{.x = figures.axis(), .panels = {}};
  std::vector<Field> fields;
  for (const std::size_t r : figures.responses()) {
    const NamedUnit& response = result.responses[r];
    Panel panel{response.name, unit_text(response), {}};
    for (std::size_t c = 0; c < cases.size(); ++c) {
      const ArrayName array =
          figures.add(fmt::format("case/{}/{}", c, r), response_to(evaluation_of(result).solves, r, c), response);
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

/// The quantiles, at these levels, of the solved values in `all`; NaN if none was solved. status: how each solve ended,
/// in the order of `all`.
std::vector<double> order_statistics(std::span<const double> all, std::span<const SolveStatus> status,
                                     std::span<const double> levels) {
  std::vector<double> values;
  for (std::size_t n = 0; n < all.size(); ++n) {
    if (solved(status[n])) values.push_back(all[n]);
  }
  std::ranges::sort(values);
  std::vector<double> list;
  for (const double level : levels) {
    const double at = std::round(level * (static_cast<double>(values.size()) - 1.0));
    list.push_back(values.empty() ? kNaN : values[static_cast<std::size_t>(at)]);
  }
  return list;
}

/// [4][poses] The 5 % quantile, the median, the 95 % quantile and the largest value over the rows of errors at each
/// pose.
std::array<std::vector<double>, 4> quantiles_at_poses(const EvaluationResult& found, std::size_t r) {
  constexpr std::array kLevels{0.05, 0.5, 0.95, 1.0};
  std::array<std::vector<double>, 4> quantiles;
  for (std::size_t m = 0; m < found.poses(); ++m) {
    const std::vector<double> values = order_statistics(found.response.row(r, m), found.status.row(m), kLevels);
    for (std::size_t q = 0; q < values.size(); ++q) quantiles[q].push_back(values[q]);
  }
  return quantiles;
}

/// Adds to the page the distribution of each response over all poses and rows of errors.
void add_distribution(const StoredResult& result, Page& page, Section& section) {
  constexpr std::size_t kLevels = 101;
  const EvaluationResult& found = evaluation_of(result).solves;
  std::vector<double> levels;
  for (std::size_t n = 0; n < kLevels; ++n) levels.push_back(static_cast<double>(n) / (kLevels - 1.0));
  ArrayPool& pool = page.figures.pool;
  const ArrayName shares = pool.add("axis_levels", levels, 0.01);
  for (const std::size_t r : headline_order(result)) {
    const NamedUnit& response = result.responses[r];
    const std::vector<double> values = order_statistics(found.response.row(r), found.status.all(), levels);
    const ArrayName array = pool.add(fmt::format("distribution/{}", r), values, display(response).si);
    add_figure(page, section, fmt::format("distribution-{}", r),
               Lines{.x = {response.name, unit_text(response), array},
                     .panels = {{"share of the samples below", "%", {{"all poses and rows", shares}}}},
                     .marks = limit_marks(result, r, values.front() < 0.0)},
               fmt::format("{}: the share of all poses and rows below a value.", response.name));
  }
}

void add_rows(const StoredResult& result, const PoseFigures& figures, Page& page, Section& section) {
  Lines lines{.x = figures.axis(), .panels = {}};
  std::vector<Field> fields;
  for (const std::size_t r : figures.responses()) {
    const NamedUnit& response = result.responses[r];
    const std::string unit = unit_text(response);
    const auto [low, middle, high, largest] = quantiles_at_poses(evaluation_of(result).solves, r);
    const auto add = [&](std::string_view what, const std::vector<double>& values) {
      return figures.add(fmt::format("{}/{}", what, r), values, response);
    };
    const ArrayName median = add("median", middle);
    const ArrayName max = add("max", largest);
    Panel panel{response.name, unit, {{"median", median, add("low", low), add("high", high)}}};
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
  return fmt::format("{} of errors, each at {}.", counted(evaluation_of(result).solves.samples(), "row", "rows"),
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

/// Counts how solves ended: for each case, or for all rows of a table of errors together.
SolveTally tally(const StoredResult& result) {
  const std::vector<std::string>& cases = evaluation_of(result).cases;
  const EvaluationResult& found = evaluation_of(result).solves;
  const std::vector<std::string> names = cases.empty() ? std::vector<std::string>{"all rows"} : cases;
  Array<SolveCounts, axis::Row, axis::Pose> cells({names.size(), found.poses()});
  for (std::size_t m = 0; m < found.poses(); ++m) {
    for (std::size_t s = 0; s < found.samples(); ++s) {
      cells(cases.empty() ? 0 : s, m).add(found.status(m, s), found.iterations(m, s));
    }
  }
  return {"case", names, found.poses(), {cells.begin(), cells.end()}};
}

StudyWords words(const StoredResult& result) {
  const Evaluation& found = evaluation_of(result);
  if (found.cases.empty()) {
    return {.from_tables = true,
            .own_poses = false,
            .samples = counted(found.solves.samples(), "row of errors", "rows of errors")};
  }
  return {.samples = counted(found.cases.size(), "case", "cases")};
}

/// A text on the uncertainty of the outcomes. The only uncertainty comes from errors without a column: they are zero
/// here, but not in real machines.
std::string certainty_text(const Evaluation& found) {
  if (found.zero_errors.empty()) return "These errors were given, not drawn, so nothing here is up to chance.";
  return fmt::format(
      "The errors in the table were given, not drawn. But {}, so real machines deviate more. A Monte Carlo study with "
      "errors.machines draws them.",
      no_column_text(found));
}

/// The description of the method, for a paper: how many errors are zero because the table has no column for them.
MethodWords method(const StoredResult& result) {
  const Evaluation& found = evaluation_of(result);
  if (found.zero_errors.empty()) return {};
  return {counted(found.zero_errors.size(), "other error was", "other errors were") + " zero."};
}

/// The summary at the top of the report, for the response by which errors are ranked.
Answer answer(const StoredResult& result) {
  const Evaluation& found = evaluation_of(result);
  const std::size_t r = response_named(result, default_ranking(result));
  const NamedUnit& response = result.responses[r];
  const std::size_t cases = found.cases.size();
  const Summary all = summary(found.solves, r);
  Answer lines;
  if (std::string limits = limits_text(result); !limits.empty()) lines.emplace_back("Limits", std::move(limits));
  if (cases > 0) {
    const auto extreme = found.extreme.row(r);
    const auto worst = static_cast<std::size_t>(
        std::ranges::max_element(extreme, {}, [](double value) { return std::isnan(value) ? -1.0 : std::abs(value); }) -
        extreme.begin());
    lines.emplace_back(
        "Answer", fmt::format("Of {}, {} does most: {} of up to {}, on average {}.", counted(cases, "case", "cases"),
                              found.cases[worst], response.name, response_text(response, extreme[worst]),
                              response_text(response, found.mean(r, worst))));
  } else {
    lines.emplace_back("Answer", fmt::format("{} is {} on average, between {} and {}.", response.name,
                                             response_text(response, all.mean), response_text(response, all.smallest),
                                             response_text(response, all.largest)));
  }
  if (std::string worst = worst_note(result, r); !worst.empty()) lines.emplace_back("Worst", worst + ".");
  lines.emplace_back("How sure", certainty_text(found));
  const bool limited = result.verdicts.has_value();
  lines.emplace_back(kWhatToDo, !limited ? "State limits under [analysis.limits], and the report judges them."
                                : result.verdicts->passed()
                                    ? "Nothing for these errors; others need a study of their own."
                                    : "Begin with the rows and poses that are named below as the worst.");
  return lines;
}

/// The figure of merit by which two results are compared: the largest magnitude of the response. Its interval has no
/// width, because the errors are not drawn.
std::vector<Merit> merits(const StoredResult& result, std::string_view name) {
  if (name.empty()) return {};
  const std::size_t r = response_named(result, name);
  const Summary all = summary(evaluation_of(result).solves, r);
  const double largest = std::max(std::abs(all.smallest), std::abs(all.largest)) / display(result.responses[r]).si;
  return {{.what = fmt::format("largest magnitude of {}", name),
           .unit = unit_text(result.responses[r]),
           .value = largest,
           .low = largest,
           .high = largest}};
}

Comparable comparable(const StoredResult& result, const StoredResult&) {
  const Evaluation& found = evaluation_of(result);
  if (found.cases.empty()) {
    constexpr double kLevels[] = {0.0, 0.05, 0.25, 0.5, 0.75, 0.95, 1.0};
    Comparable all = comparable_by_response(
        result, "number",
        {"smallest", "5 % quantile", "25 % quantile", "median", "75 % quantile", "95 % quantile", "largest"});
    std::vector<std::vector<double>> statistics;
    for (std::size_t r = 0; r < result.responses.size(); ++r) {
      statistics.push_back(order_statistics(found.solves.response.row(r), found.solves.status.all(), kLevels));
    }
    add_quantity(all, result, "over all poses and rows", "rows",
                 [&](std::size_t r, std::size_t n) { return statistics[r][n]; });
    return all;
  }
  Comparable all = comparable_by_response(result, "case", found.cases);
  add_quantity(all, result, "mean over the poses", "case_mean",
               [&](std::size_t r, std::size_t c) { return found.mean(r, c); });
  add_quantity(all, result, "largest magnitude over the poses, with its sign", "case_extreme",
               [&](std::size_t r, std::size_t c) { return found.extreme(r, c); });
  return all;
}

std::vector<Table> evaluation_tables(const StoredResult& result, const TableOptions&) {
  const Evaluation& found = evaluation_of(result);
  std::vector<Table> tables{found.cases.empty() ? evaluation_table(result) : cases_table(result)};
  if (!found.labels.names.empty()) tables.push_back(parts_table(result));
  return tables;
}

std::vector<std::string> notes_on_far_limits(const StoredResult& result) {
  const auto judged = [&](std::size_t k) { return std::abs(result.verdicts->limits[k].value); };
  return far_limit_notes(result, judged, "judged value");
}

}  // namespace

Table evaluation_table(const StoredResult& result) {
  std::vector<Summary> found;
  for (std::size_t r = 0; r < result.responses.size(); ++r) found.push_back(summary(evaluation_of(result).solves, r));
  const auto number = [&](const std::string& name, double Summary::*member) {
    return FilledColumn{number_column(name, name), [&, member](std::size_t r) {
                          return value_cell(found[r].*member, result.responses[r], kDigits);
                        }};
  };
  Table table{.name = "evaluation", .caption = "Responses over all samples that were solved", .columns = {}};
  fill(table, result.headline,
       {name_column(result.responses, "response"), unit_column(result.responses), number("mean", &Summary::mean),
        number("smallest", &Summary::smallest), number("largest", &Summary::largest)});
  for (const std::size_t r : result.headline) {
    if (std::string note = worst_note(result, r); !note.empty()) table.notes.push_back(std::move(note));
  }
  if (std::string note = fail_note(evaluation_of(result)); !note.empty()) table.notes.push_back(std::move(note));
  if (std::string zero = zero_errors_text(evaluation_of(result)); !zero.empty()) table.notes.push_back(std::move(zero));
  return table;
}

constinit const ReportKind kReport{.tally = tally,
                                   .tables = evaluation_tables,
                                   .merits = merits,
                                   .words = words,
                                   .method = method,
                                   .far_limits = notes_on_far_limits,
                                   .answer = answer,
                                   .shown_cells = cells,
                                   .page = add_page,
                                   .comparable = comparable};

}  // namespace poesy::evaluate
