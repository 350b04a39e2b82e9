#include <algorithm>

#include "engine/io/export_tables.h"
#include "engine/io/row_outcomes.h"

namespace poesy {
namespace {

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

std::vector<std::string> solve_columns(const StoredResult& result) {
  std::vector<std::string> columns{"pose", "sample"};
  if (!result.cases.empty()) columns = {"case", "pose"};
  if (!result.labels.names.empty()) columns.insert(columns.begin(), result.labels.column);
  if (!result.time.empty()) columns.push_back(column("time", "s"));
  for (const NamedUnit& response : result.responses) columns.push_back(column(response.name, response.unit));
  for (const Detail& detail : result.details) {
    const auto units = component_units(detail.unit, detail.components.size());
    for (std::size_t k = 0; k < units.size(); ++k) {
      columns.push_back(column(detail.name + "_" + detail.components[k], units[k]));
    }
  }
  columns.insert(columns.end(), {"status", "iterations"});
  return columns;
}

std::vector<double> solve_row(const StoredResult& result, double second, std::size_t at) {
  const EvaluationResult& found = result.evaluation;
  std::vector<double> row{second};
  if (!result.time.empty()) row.push_back(result.time[at / found.samples]);
  for (std::size_t r = 0; r < found.responses; ++r) row.push_back(found.response[r * found.status.size() + at]);
  const auto detail = std::span(found.detail).subspan(at * found.details, found.details);
  row.insert(row.end(), detail.begin(), detail.end());
  row.push_back(static_cast<double>(found.status[at]));
  row.push_back(found.iterations[at]);
  return row;
}

/// The first cells of a line: the label of its row of errors, where rows have labels, and a number.
std::string labelled(const StoredResult& result, std::size_t row, std::size_t number) {
  const std::string label = result.labels.names.empty() ? "" : result.labels.names[row] + ",";
  return label + std::to_string(number);
}

/// Pose by pose, or case by case.
void write_solves(TableFolder& folder, const StoredResult& result) {
  const EvaluationResult& found = result.evaluation;
  folder.write("evaluate", solve_columns(result), [&](CsvTable& table) {
    for (std::size_t at = 0; result.cases.empty() && at < found.status.size(); ++at) {
      table.row(labelled(result, row_of_solve(result, at), at / found.samples),
                solve_row(result, static_cast<double>(at % found.samples), at));
    }
    for (std::size_t c = 0; c < result.cases.size(); ++c) {
      for (std::size_t m = 0; m < found.poses; ++m) {
        table.row(result.cases[c], solve_row(result, static_cast<double>(m), m * found.samples + c));
      }
    }
  });
}

void write_joints(TableFolder& folder, const StoredResult& result) {
  std::vector<std::string> columns{"pose"};
  for (const std::string& joint : result.joints) columns.push_back(column(joint, "rad or m"));
  const std::size_t width = result.joints.size();
  folder.write("joint_displacements", columns, [&](CsvTable& table) {
    const std::span values(result.evaluation.joint_displacement);
    for (std::size_t pose = 0; (pose + 1) * width <= values.size() && width > 0; ++pose) {
      table.row(std::to_string(pose), values.subspan(pose * width, width));
    }
  });
}

void write_errors(TableFolder& folder, const StoredResult& result) {
  std::vector<std::string> columns{result.pairing == Pairing::row_by_row ? "pose" : "sample"};
  if (!result.labels.names.empty()) columns.insert(columns.begin(), result.labels.column);
  for (const NamedUnit& factor : result.factors) columns.push_back(column(factor.name, factor.unit));
  const std::size_t width = result.factors.size();
  const std::size_t rows = result.errors.size() / std::max<std::size_t>(width, 1);
  folder.write("errors", columns, [&](CsvTable& table) {
    for (std::size_t row = 0; row < rows; ++row) {
      table.row(labelled(result, row, row), std::span(result.errors).subspan(row * width, width));
    }
  });
}

/// A line for each row of errors that has a label.
void write_parts(TableFolder& folder, const StoredResult& result) {
  if (result.labels.names.empty()) return;
  std::vector<std::string> columns{result.labels.column, "poses"};
  std::vector<std::vector<RowOutcome>> outcomes;
  for (std::size_t r = 0; r < result.responses.size(); ++r) {
    const NamedUnit& response = result.responses[r];
    for (const char* what : {"_mean", "_extreme"}) columns.push_back(column(response.name + what, response.unit));
    columns.push_back(response.name + "_extreme_pose");
    outcomes.push_back(row_outcomes(result, r));
  }
  folder.write("parts", columns, [&](CsvTable& table) {
    for (std::size_t row = 0; row < result.labels.names.size(); ++row) {
      std::vector<double> cells{static_cast<double>(outcomes.front()[row].solved)};
      for (const auto& of : outcomes) {
        cells.insert(cells.end(), {of[row].mean, of[row].extreme, static_cast<double>(of[row].pose)});
      }
      table.row(result.labels.names[row], cells);
    }
  });
}

void write_case_errors(TableFolder& folder, const StoredResult& result) {
  std::vector<std::string> columns{"case"};
  for (const NamedUnit& factor : result.factors) columns.push_back(column(factor.name, factor.unit));
  folder.write("errors", columns, [&](CsvTable& table) {
    const std::size_t width = result.factors.size();
    for (std::size_t c = 0; c < result.cases.size(); ++c) {
      table.row(result.cases[c], std::span(result.errors).subspan(c * width, width));
    }
  });
}

void write_case_sums(TableFolder& folder, const StoredResult& result) {
  const CaseResult& found = result.case_result;
  std::vector<std::string> columns{"case", "poses"};
  for (const NamedUnit& response : result.responses) {
    for (const char* what : {"_mean", "_max"}) columns.push_back(column(response.name + what, response.unit));
  }
  folder.write("cases", columns, [&](CsvTable& table) {
    for (std::size_t c = 0; c < result.cases.size(); ++c) {
      std::vector<double> row{static_cast<double>(found.count[c])};
      for (std::size_t at = c; at < found.mean.size(); at += result.cases.size()) {
        row.insert(row.end(), {found.mean[at], found.max[at]});
      }
      table.row(result.cases[c], row);
    }
  });
}

}  // namespace

void export_evaluation(TableFolder& folder, const StoredResult& result) {
  export_limits(folder, result.evaluation.verdicts, result);
  write_solves(folder, result);
  write_joints(folder, result);
  if (result.cases.empty()) {
    write_errors(folder, result);
    write_parts(folder, result);
    return;
  }
  write_case_errors(folder, result);
  write_case_sums(folder, result);
}

}  // namespace poesy
