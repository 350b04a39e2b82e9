#include <fmt/format.h>

#include <algorithm>
#include <functional>
#include <map>
#include <tuple>
#include <type_traits>
#include <utility>

#include "engine/kinds/evaluate/cases.h"
#include "engine/kinds/evaluate/kind.h"
#include "engine/result/result_parts.h"
#include "engine/run/evaluation.h"
#include "engine/study/table_file.h"

namespace poesy::evaluate {
namespace {

constexpr const char* kLabels = "/evaluate/label";
constexpr const char* kZeroErrors = "zero_error";
constexpr const char* kWithinLimits = "/evaluate/within_limits";

/// The words in a result file for how poses and rows of errors are paired (Pairing).
/// @{
constexpr const char* kRowByRow = "row-by-row";
constexpr const char* kEveryPoseWithEveryRow = "every-pose-with-every-row";
/// @}

const Fields<EvaluationResult> kJointFields{{"joint_displacements", &EvaluationResult::joint_displacement,
                                             "rad or m, by joint", "Joint displacements of the perfect mechanism"}};

const Fields<Evaluation> kCaseFields{
    {"mean", &Evaluation::mean, kResponseUnit, "Mean over the poses that count; NaN where there is none"},
    {"extreme", &Evaluation::extreme, kResponseUnit, "Value of the largest magnitude over the poses that count",
     Presence::where_computed},
    {"count", &Evaluation::count, "1", "Poses that count: solved, or as not_converged has it"}};

/// The order of solves in a file: pose by pose for a table of errors, case by case for named cases.
/// @{
using TableLayout = AxisLayout<axis::Pose, axis::Sample>;
using CaseLayout = AxisLayout<axis::Case, axis::Pose>;
/// @}

/// The pose and the sample of a solve, from its positions on the two axes of a layout.
template <class Layout>
std::pair<std::size_t, std::size_t> solve_at(std::size_t first, std::size_t second) {
  if constexpr (std::is_same_v<Layout, CaseLayout>) return {second, first};
  return {first, second};
}

/// Adds to the result file a dataset with the number value(pose, sample) for each solve.
template <h5::Number T, class Layout, class Value>
void add_values(ResultBuilder& result, const std::string& name, const Layout& layout, const Value& value,
                const Label& label) {
  result.add_computed<T>(
      "/evaluate/" + name, layout,
      [&](std::size_t first, std::size_t second) { return std::apply(value, solve_at<Layout>(first, second)); }, label);
}

/// Reads a dataset with one value for each solve, and calls set(pose, sample, value) with each.
template <h5::Number T, class... A, class Set>
void read_values(const h5::File& file, const std::string& name, const AxisLayout<A...>& layout, const Set& set) {
  const auto values = read_array<Array<T, A...>>(file, "/evaluate/" + name);
  for (std::size_t place = 0; place < layout.elements(); ++place) {
    const auto [first, second] = layout.positions(place);
    const auto [m, s] = solve_at<AxisLayout<A...>>(first, second);
    set(m, s, values(first, second));
  }
}

template <class... A>
void add_details(ResultBuilder& result, const Evaluation& found, const AxisLayout<A...>& layout) {
  if (found.solves.detail.empty()) return;
  const auto names = texts(found.details, &Detail::name);
  result.file().set_attribute("/evaluate", "details", std::span(names));
  // The axis of each list of component names. Additional outputs with equal lists share an axis.
  std::map<std::vector<std::string>, std::string> axis_of;
  std::size_t first = 0;
  for (const Detail& detail : found.details) {
    const std::size_t width = detail.components.size();
    const std::string next = "component" + (axis_of.empty() ? "" : "_" + std::to_string(axis_of.size() + 1));
    const auto [axis, is_new] = axis_of.try_emplace(detail.components, next);
    if (is_new) {
      result.add_axis(axis->second, detail.components, {"1", "Component of " + detail.name + " and its like"});
      result.show_axes("/evaluate", {axis->second});
    }
    const auto [rows, columns] = layout.lengths();
    const AxisLayout<A..., axis::Component> of_detail({rows, columns, width});
    const auto value = [&](std::size_t place) {
      const auto at = of_detail.positions(place);
      const auto [m, s] = solve_at<AxisLayout<A...>>(at[0], at[1]);
      return found.solves.detail(m, s, first + at[2]);
    };
    Axes axes = layout.axis_names();
    axes.push_back(axis->second);
    const std::string path = "/evaluate/" + detail.name;
    result.add_computed<double>(path, axes, value, {detail.unit, detail.description});
    result.file().set_attribute(path, "components", std::span(detail.components));
    first += width;
  }
}

std::vector<Detail> read_details(const h5::File& file) {
  std::vector<Detail> details;
  if (!file.has_attribute("/evaluate", "details")) return details;
  for (const std::string& name : file.attribute<std::string>("/evaluate", "details")) {
    const std::string path = "/evaluate/" + name;
    details.push_back({.name = name,
                       .components = file.attribute<std::string>(path, "components"),
                       .unit = file.attribute<std::string>(path, "unit").at(0),
                       .description = file.attribute<std::string>(path, "description").at(0)});
  }
  return details;
}

template <class... A>
void read_detail_values(const h5::File& file, const AxisLayout<A...>& layout, Evaluation& found) {
  const auto [rows, columns] = layout.lengths();
  std::size_t first = 0;
  for (const Detail& detail : found.details) {
    const std::size_t width = detail.components.size();
    const auto read = read_shaped<double>(file, "/evaluate/" + detail.name, {rows, columns, width});
    const Array<double, A..., axis::Component> values({rows, columns, width}, read);
    for (std::size_t place = 0; place < values.size(); ++place) {
      const auto at = values.positions(place);
      const auto [m, s] = solve_at<AxisLayout<A...>>(at[0], at[1]);
      found.solves.detail(m, s, first + at[2]) = values(at[0], at[1], at[2]);
    }
    first += width;
  }
}

/// Reads what add_solves() wrote. layout: the order of solves in the file.
template <class Layout>
void read_solves(const h5::File& file, const std::vector<NamedUnit>& responses, const Layout& layout,
                 Evaluation& found) {
  EvaluationResult& solves = found.solves;
  const auto [rows, columns] = layout.lengths();
  const auto [poses, samples] = solve_at<Layout>(rows, columns);
  std::size_t components = 0;
  for (const Detail& detail : found.details) components += detail.components.size();
  make_room({responses.size(), poses, samples}, solves.response);
  make_room({poses, samples, components}, solves.detail);
  make_room({poses, samples}, solves.status, solves.iterations);
  for (std::size_t r = 0; r < responses.size(); ++r) {
    read_values<double>(file, responses[r].name, layout,
                        [&](std::size_t m, std::size_t s, double value) { solves.response(r, m, s) = value; });
  }
  read_values<std::uint8_t>(file, "status", layout, [&](std::size_t m, std::size_t s, std::uint8_t code) {
    if (code >= kStatusNames.size()) throw h5::Error("/evaluate/status holds an unknown status");
    solves.status(m, s) = static_cast<SolveStatus>(code);
  });
  read_values<std::uint32_t>(file, "iterations", layout, [&](std::size_t m, std::size_t s, std::uint32_t count) {
    solves.iterations(m, s) = count;
  });
  read_detail_values(file, layout, found);
  read_fields(file, "/evaluate", kJointFields, solves);
}

/// Writes the group /evaluate of the file: responses, additional outputs, status and iterations of each solve, and the
/// nominal displacements of the joints. layout: the order of solves in the file.
template <class Layout>
void add_solves(ResultBuilder& result, const ModelDescription& model, const Evaluation& found, const Layout& layout) {
  const EvaluationResult& solves = found.solves;
  result.add_axis("joint", found.joints, {"1", "Name of the joint displacement"});
  result.file().make_group("/evaluate");
  result.show_axes("/evaluate", layout.axis_names());
  result.show_axes("/evaluate", {"joint"});
  for (std::size_t r = 0; r < model.responses.size(); ++r) {
    const Response& response = model.responses[r];
    add_values<double>(result, response.name, layout,
                       [&](std::size_t m, std::size_t s) { return solves.response(r, m, s); },
                       {unit_of(response), response.description});
  }
  add_details(result, found, layout);
  const auto status_names = listed_statuses(solves.total());
  add_values<std::uint8_t>(result, "status", layout, [&](std::size_t m, std::size_t s) { return solves.status(m, s); },
                           {"1", "How the solve ended: a position in status_names, from 0"});
  result.file().set_attribute("/evaluate/status", "status_names", std::span(status_names));
  add_values<std::uint32_t>(result, "iterations", layout,
                            [&](std::size_t m, std::size_t s) { return solves.iterations(m, s); },
                            {"1", "Iterations of the solve"});
  write_fields(result, "/evaluate", kJointFields, solves);
}

/// Writes the group /errors of the file: the rows of errors, their pairing with poses, and their labels. rows: name of
/// the axis of rows.
void add_errors(ResultBuilder& result, const Evaluation& found, const std::string& rows) {
  const bool row_by_row = found.pairing == Pairing::row_by_row;
  result.file().make_group("/errors");
  result.file().set_attribute("/errors", "pairing", std::string(row_by_row ? kRowByRow : kEveryPoseWithEveryRow));
  result.show_axes("/errors", {rows, "factor"});
  result.add("/errors/values", {rows, "factor"}, found.errors.all(),
             {kFactorUnit, "The errors that were given; all others are zero"});
  if (!found.zero_errors.empty()) {
    result.add_axis(kZeroErrors, found.zero_errors, {"1", "Errors that have no column in the table and are zero"});
    result.show_axes("/errors", {kZeroErrors});
  }
  if (found.labels.names.empty()) return;
  result.add(kLabels, {rows}, found.labels.names, {"1", "What the table of errors calls its rows"});
  result.file().set_attribute(kLabels, "column", found.labels.column);
}

/// Writes whether each row of errors is within all limits; writes nothing if the study states no limits. rows: name of
/// the axis of rows.
void add_within_limits(ResultBuilder& result, const Evaluation& found, const std::string& rows) {
  if (found.within_limits.empty()) return;
  result.add(kWithinLimits, {rows}, found.within_limits,
             {"1", "1: the row of errors is within all limits at all of its poses; 0: it is not"});
}

/// Throws h5::Error unless every verdict counts all rows of errors.
void check_rows(const std::vector<LimitVerdict>& limits, std::size_t rows) {
  const bool fits = std::ranges::all_of(limits, [rows](const LimitVerdict& one) { return one.tried == rows; });
  if (!fits) throw h5::Error("/limits/tried is not the number of rows of errors");
}

/// Reads the labels of the rows of errors; empty if the file has none. rows: name of the axis of rows.
RowLabels read_labels(const h5::File& file, const std::string& rows) {
  RowLabels labels;
  if (!file.exists(kLabels)) return labels;
  labels.column = file.attribute<std::string>(kLabels, "column").at(0);
  labels.names = read_along<std::string>(file, kLabels, {rows});
  const bool wrong =
      std::ranges::any_of(labels.names, [](const std::string& name) { return label_problem(name).has_value(); });
  if (wrong || label_problem(labels.column)) throw h5::Error(std::string(kLabels) + " holds what is not a label");
  return labels;
}

/// Splits "rad,rad,m" into a unit for each of `count` components. A single unit applies to all.
std::vector<std::string> component_units(const std::string& text, std::size_t count) {
  std::vector<std::string> list;
  for (std::size_t begin = 0; begin <= text.size();) {
    const std::size_t comma = std::min(text.find(',', begin), text.size());
    list.push_back(text.substr(begin, comma - begin));
    begin = comma + 1;
  }
  if (list.size() != count) list.assign(count, list.size() == 1 ? list.front() : text);
  return list;
}

/// Adds the first columns of a table: the label of the row of errors, if rows have labels, and a number with this
/// heading. row(line): position of the row of errors. number(line): the number.
template <class Row, class Number>
void set_first_cells(CsvTable& table, const RowLabels& labels, const std::string& heading, const Row& row,
                     const Number& number) {
  if (labels.names.empty()) {
    table.first = {heading, [number](std::size_t line) { return std::to_string(number(line)); }};
    return;
  }
  table.first = {labels.column, [&labels, row](std::size_t line) { return labels.names[row(line)]; }};
  table.columns.push_back({heading, [number](std::size_t line) { return to_number(number(line)); }});
}

/// Appends columns with the outcomes of solves to the table, one solve in each line. solve(line): pose and sample of a
/// line.
template <class Solve>
void append_solve_columns(CsvTable& table, const StoredResult& result, const Solve& solve) {
  const Evaluation& found = evaluation_of(result);
  const EvaluationResult& solves = found.solves;
  const auto append = [&](const std::string& heading, auto number) {
    table.columns.push_back(
        {heading, [solve, number](std::size_t line) { return to_number(std::apply(number, solve(line))); }});
  };
  if (!result.time.empty()) append("time [s]", [&](std::size_t m, std::size_t) { return result.time[m]; });
  for (std::size_t r = 0; r < solves.responses(); ++r) {
    const NamedUnit& response = result.responses[r];
    append(with_unit(response.name, response.unit),
           [&, r](std::size_t m, std::size_t s) { return solves.response(r, m, s); });
  }
  std::size_t d = 0;
  for (const Detail& detail : found.details) {
    const auto units = component_units(detail.unit, detail.components.size());
    for (std::size_t k = 0; k < units.size(); ++k, ++d) {
      append(with_unit(detail.name + "_" + detail.components[k], units[k]),
             [&solves, d](std::size_t m, std::size_t s) { return solves.detail(m, s, d); });
    }
  }
  append("status", [&](std::size_t m, std::size_t s) { return solves.status(m, s); });
  append("iterations", [&](std::size_t m, std::size_t s) { return solves.iterations(m, s); });
}

/// The table of all solves, pose by pose.
CsvTable solve_table(const StoredResult& result) {
  const Evaluation& found = evaluation_of(result);
  const auto solve = [layout = TableLayout(found.solves.status.lengths())](std::size_t line) {
    const auto [m, s] = layout.positions(line);
    return std::pair(m, s);
  };
  CsvTable table{"evaluate", {}, found.solves.status.size()};
  set_first_cells(
      table, found.labels, "pose",
      [&found, solve](std::size_t line) { return row_of_solve(found, solve(line).first, solve(line).second); },
      [solve](std::size_t line) { return solve(line).first; });
  table.columns.push_back({"sample", [solve](std::size_t line) { return to_number(solve(line).second); }});
  append_solve_columns(table, result, solve);
  return table;
}

/// The table of all solves, case by case.
CsvTable case_solve_table(const StoredResult& result) {
  const Evaluation& found = evaluation_of(result);
  const auto solve = [layout = CaseLayout({found.cases.size(), found.solves.poses()})](std::size_t line) {
    const auto [c, m] = layout.positions(line);
    return std::pair(m, c);
  };
  CsvTable table{"evaluate",
                 {"case", [&found, solve](std::size_t line) { return found.cases[solve(line).second]; }},
                 found.solves.status.size()};
  table.columns.push_back({"pose", [solve](std::size_t line) { return to_number(solve(line).first); }});
  append_solve_columns(table, result, solve);
  return table;
}

CsvTable joint_table(const StoredResult& result) {
  const Evaluation& found = evaluation_of(result);
  CsvTable table = lines_of_poses(result, "joint_displacements");
  table.lines = found.solves.joint_displacement.length<axis::Pose>();
  for (std::size_t j = 0; j < found.joints.size(); ++j) {
    table.columns.push_back({with_unit(found.joints[j], "rad or m"),
                             [&found, j](std::size_t m) { return found.solves.joint_displacement(m, j); }});
  }
  return table;
}

CsvTable error_table(const StoredResult& result) {
  const Evaluation& found = evaluation_of(result);
  CsvTable table{"errors", {}, found.errors.length<axis::Row>()};
  if (found.cases.empty()) {
    const bool row_by_row = found.pairing == Pairing::row_by_row;
    set_first_cells(table, found.labels, row_by_row ? "pose" : "sample", std::identity(), std::identity());
  } else {
    table.first = {"case", [&](std::size_t c) { return found.cases[c]; }};
  }
  for (std::size_t p = 0; p < result.factors.size(); ++p) {
    const NamedUnit& factor = result.factors[p];
    table.columns.push_back(
        {with_unit(factor.name, factor.unit), [&found, p](std::size_t row) { return found.errors(row, p); }});
  }
  return table;
}

/// Adds the column "kept" to a table with a line for each row of errors, if the study states limits.
void append_kept(CsvTable& table, const Evaluation& found) {
  if (found.within_limits.empty()) return;
  table.columns.push_back({"kept", [&found](std::size_t row) { return to_number(found.within_limits[row]); }});
}

/// The table "parts", with a line for each row of errors. Precondition: the rows have labels.
CsvTable part_table(const StoredResult& result) {
  const RowLabels& labels = evaluation_of(result).labels;
  CsvTable table{"parts", {labels.column, [&](std::size_t row) { return labels.names[row]; }}, labels.names.size()};
  const auto append = [&](const std::string& heading, const std::vector<RowOutcome>& outcomes, auto member) {
    table.columns.push_back(
        {heading, [outcomes, member](std::size_t row) { return to_number(outcomes[row].*member); }});
  };
  for (std::size_t r = 0; r < result.responses.size(); ++r) {
    const NamedUnit& response = result.responses[r];
    const std::vector<RowOutcome> outcomes = row_outcomes(evaluation_of(result), r);
    if (r == 0) append("poses", outcomes, &RowOutcome::solved);
    if (r == 0) append_kept(table, evaluation_of(result));
    append(with_unit(response.name + "_mean", response.unit), outcomes, &RowOutcome::mean);
    append(with_unit(response.name + "_extreme", response.unit), outcomes, &RowOutcome::extreme);
    append(response.name + "_extreme_pose", outcomes, &RowOutcome::pose);
  }
  return table;
}

CsvTable case_sum_table(const StoredResult& result) {
  const Evaluation& found = evaluation_of(result);
  CsvTable table{"cases", {"case", [&](std::size_t c) { return found.cases[c]; }}, found.cases.size()};
  table.columns.push_back(list_column("poses", found.count));
  append_kept(table, found);
  for (std::size_t r = 0; r < result.responses.size(); ++r) {
    const NamedUnit& response = result.responses[r];
    for (const FieldRow<Evaluation>& field : kCaseFields) {
      if (field.name == "count") continue;
      const std::string heading = with_unit(response.name + "_" + field.name, csv_unit(field.unit, result, &response));
      table.columns.push_back(field_row_column(heading, field, found, r));
    }
  }
  return table;
}

/// The result of `poesy evaluate`, and the errors that have a column in its table. Keeps references to both.
struct TableOfErrors {
  std::span<const FactorIndex> factors;
  const Evaluation& found;
};

void write_table(ResultBuilder& result, const Study& study, const TableOfErrors& table) {
  const Evaluation& found = table.found;
  add_names(result, study, table.factors);
  result.add_axis("sample", axis_numbers(found.solves.samples()), {"1", "Number of the sample at each pose, from 0"});
  add_solves(result, study.model(), found, TableLayout(found.solves.status.lengths()));
  const std::string rows = found.pairing == Pairing::row_by_row ? "pose" : "sample";
  add_errors(result, found, rows);
  add_within_limits(result, found, rows);
  add_limits(result, study.model(), found.solves.verdicts);
}

void write_cases(ResultBuilder& result, const Study& study, const Evaluation& found) {
  add_names(result, study, case_table(asked_of<CaseOptions>(study.analysis).cases).factors);
  result.add_axis("case", found.cases, {"1", "Name of the case"});
  add_solves(result, study.model(), found, CaseLayout({found.cases.size(), found.solves.poses()}));
  add_errors(result, found, "case");
  add_within_limits(result, found, "case");
  add_limits(result, study.model(), found.solves.verdicts);
  result.show_axes("/evaluate", {"response"});
  write_fields(result, "/evaluate", kCaseFields, found);
}

void write(ResultBuilder& result, const Study& study, std::any& any) {
  if (const auto* cases = std::any_cast<Evaluation>(&any)) return write_cases(result, study, *cases);
  write_table(result, study, std::any_cast<const TableOfErrors&>(any));
}

/// Reads mean, extreme and count of each case. Files of version 0.2 have no extremes (their `max` is the largest value
/// with its sign), so all three are computed from the solves, with the policy that reproduces the counts in the file.
void read_case_fields(const h5::File& file, Evaluation& found) {
  read_fields(file, "/evaluate", kCaseFields, found);
  if (!found.extreme.empty()) return;
  const auto count = found.count;
  summarize_cases(found, NotConverged::exclude);
  if (found.count != count) summarize_cases(found, NotConverged::include);
}

void read(const h5::File& file, StoredResult& result) {
  Evaluation found;
  found.details = read_details(file);
  found.joints = file.read<std::string>("/joint");
  const bool has_cases = file.exists("/case");
  if (has_cases) {
    found.cases = file.read<std::string>("/case");
    read_solves(file, result.responses, CaseLayout(lengths_in<CaseLayout>(file)), found);
    read_case_fields(file, found);
  } else {
    read_solves(file, result.responses, TableLayout(lengths_in<TableLayout>(file)), found);
  }
  const bool row_by_row = !has_cases && file.attribute<std::string>("/errors", "pairing").at(0) == kRowByRow;
  found.pairing = row_by_row ? Pairing::row_by_row : Pairing::every_pose_with_every_row;
  const std::string rows = row_by_row ? "pose" : has_cases ? "case" : "sample";
  result.verdicts = read_limits(file, result);
  if (result.verdicts) check_rows(result.verdicts->limits, axis_length(file, rows));
  found.errors = decltype(found.errors)({axis_length(file, rows), axis_length(file, "factor")},
                                        read_along<double>(file, "/errors/values", {rows, "factor"}));
  found.labels = read_labels(file, rows);
  // Files of version 0.2 do not list the errors without a column.
  const std::string zero_errors = std::string("/") + kZeroErrors;
  if (!has_cases && file.exists(zero_errors)) found.zero_errors = file.read<std::string>(zero_errors);
  check_names(found.zero_errors, zero_errors);
  // Files of version 0.2 do not state which rows are within all limits.
  if (result.verdicts && file.exists(kWithinLimits)) {
    found.within_limits = read_along<std::uint8_t>(file, kWithinLimits, {rows});
    if (std::ranges::any_of(found.within_limits, [](std::uint8_t within) { return within > 1; })) {
      throw h5::Error(std::string(kWithinLimits) + " has values other than 0 and 1");
    }
    result.verdicts->rows_within = static_cast<std::uint64_t>(std::ranges::count(found.within_limits, 1));
  }
  if (result.verdicts) {
    result.row_names = has_cases ? found.cases : row_names(found.labels, found.pairing, found.solves.samples());
  }
  result.found = std::move(found);
}

void append_tables(CsvTables& tables, const StoredResult& result) {
  append_limit_table(tables, result);
  const Evaluation& found = evaluation_of(result);
  const bool has_cases = !found.cases.empty();
  tables.push_back(has_cases ? case_solve_table(result) : solve_table(result));
  tables.push_back(joint_table(result));
  tables.push_back(error_table(result));
  if (has_cases) tables.push_back(case_sum_table(result));
  if (!has_cases && !found.labels.names.empty()) tables.push_back(part_table(result));
}

}  // namespace

constinit const FileKind kFile{.write = write, .read = read, .append_tables = append_tables};

GivenErrors evaluated_errors(const StoredResult& result) {
  const Evaluation& found = evaluation_of(result);
  if (!found.cases.empty()) return {.word = "case", .names = found.cases, .values = found.errors.all()};
  return {.word = "varied error",
          .names = {std::string(kAllFactors)},
          .samples = found.solves.samples(),
          .pairing = found.pairing,
          .values = found.errors.all()};
}

std::vector<std::string> row_names(const RowLabels& labels, Pairing pairing, std::size_t rows) {
  std::vector<std::string> names;
  for (const std::string& label : labels.names) names.push_back(labels.column + " " + label);
  if (!names.empty() || pairing == Pairing::row_by_row) return names;
  for (std::size_t row = 0; row < rows; ++row)
    names.push_back(fmt::format("line {} (sample {})", line_of_row(row), row));
  return names;
}

void write_evaluation(const std::string& path, const Study& study, const SelectedPoses& poses,
                      std::span<const FactorIndex> factors, const Evaluation& found, const RunFacts& facts) {
  write_result(path, kStudy.name, kFile, study, poses, TableOfErrors{factors, found}, facts);
}

}  // namespace poesy::evaluate
