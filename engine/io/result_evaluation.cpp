#include <algorithm>
#include <map>
#include <utility>

#include "engine/io/result_format.h"
#include "engine/io/result_parts.h"
#include "engine/io/table_file.h"
#include "engine/run/cases.h"

namespace poesy {
namespace {

/// Rows and columns of the datasets of solves: a table's solves are kept by pose, those of cases by case.
const Axes kTableAxes{"pose", "sample"};
const Axes kCaseAxes{"case", "pose"};
constexpr const char* kLabels = "/evaluate/label";

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

/// [pose x sample] turned to [sample x pose], or back.
EvaluationResult transposed(EvaluationResult found) {
  transpose(found.response, found.poses, found.samples, 1);
  transpose(found.status, found.poses, found.samples, 1);
  transpose(found.iterations, found.poses, found.samples, 1);
  if (found.details > 0) transpose(found.detail, found.poses, found.samples, found.details);
  std::swap(found.poses, found.samples);
  return found;
}

void add_details(ResultBuilder& result, const std::vector<Detail>& details, const EvaluationResult& found,
                 const Axes& axes) {
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
    std::vector<double> values;
    for (std::size_t row = 0; row < found.status.size(); ++row) {
      const auto begin = found.detail.begin() + static_cast<std::ptrdiff_t>(row * found.details + first);
      values.insert(values.end(), begin, begin + static_cast<std::ptrdiff_t>(width));
    }
    const std::string path = "/evaluate/" + detail.name;
    result.add(path, {axes[0], axes[1], axis->second}, values, {detail.unit, detail.description});
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
  const std::size_t rows = found.poses * found.samples;
  found.detail.resize(rows * found.details);
  std::size_t first = 0;
  for (const Detail& detail : details) {
    const std::size_t width = detail.components.size();
    const auto values = read_exactly<double>(file, "/evaluate/" + detail.name, rows * width);
    for (std::size_t k = 0; k < values.size(); ++k) {
      found.detail[k / width * found.details + first + k % width] = values[k];
    }
    first += width;
  }
}

std::vector<SolveStatus> read_status(const h5::File& file, std::size_t rows) {
  std::vector<SolveStatus> list;
  for (const std::uint8_t code : read_exactly<std::uint8_t>(file, "/evaluate/status", rows)) {
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
  const std::size_t rows = found.poses * found.samples;
  for (const NamedUnit& response : responses) {
    const auto values = read_exactly<double>(file, "/evaluate/" + response.name, rows);
    found.response.insert(found.response.end(), values.begin(), values.end());
  }
  read_detail_values(file, details, found);
  found.status = read_status(file, rows);
  found.iterations = read_exactly<std::uint32_t>(file, "/evaluate/iterations", rows);
  found.joint_displacement = read_exactly<double>(file, "/evaluate/joint_displacements",
                                                  axis_length(file, "pose") * axis_length(file, "joint"));
  return found;
}

void add_solves(ResultBuilder& result, const ModelDescription& model, const EvaluationResult& found, const Axes& axes) {
  result.add_axis("joint", texts(model.joints, &JointDisplacement::name), {"1", "Name of the joint displacement"});
  result.file().make_group("/evaluate");
  result.show_axes("/evaluate", {axes[0], axes[1], "joint"});
  const std::size_t cells = found.poses * found.samples;
  for (std::size_t r = 0; r < model.responses.size(); ++r) {
    const Response& response = model.responses[r];
    result.add("/evaluate/" + response.name, axes, std::span(found.response).subspan(r * cells, cells),
               {unit_of(response), response.description});
  }
  add_details(result, model.details, found, axes);
  std::vector<std::uint8_t> status;
  for (const SolveStatus ending : found.status) status.push_back(static_cast<std::uint8_t>(ending));
  const auto status_names = texts(kStatusNames, std::identity());
  result.add("/evaluate/status", axes, status, {"1", "How the solve ended: a position in status_names, from 0"});
  result.file().set_attribute("/evaluate/status", "status_names", std::span(status_names));
  result.add("/evaluate/iterations", axes, found.iterations, {"1", "Iterations of the solve"});
  result.add("/evaluate/joint_displacements", {"pose", "joint"}, found.joint_displacement,
             {"rad or m, by joint", "Joint displacements of the perfect mechanism"});
}

void add_error_values(ResultBuilder& result, const std::string& rows, const std::vector<double>& values,
                      std::string_view pairing) {
  result.file().make_group("/errors");
  result.file().set_attribute("/errors", "pairing", std::string(pairing));
  result.show_axes("/errors", {rows, "factor"});
  result.add("/errors/values", {rows, "factor"}, values,
             {"SI: factor unit, see /factors/unit", "The errors that were given; all others are zero"});
}

/// Every row of errors was tried, so that a verdict names one of them.
void check_rows(const std::vector<LimitVerdict>& limits, std::size_t rows) {
  const bool fits = std::ranges::all_of(limits, [rows](const LimitVerdict& one) { return one.tried == rows; });
  if (!fits) throw h5::Error("/limits/tried is not the number of rows of errors");
}

/// The names of the rows of errors, where they have some.
RowLabels read_labels(const h5::File& file, std::size_t rows) {
  RowLabels labels;
  if (!file.exists(kLabels)) return labels;
  labels.column = file.attribute<std::string>(kLabels, "column").at(0);
  labels.names = read_exactly<std::string>(file, kLabels, rows);
  const bool wrong =
      std::ranges::any_of(labels.names, [](const std::string& name) { return label_problem(name).has_value(); });
  if (wrong || label_problem(labels.column)) throw h5::Error(std::string(kLabels) + " holds what is no label");
  return labels;
}

void read_case_sums(const h5::File& file, StoredResult& result) {
  const std::size_t cells = result.responses.size() * result.cases.size();
  result.case_result.mean = read_exactly<double>(file, "/evaluate/mean", cells);
  result.case_result.max = read_exactly<double>(file, "/evaluate/max", cells);
  result.case_result.count = read_exactly<std::uint64_t>(file, "/evaluate/count", cells);
}

}  // namespace

void add_evaluation(ResultBuilder& result, const ModelDescription& model, const EvaluationResult& found) {
  result.add_axis("sample", positions(found.samples), {"1", "Number of the sample at each pose, from 0"});
  add_solves(result, model, found, kTableAxes);
  if (found.verdicts) add_limits(result, model, *found.verdicts);
}

void add_errors(ResultBuilder& result, const ErrorTable& errors, Pairing pairing) {
  const bool row_by_row = pairing == Pairing::row_by_row;
  const std::string rows = row_by_row ? "pose" : "sample";
  add_error_values(result, rows, errors.values,
                   row_by_row ? result_format::kRowByRow : result_format::kEveryPoseWithEveryRow);
  if (errors.labels.names.empty()) return;
  result.add(kLabels, {rows}, errors.labels.names, {"1", "What the table of errors calls its rows"});
  result.file().set_attribute(kLabels, "column", errors.labels.column);
}

void add_cases(ResultBuilder& result, const Study& study, const CaseResult& found) {
  const std::vector<ErrorCase>& cases = study.analysis.cases;
  result.add_axis("case", texts(cases, &ErrorCase::name), {"1", "Name of the case"});
  add_solves(result, study.model(), transposed(found.evaluation), kCaseAxes);
  add_error_values(result, "case", case_table(cases).values, result_format::kEveryPoseWithEveryRow);
  if (found.evaluation.verdicts) add_limits(result, study.model(), *found.evaluation.verdicts);
  const Axes axes{"response", "case"};
  const std::string unit = "SI: response unit, see /responses/unit";
  result.show_axes("/evaluate", {"response"});
  result.add("/evaluate/mean", axes, found.mean, {unit, "Mean over the poses that count; NaN where there is none"});
  result.add("/evaluate/max", axes, found.max, {unit, "Largest value over the poses that count"});
  result.add("/evaluate/count", axes, found.count, {"1", "Poses that count: solved, or as not_converged has it"});
}

void read_evaluation(const h5::File& file, StoredResult& result) {
  result.details = read_details(file);
  result.joints = file.read<std::string>("/joint");
  const bool has_cases = file.exists("/case");
  if (has_cases) {
    result.cases = file.read<std::string>("/case");
    read_case_sums(file, result);
    result.evaluation = transposed(read_solves(file, result.responses, result.details, kCaseAxes));
  } else {
    result.evaluation = read_solves(file, result.responses, result.details, kTableAxes);
  }
  const bool row_by_row = file.attribute<std::string>("/errors", "pairing").at(0) == result_format::kRowByRow;
  result.pairing = row_by_row ? Pairing::row_by_row : Pairing::every_pose_with_every_row;
  const std::size_t rows = row_by_row ? result.evaluation.poses : result.evaluation.samples;
  result.evaluation.verdicts = read_limits(file, result);
  if (result.evaluation.verdicts) check_rows(result.evaluation.verdicts->limits, rows);
  result.errors = read_exactly<double>(file, "/errors/values", rows * result.factors.size());
  result.labels = read_labels(file, rows);
}

}  // namespace poesy
