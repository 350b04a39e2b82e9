#include "engine/io/export_tables.h"

namespace poesy {
namespace {

/// An estimator of the global indices with its interval, each [R x P].
struct Estimator {
  std::string name;  ///< stands behind the response's
  const std::vector<double>& value;
  const std::vector<double>& low;
  const std::vector<double>& high;
};

/// The published one, and the corrected one where the file has it.
std::vector<Estimator> estimators(const SensitivityResult& found) {
  std::vector<Estimator> list{{"", found.global, found.global_ci_low, found.global_ci_high}};
  if (!found.global_corrected.empty()) {
    list.push_back(
        {"_corrected", found.global_corrected, found.global_corrected_ci_low, found.global_corrected_ci_high});
  }
  return list;
}

void add_columns(const StoredResult& result, const Estimator& of, std::vector<std::string>& columns) {
  for (const NamedUnit& response : result.responses) {
    for (const std::string& unit : {response.unit + " per " + units_of(result.factors, kSi),
                                    kDisplay(response.unit) + " per " + units_of(result.factors, kDisplay)}) {
      for (const char* what : {"", "_ci_low", "_ci_high"}) {
        columns.push_back(column(response.name + of.name + what, unit));
      }
    }
  }
}

void append_cells(const StoredResult& result, const Estimator& of, std::size_t p, std::vector<double>& row) {
  for (std::size_t r = 0; r < result.responses.size(); ++r) {
    const std::size_t at = r * result.factors.size() + p;
    const double to_display = display(result.factors[p]).si / display(result.responses[r]).si;
    for (const double scale : {1.0, to_display}) {
      row.insert(row.end(), {of.value[at] * scale, of.low[at] * scale, of.high[at] * scale});
    }
  }
}

void write_global(TableFolder& folder, const StoredResult& result) {
  const std::vector<Estimator> list = estimators(result.sensitivity);
  std::vector<std::string> columns{"factor"};
  for (const Estimator& of : list) add_columns(result, of, columns);
  folder.write("global", columns, [&](CsvTable& table) {
    for (std::size_t p = 0; p < result.factors.size(); ++p) {
      std::vector<double> row;
      for (const Estimator& of : list) append_cells(result, of, p, row);
      table.row(result.factors[p].name, row);
    }
  });
}

/// Files of older versions have none.
void write_index_change(TableFolder& folder, const StoredResult& result) {
  const SensitivityResult& found = result.sensitivity;
  if (found.index_change.empty()) return;
  std::vector<std::string> columns{"factor"};
  for (const NamedUnit& response : result.responses) columns.push_back(column(response.name, "1"));
  folder.write("index_change", columns, [&](CsvTable& table) {
    for (std::size_t p = 0; p < found.factors; ++p) {
      std::vector<double> row;
      for (std::size_t r = 0; r < found.responses; ++r) row.push_back(found.index_change[r * found.factors + p]);
      table.row(result.factors[p].name, row);
    }
  });
}

template <class UnitOf>
void write_local(TableFolder& folder, const StoredResult& result, const std::string& name,
                 std::span<const double> values, const UnitOf& unit_of) {
  const std::size_t cells = result.sensitivity.factors * result.sensitivity.poses;
  for (std::size_t r = 0; r < result.responses.size(); ++r) {
    const NamedUnit& response = result.responses[r];
    write_cells(folder, result, name + "_" + response.name, values.subspan(r * cells, cells), unit_of(response));
  }
}

template <class Get>
void write_counts(TableFolder& folder, const StoredResult& result, const std::string& name, const Get& get) {
  std::vector<double> values;
  for (const SolveCounts& counts : result.sensitivity.solves) values.push_back(static_cast<double>(get(counts)));
  write_cells(folder, result, name, values, "1");
}

void write_solver(TableFolder& folder, const StoredResult& result) {
  write_counts(folder, result, "not_converged", [](const SolveCounts& counts) { return counts.not_converged(); });
  write_counts(folder, result, "iterations_mean", [](const SolveCounts& counts) {
    return static_cast<double>(counts.iterations) / static_cast<double>(counts.total());
  });
  write_counts(folder, result, "iterations_max", [](const SolveCounts& counts) { return counts.most_iterations; });
  for (std::size_t status = 0; status < kStatusNames.size(); ++status) {
    write_counts(folder, result, "solves_" + std::string(kStatusNames[status]),
                 [status](const SolveCounts& counts) { return counts.by_status[status]; });
  }
}

}  // namespace

void write_cells(TableFolder& folder, const StoredResult& result, const std::string& name,
                 std::span<const double> values, const std::string& unit) {
  const std::size_t poses = result.sensitivity.poses;
  std::vector<std::string> columns{"factor"};
  for (std::size_t m = 0; m < poses; ++m) columns.push_back(column("pose_" + std::to_string(m), unit));
  folder.write(name, columns, [&](CsvTable& table) {
    for (std::size_t p = 0; p < result.factors.size(); ++p) {
      table.row(result.factors[p].name, values.subspan(p * poses, poses));
    }
  });
}

void export_sensitivity(TableFolder& folder, const StoredResult& result) {
  const SensitivityResult& found = result.sensitivity;
  write_factors(folder, result);
  write_global(folder, result);
  write_index_change(folder, result);
  const auto index_unit = [&](const NamedUnit& response) {
    return response.unit + " per " + units_of(result.factors, kSi);
  };
  const auto response_unit = [](const NamedUnit& response) { return response.unit; };
  const auto no_unit = [](const NamedUnit&) { return std::string("1"); };
  write_local(folder, result, "local", found.local, index_unit);
  write_local(folder, result, "local_ci_low", found.local_ci_low, index_unit);
  write_local(folder, result, "local_ci_high", found.local_ci_high, index_unit);
  write_local(folder, result, "count", found.count, no_unit);
  write_local(folder, result, "mean", found.mean, response_unit);
  write_local(folder, result, "std", found.std, response_unit);
  write_solver(folder, result);
  export_failures(folder, result);
  export_tolerances(folder, result);
  export_separation(folder, result);
  export_fidelity(folder, result);
  export_convergence(folder, result);
  export_history(folder, result);
}

}  // namespace poesy
