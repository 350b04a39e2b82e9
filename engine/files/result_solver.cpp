#include <algorithm>
#include <cmath>

#include "engine/files/result_parts.h"
#include "engine/study/study_kind.h"

namespace poesy {
namespace {

/// How solves ended, column by column: C cells.
struct SolverColumns {
  std::vector<std::uint64_t> not_converged;   ///< [C]
  std::vector<double> iterations_mean;        ///< [C]
  std::vector<std::uint32_t> iterations_max;  ///< [C]
  std::vector<std::uint64_t> by_status;       ///< [statuses x C]
};

double mean_iterations(const SolveCounts& cell) {
  return static_cast<double>(cell.iterations) / static_cast<double>(cell.total());
}

Fields<SolverColumns> solver_fields(const Axes& cells) {
  Axes by_status{"status"};
  by_status.insert(by_status.end(), cells.begin(), cells.end());
  return {{"not_converged", &SolverColumns::not_converged, cells, "1", "Samples that did not reach their fixed point"},
          {"iterations_mean", &SolverColumns::iterations_mean, cells, "1", "Mean number of iterations of a sample"},
          {"iterations_max", &SolverColumns::iterations_max, cells, "1", "Most iterations of a sample"},
          {"solves_by_status", &SolverColumns::by_status, by_status, "1", "Samples that ended so"}};
}

/// A listed failure, as it is stored.
struct FailureRow {
  std::string factor;
  std::uint64_t pose;
  std::uint64_t sample;
  std::uint8_t status;
};

const Fields<FailureRow> kFailureFields{
    {"failed_factor",
     &FailureRow::factor,
     {"failure"},
     "1",
     "Samples that failed, by the error that varied; \"all\": all together"},
    {"failed_pose", &FailureRow::pose, {"failure"}, "1", "Their poses, by number from 0"},
    {"failed_sample", &FailureRow::sample, {"failure"}, "1", "Their numbers at that error and pose, from 0"},
    {"failed_status",
     &FailureRow::status,
     {"failure"},
     "1",
     "How these solves ended: a position in status_names, from 0"}};

std::size_t slot_named(const std::string& name, const StoredResult& result) {
  const auto found = std::ranges::find(result.varied, name);
  if (found == result.varied.end()) throw h5::Error("/solver/failed_factor names an unknown error");
  return static_cast<std::size_t>(found - result.varied.begin());
}

}  // namespace

void add_sigma(ResultBuilder& result, const Study& study) {
  result.add("/factors/sigma", {"factor"}, standard_deviations(study),
             {kFactorUnit, "Standard deviation of the error, as set in the study"});
  const auto shapes = texts(study.analysis.factors,
                            [&](FactorIndex factor) { return name(study.errors.by_factor[factor.value].shape()); });
  result.add("/factors/distribution", {"factor"}, shapes, {"1", "Distribution of the error, as set in the study"});
}

void read_sigma(const h5::File& file, StoredResult& result) {
  result.factor_sigma = read_along<double>(file, "/factors/sigma", {"factor"});
  if (!file.exists("/factors/distribution")) return;
  result.factor_distribution = read_along<std::string>(file, "/factors/distribution", {"factor"});
  check_names(result.factor_distribution, "/factors/distribution");
}

CsvTable sigma_table(const StoredResult& result) {
  CsvTable table = lines_of_factors(result, "factors");
  table.columns = {list_column(with_unit("sigma", si_units(result.factors)), result.factor_sigma),
                   {with_unit("sigma", display_units(result.factors)),
                    [&](std::size_t p) { return result.factor_sigma[p] / display(result.factors[p]).si; }}};
  return table;
}

void add_solver(ResultBuilder& result, const Axes& axes, const std::vector<SolveCounts>& solves) {
  SolverColumns columns;
  for (const SolveCounts& cell : solves) {
    columns.not_converged.push_back(cell.not_converged());
    columns.iterations_mean.push_back(mean_iterations(cell));
    columns.iterations_max.push_back(cell.most_iterations);
  }
  for (std::size_t status = 0; status < kStatusNames.size(); ++status) {
    for (const SolveCounts& cell : solves) columns.by_status.push_back(cell.by_status[status]);
  }
  result.add_axis("status", texts(kStatusNames, std::identity()), {"1", "How a solve ended"});
  result.file().make_group("/solver");
  const Fields<SolverColumns> fields = solver_fields(axes);
  write_fields(result, "/solver", fields, columns);
  result.show_axes("/solver", fields.back().axes);
}

std::vector<SolveCounts> read_solver(const h5::File& file, const Axes& axes) {
  if (axis_length(file, "status") != kStatusNames.size()) throw h5::Error("/status lists other endings of solves");
  SolverColumns columns;
  read_fields(file, "/solver", solver_fields(axes), columns);
  const std::size_t cells = columns.iterations_mean.size();
  std::vector<SolveCounts> solves(cells);
  for (std::size_t cell = 0; cell < cells; ++cell) {
    SolveCounts& counts = solves[cell];
    for (std::size_t status = 0; status < kStatusNames.size(); ++status) {
      counts.by_status[status] = columns.by_status[status * cells + cell];
    }
    // The mean is the sum over the total, so this gives back the sum exactly; without samples it is NaN.
    const auto total = static_cast<double>(counts.total());
    if (total > 0.0)
      counts.iterations = static_cast<std::uint64_t>(std::llround(columns.iterations_mean[cell] * total));
    counts.most_iterations = columns.iterations_max[cell];
  }
  return solves;
}

const std::vector<SolveNumber>& solve_numbers() {
  static const std::vector<SolveNumber> kNumbers = [] {
    std::vector<SolveNumber> list{
        {"not_converged", [](const SolveCounts& cell) { return static_cast<double>(cell.not_converged()); }},
        {"iterations_mean", mean_iterations},
        {"iterations_max", [](const SolveCounts& cell) { return static_cast<double>(cell.most_iterations); }}};
    for (std::size_t status = 0; status < kStatusNames.size(); ++status) {
      list.push_back({"solves_" + std::string(kStatusNames[status]),
                      [status](const SolveCounts& cell) { return static_cast<double>(cell.by_status[status]); }});
    }
    return list;
  }();
  return kNumbers;
}

void append_solve_columns(CsvTable& table, const std::vector<SolveCounts>& solves) {
  for (const SolveNumber& number : solve_numbers()) {
    table.columns.push_back(list_column(number.name, solves, 0, 1, number.get));
  }
}

void add_failures(ResultBuilder& result, const std::vector<Failure>& failures, const std::vector<std::string>& slots,
                  std::uint64_t total) {
  std::vector<FailureRow> rows;
  for (const Failure& failure : failures) {
    rows.push_back({slots[failure.slot], failure.pose.value, failure.failed.sample.value,
                    static_cast<std::uint8_t>(failure.failed.status)});
  }
  result.add_axis("failure", axis_numbers(rows.size()), {"1", "Number of the listed failure, from 0"});
  result.show_axes("/solver", {"failure"});
  write_columns(result, "/solver", kFailureFields, rows);
  h5::File& file = result.file();
  const auto status_names = texts(kStatusNames, std::identity());
  file.set_attribute("/solver/failed_status", "status_names", std::span(status_names));
  file.set_attribute("/solver", "failures", static_cast<std::int64_t>(total));
  file.set_attribute("/solver", "most_failures_listed", static_cast<std::int64_t>(kMostFailuresListed));
  file.set_attribute("/solver", "most_failures_of_a_cell", static_cast<std::int64_t>(FailedSamples::kMost));
}

std::vector<Failure> read_failures(const h5::File& file, const StoredResult& result) {
  if (!file.exists("/failure")) return {};
  std::vector<Failure> failures;
  for (const FailureRow& row : read_columns(file, "/solver", kFailureFields)) {
    if (row.pose >= result.poses.size()) throw h5::Error("/solver/failed_pose names an unknown pose");
    if (row.status >= kStatusNames.size()) throw h5::Error("/solver/failed_status holds an unknown status");
    failures.push_back({slot_named(row.factor, result),
                        PoseIndex(row.pose),
                        {SampleIndex(row.sample), static_cast<SolveStatus>(row.status)}});
  }
  return failures;
}

CsvTable failure_table(const StoredResult& result) {
  const std::vector<Failure>& list = result.failures;
  return {"failures",
          {"factor", [&](std::size_t line) { return result.varied[list[line].slot]; }},
          list.size(),
          {list_column("pose", list, 0, 1, [](const Failure& failure) { return failure.pose.value; }),
           list_column("sample", list, 0, 1, [](const Failure& failure) { return failure.failed.sample.value; }),
           list_column("status", list, 0, 1, [](const Failure& failure) { return failure.failed.status; })}};
}

}  // namespace poesy
