#include "engine/io/export_tables.h"

namespace poesy {

void export_fidelity(TableFolder& folder, const StoredResult& result) {
  if (!result.sensitivity.fidelity) return;
  const SensitivityResult& first = result.sensitivity;
  const FidelityResult& found = *first.fidelity;
  std::vector<std::string> columns{"factor", "linear"};
  for (const NamedUnit& response : result.responses) {
    const std::string unit = response.unit + " per " + units_of(result.factors, kSi);
    for (const std::string& name : {result.fidelities[0], result.fidelities[1], std::string("discrepancy")}) {
      columns.push_back(column(response.name + "_" + name, unit));
    }
    columns.push_back(response.name + "_relative_discrepancy");
    columns.push_back(response.name + "_nonlinearity");
  }
  folder.write("fidelity", columns, [&](CsvTable& table) {
    for (std::size_t p = 0; p < first.factors; ++p) {
      std::vector<double> row{static_cast<double>(found.linear[p])};
      for (std::size_t at = p; at < found.global.size(); at += first.factors) {
        row.insert(row.end(), {first.global[at], found.global[at], found.discrepancy[at],
                               found.relative_discrepancy[at], found.nonlinearity[at]});
      }
      table.row(result.factors[p].name, row);
    }
  });
  const std::vector<double> not_converged(found.not_converged.begin(), found.not_converged.end());
  write_cells(folder, result, "fidelity_not_converged", not_converged, "1");
}

}  // namespace poesy
