#include <algorithm>
#include <functional>
#include <map>
#include <utility>

#include "engine/kinds/evaluate/cases.h"
#include "engine/kinds/evaluate/kind.h"
#include "engine/result/result_parts.h"
#include "engine/run/evaluation.h"
#include "engine/study/table_file.h"

namespace poesy {
namespace {

/// Rows and columns of the datasets of solves: a table's solves are kept by pose, those of cases by case.
const Axes kTableAxes{"pose", "sample"};
const Axes kCaseAxes{"case", "pose"};
constexpr const char* kLabels = "/evaluate/label";

/// How poses and rows of errors belong together, as files say it.
/// @{
constexpr const char* kRowByRow = "row-by-row";
constexpr const char* kEveryPoseWithEveryRow = "every-pose-with-every-row";
/// @}

/// What is stored of every solve in addition to responses and details. axes: rows and columns of the datasets of
/// solves.
Fields<EvaluationResult> solve_fields(const Axes& axes) {
  return {{"iterations", &EvaluationResult::iterations, axes, "1", "Iterations of the solve"},
          {"joint_displacements",
           &EvaluationResult::joint_displacement,
           {"pose", "joint"},
           "rad or m, by joint",
           "Joint displacements of the perfect mechanism"}};
}

const Axes kSumAxes{"response", "case"};
const Fields<CaseResult> kSumFields{
    {"mean", &CaseResult::mean, kSumAxes, kResponseUnit, "Mean over the poses that count; NaN where there is none"},
    {"max", &CaseResult::max, kSumAxes, kResponseUnit, "Largest value over the poses that count"},
    {"count", &CaseResult::count, kSumAxes, "1", "Poses that count: solved, or as not_converged has it"}};

template <class T>
void transpose(std::vector<T>& values, std::size_t rows, std::size_t columns, std::size_t width) {
  std::vector<T> turned(values.size());
  for (std::size_t at = 0; at < values.size(); ++at) {
    const std::size_t cell = at / width;
    const std::size_t block = cell / (rows * columns);
    const std::size_t row = cell / columns % rows;
    const std::size_t column = cell % columns;
    turned[((block * columns + column) * rows + row) * width + at % width] = values[at];
  }
  values = std::move(turned);
}

/// [sample x pose] turned to [pose x sample].
EvaluationResult transposed(EvaluationResult found) {
  transpose(found.response, found.poses, found.samples, 1);
  transpose(found.status, found.poses, found.samples, 1);
  transpose(found.iterations, found.poses, found.samples, 1);
  if (found.details > 0) transpose(found.detail, found.poses, found.samples, found.details);
  std::swap(found.poses, found.samples);
  return found;
}

template <class Order>
void add_details(ResultBuilder& result, const std::vector<Detail>& details, const EvaluationResult& found,
                 const Axes& axes, const Order& order) {
  if (found.details == 0) return;
  const auto names = texts(details, &Detail::name);
  result.file().set_attribute("/evaluate", "details", std::span(names));
  std::map<std::vector<std::string>, std::string> axis_of;  // details with the same components share an axis
  std::size_t first = 0;
  for (const Detail& detail : details) {
    const std::size_t width = detail.components.size();
    const std::string next = "component" + (axis_of.empty() ? "" : "_" + std::to_string(axis_of.size() + 1));
    const auto [axis, is_new] = axis_of.try_emplace(detail.components, next);
    if (is_new) {
      result.add_axis(axis->second, detail.components, {"1", "Component of " + detail.name + " and its like"});
      result.show_axes("/evaluate", {axis->second});
    }
    const auto value = [&](std::size_t at) {
      return found.detail[order(at / width) * found.details + first + at % width];
    };
    const std::string path = "/evaluate/" + detail.name;
    result.add_computed<double>(path, {axes[0], axes[1], axis->second}, value, {detail.unit, detail.description});
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

void read_detail_values(const h5::File& file, const std::vector<Detail>& details, EvaluationResult& found) {
  for (const Detail& detail : details) found.details += detail.components.size();
  found.detail.resize(found.poses * found.samples * found.details);
  std::size_t first = 0;
  for (const Detail& detail : details) {
    const std::size_t width = detail.components.size();
    const auto values = read_shaped<double>(file, "/evaluate/" + detail.name, {found.poses, found.samples, width});
    for (std::size_t k = 0; k < values.size(); ++k) {
      found.detail[k / width * found.details + first + k % width] = values[k];
    }
    first += width;
  }
}

std::vector<SolveStatus> read_status(const h5::File& file, const Axes& axes) {
  std::vector<SolveStatus> list;
  for (const std::uint8_t code : read_along<std::uint8_t>(file, "/evaluate/status", axes)) {
    if (code >= kStatusNames.size()) throw h5::Error("/evaluate/status holds an unknown status");
    list.push_back(static_cast<SolveStatus>(code));
  }
  return list;
}

EvaluationResult read_solves(const h5::File& file, const std::vector<NamedUnit>& responses,
                             const std::vector<Detail>& details, const Axes& axes) {
  EvaluationResult found;
  found.poses = axis_length(file, axes[0]);
  found.samples = axis_length(file, axes[1]);
  found.responses = responses.size();
  for (const NamedUnit& response : responses) {
    const auto values = read_along<double>(file, "/evaluate/" + response.name, axes);
    found.response.insert(found.response.end(), values.begin(), values.end());
  }
  found.status = read_status(file, axes);
  read_detail_values(file, details, found);
  read_fields(file, "/evaluate", solve_fields(axes), found);
  return found;
}

/// axes: of the solves in the file. order(at): position in memory, where they are kept by pose, of one in the file.
template <class Order>
void add_solves(ResultBuilder& result, const ModelDescription& model, const EvaluationResult& found, const Axes& axes,
                const Order& order) {
  result.add_axis("joint", texts(model.joints, &JointDisplacement::name), {"1", "Name of the joint displacement"});
  result.file().make_group("/evaluate");
  result.show_axes("/evaluate", {axes[0], axes[1], "joint"});
  const std::size_t cells = found.poses * found.samples;
  for (std::size_t r = 0; r < model.responses.size(); ++r) {
    const Response& response = model.responses[r];
    const auto value = [&](std::size_t at) { return found.response[r * cells + order(at)]; };
    result.add_computed<double>("/evaluate/" + response.name, axes, value, {unit_of(response), response.description});
  }
  add_details(result, model.details, found, axes, order);
  const auto status_names = listed_statuses(found.total().not_assembled());
  result.add_computed<std::uint8_t>("/evaluate/status", axes, [&](std::size_t at) { return found.status[order(at)]; },
                                    {"1", "How the solve ended: a position in status_names, from 0"});
  result.file().set_attribute("/evaluate/status", "status_names", std::span(status_names));
  const Fields<EvaluationResult> fields = solve_fields(axes);
  result.add_computed<std::uint32_t>("/evaluate/" + fields[0].name, axes,
                                     [&](std::size_t at) { return found.iterations[order(at)]; },
                                     {fields[0].unit, fields[0].description});
  write_field(result, "/evaluate", fields[1], std::span(&found, 1));
}

/// rows: the axis of the rows of errors.
void add_errors(ResultBuilder& result, const ErrorTable& errors, const std::string& rows, Pairing pairing) {
  const bool row_by_row = pairing == Pairing::row_by_row;
  result.file().make_group("/errors");
  result.file().set_attribute("/errors", "pairing", std::string(row_by_row ? kRowByRow : kEveryPoseWithEveryRow));
  result.show_axes("/errors", {rows, "factor"});
  result.add("/errors/values", {rows, "factor"}, errors.values,
             {kFactorUnit, "The errors that were given; all others are zero"});
  if (errors.labels.names.empty()) return;
  result.add(kLabels, {rows}, errors.labels.names, {"1", "What the table of errors calls its rows"});
  result.file().set_attribute(kLabels, "column", errors.labels.column);
}

/// Every row of errors was tried, so that a verdict names one of them.
void check_rows(const std::vector<LimitVerdict>& limits, std::size_t rows) {
  const bool fits = std::ranges::all_of(limits, [rows](const LimitVerdict& one) { return one.tried == rows; });
  if (!fits) throw h5::Error("/limits/tried is not the number of rows of errors");
}

/// The names of the rows of errors, where they have some.
RowLabels read_labels(const h5::File& file, const std::string& rows) {
  RowLabels labels;
  if (!file.exists(kLabels)) return labels;
  labels.column = file.attribute<std::string>(kLabels, "column").at(0);
  labels.names = read_along<std::string>(file, kLabels, {rows});
  const bool wrong =
      std::ranges::any_of(labels.names, [](const std::string& name) { return label_problem(name).has_value(); });
  if (wrong || label_problem(labels.column)) throw h5::Error(std::string(kLabels) + " holds what is no label");
  return labels;
}

/// "rad,rad,m" as a unit for each of `count` components; one unit may stand for all.
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

/// The first cells of a line: the label of its row of errors, where rows have labels, and a number. row(line): the row.
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

/// What a solve gave. at(line): its position, counted pose by pose.
template <class At>
void append_solve_columns(CsvTable& table, const StoredResult& result, const At& at) {
  const StoredEvaluation& stored = evaluation_of(result);
  const EvaluationResult& found = stored.evaluation;
  const auto append = [&](const std::string& heading, auto number) {
    table.columns.push_back({heading, [at, number](std::size_t line) { return to_number(number(at(line))); }});
  };
  if (!result.time.empty()) append("time [s]", [&](std::size_t k) { return result.time[k / found.samples]; });
  for (std::size_t r = 0; r < found.responses; ++r) {
    const NamedUnit& response = result.responses[r];
    append(with_unit(response.name, response.unit),
           [&, r](std::size_t k) { return found.response[r * found.status.size() + k]; });
  }
  std::size_t d = 0;
  for (const Detail& detail : stored.details) {
    const auto units = component_units(detail.unit, detail.components.size());
    for (std::size_t k = 0; k < units.size(); ++k, ++d) {
      append(with_unit(detail.name + "_" + detail.components[k], units[k]),
             [&found, d](std::size_t solve) { return found.detail[solve * found.details + d]; });
    }
  }
  append("status", [&](std::size_t k) { return found.status[k]; });
  append("iterations", [&](std::size_t k) { return found.iterations[k]; });
}

/// Pose by pose.
CsvTable solve_table(const StoredResult& result) {
  const StoredEvaluation& stored = evaluation_of(result);
  const std::size_t samples = stored.evaluation.samples;
  CsvTable table{"evaluate", {}, stored.evaluation.status.size()};
  set_first_cells(
      table, stored.labels, "pose", [&stored](std::size_t at) { return row_of_solve(stored, at); },
      [samples](std::size_t at) { return at / samples; });
  table.columns.push_back({"sample", [samples](std::size_t at) { return to_number(at % samples); }});
  append_solve_columns(table, result, std::identity());
  return table;
}

/// Case by case.
CsvTable case_solve_table(const StoredResult& result) {
  const StoredEvaluation& stored = evaluation_of(result);
  const std::size_t poses = stored.evaluation.poses;
  const std::size_t cases = stored.cases.size();
  CsvTable table{
      "evaluate", {"case", [&, poses](std::size_t line) { return stored.cases[line / poses]; }}, cases * poses};
  table.columns.push_back({"pose", [poses](std::size_t line) { return to_number(line % poses); }});
  append_solve_columns(table, result, [poses, cases](std::size_t line) { return line % poses * cases + line / poses; });
  return table;
}

CsvTable joint_table(const StoredResult& result) {
  const StoredEvaluation& stored = evaluation_of(result);
  const std::size_t joints = stored.joints.size();
  const std::vector<double>& values = stored.evaluation.joint_displacement;
  CsvTable table = lines_of_poses(result, "joint_displacements");
  table.lines = values.size() / std::max<std::size_t>(joints, 1);
  for (std::size_t j = 0; j < joints; ++j) {
    table.columns.push_back(list_column(with_unit(stored.joints[j], "rad or m"), values, j, joints));
  }
  return table;
}

CsvTable error_table(const StoredResult& result) {
  const StoredEvaluation& stored = evaluation_of(result);
  const std::size_t factors = result.factors.size();
  CsvTable table{"errors", {}, stored.errors.size() / std::max<std::size_t>(factors, 1)};
  if (stored.cases.empty()) {
    const bool row_by_row = stored.pairing == Pairing::row_by_row;
    set_first_cells(table, stored.labels, row_by_row ? "pose" : "sample", std::identity(), std::identity());
  } else {
    table.first = {"case", [&](std::size_t c) { return stored.cases[c]; }};
  }
  for (std::size_t p = 0; p < factors; ++p) {
    const NamedUnit& factor = result.factors[p];
    table.columns.push_back(list_column(with_unit(factor.name, factor.unit), stored.errors, p, factors));
  }
  return table;
}

/// A line for each row of errors that has a label.
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
    append(with_unit(response.name + "_mean", response.unit), outcomes, &RowOutcome::mean);
    append(with_unit(response.name + "_extreme", response.unit), outcomes, &RowOutcome::extreme);
    append(response.name + "_extreme_pose", outcomes, &RowOutcome::pose);
  }
  return table;
}

CsvTable case_sum_table(const StoredResult& result) {
  const StoredEvaluation& stored = evaluation_of(result);
  const CaseResult& found = stored;
  const std::size_t cases = stored.cases.size();
  CsvTable table{"cases", {"case", [&](std::size_t c) { return stored.cases[c]; }}, cases};
  table.columns.push_back(list_column("poses", found.count));
  for (std::size_t r = 0; r < result.responses.size(); ++r) {
    const NamedUnit& response = result.responses[r];
    for (const FieldRow<CaseResult>& field : kSumFields) {
      if (field.name == "count") continue;
      const std::string heading = with_unit(response.name + "_" + field.name, csv_unit(field.unit, result, &response));
      table.columns.push_back(field_column(heading, field, found, r * cases));
    }
  }
  return table;
}

/// What `poesy evaluate` found. Refers to all.
struct EvaluatedTable {
  const EvaluationResult& found;
  const ErrorTable& errors;
  Pairing pairing;
};

void write_table(ResultBuilder& result, const Study& study, const EvaluatedTable& table) {
  const ModelDescription& model = study.model();
  add_names(result, study, table.errors.factors);
  result.add_axis("sample", axis_numbers(table.found.samples), {"1", "Number of the sample at each pose, from 0"});
  add_solves(result, model, table.found, kTableAxes, std::identity());
  add_errors(result, table.errors, table.pairing == Pairing::row_by_row ? "pose" : "sample", table.pairing);
  add_limits(result, model, table.found.verdicts);
}

void write_cases(ResultBuilder& result, const Study& study, const CaseResult& found) {
  const std::vector<ErrorCase>& cases = asked_of<CaseOptions>(study.analysis).cases;
  const ErrorTable errors = case_table(cases);
  add_names(result, study, errors.factors);
  result.add_axis("case", texts(cases, &ErrorCase::name), {"1", "Name of the case"});
  const auto by_pose = [poses = found.evaluation.poses, count = cases.size()](std::size_t at) {
    return at % poses * count + at / poses;
  };
  add_solves(result, study.model(), found.evaluation, kCaseAxes, by_pose);
  add_errors(result, errors, "case", Pairing::every_pose_with_every_row);
  add_limits(result, study.model(), found.evaluation.verdicts);
  result.show_axes("/evaluate", {"response"});
  write_fields(result, "/evaluate", kSumFields, found);
}

void write(ResultBuilder& result, const Study& study, std::any& found) {
  if (const auto* cases = std::any_cast<CaseResult>(&found)) return write_cases(result, study, *cases);
  write_table(result, study, std::any_cast<const EvaluatedTable&>(found));
}

void read(const h5::File& file, StoredResult& result) {
  StoredEvaluation stored;
  stored.details = read_details(file);
  stored.joints = file.read<std::string>("/joint");
  const bool has_cases = file.exists("/case");
  if (has_cases) {
    stored.cases = file.read<std::string>("/case");
    read_fields<CaseResult>(file, "/evaluate", kSumFields, stored);
    stored.evaluation = transposed(read_solves(file, result.responses, stored.details, kCaseAxes));
  } else {
    stored.evaluation = read_solves(file, result.responses, stored.details, kTableAxes);
  }
  const bool row_by_row = !has_cases && file.attribute<std::string>("/errors", "pairing").at(0) == kRowByRow;
  stored.pairing = row_by_row ? Pairing::row_by_row : Pairing::every_pose_with_every_row;
  const std::string rows = row_by_row ? "pose" : has_cases ? "case" : "sample";
  result.verdicts = read_limits(file, result);
  if (result.verdicts) check_rows(result.verdicts->limits, axis_length(file, rows));
  stored.errors = read_along<double>(file, "/errors/values", {rows, "factor"});
  stored.labels = read_labels(file, rows);
  if (result.verdicts) {
    result.row_names = has_cases ? stored.cases : row_names(stored.labels, stored.pairing, stored.evaluation.samples);
  }
  result.found = std::move(stored);
}

void append_tables(CsvTables& tables, const StoredResult& result) {
  append_limit_table(tables, result);
  const StoredEvaluation& stored = evaluation_of(result);
  const bool has_cases = !stored.cases.empty();
  tables.push_back(has_cases ? case_solve_table(result) : solve_table(result));
  tables.push_back(joint_table(result));
  tables.push_back(error_table(result));
  if (has_cases) tables.push_back(case_sum_table(result));
  if (!has_cases && !stored.labels.names.empty()) tables.push_back(part_table(result));
}

}  // namespace

constinit const FileKind kEvaluationFile{.write = write, .read = read, .append_tables = append_tables};

GivenErrors evaluated_errors(const StoredResult& result) {
  const StoredEvaluation& stored = evaluation_of(result);
  if (!stored.cases.empty()) return {.word = "case", .names = stored.cases, .values = stored.errors};
  return {.word = "varied error",
          .names = {std::string(kAllFactors)},
          .samples = stored.evaluation.samples,
          .pairing = stored.pairing,
          .values = stored.errors};
}

std::vector<std::string> row_names(const RowLabels& labels, Pairing pairing, std::size_t rows) {
  std::vector<std::string> names;
  for (const std::string& label : labels.names) names.push_back(labels.column + " " + label);
  if (!names.empty() || pairing == Pairing::row_by_row) return names;
  for (std::size_t row = 0; row < rows; ++row) names.push_back("sample " + std::to_string(row));
  return names;
}

void write_evaluation(const std::string& path, const Study& study, const SelectedPoses& poses, const ErrorTable& errors,
                      Pairing pairing, const EvaluationResult& result, const RunFacts& facts) {
  write_result(path, kEvaluateStudy.name, kEvaluationFile, study, poses, EvaluatedTable{result, errors, pairing},
               facts);
}

}  // namespace poesy
