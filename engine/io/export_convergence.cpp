#include "engine/io/export_tables.h"

namespace poesy {
namespace {

/// In a Monte Carlo study all errors are one slot.
std::string row_name(const StoredResult& result, std::size_t slot) {
  return result.kind == "sensitivity" ? result.factors[slot].name : "all";
}

void write_end(TableFolder& folder, const StoredResult& result, const ConvergenceResult& found) {
  const std::size_t slots = found.samples.size();
  std::vector<std::string> columns{result.kind == "sensitivity" ? "factor" : "errors", "samples"};
  for (const NamedUnit& response : result.responses) {
    columns.push_back(response.name + "_reached");
    columns.push_back(response.name + "_relative_half_width");
  }
  folder.write("convergence", columns, [&](CsvTable& table) {
    for (std::size_t slot = 0; slot < slots; ++slot) {
      std::vector<double> row{static_cast<double>(found.samples[slot])};
      for (std::size_t at = slot; at < found.reached.size(); at += slots) {
        row.insert(row.end(), {static_cast<double>(found.reached[at]), found.relative_half_width[at]});
      }
      table.row(row_name(result, slot), row);
    }
  });
}

/// One response at every milestone.
void write_history(TableFolder& folder, const StoredResult& result, const ConvergenceResult& found, std::size_t r) {
  const std::size_t slots = found.samples.size();
  const bool indices = result.kind == "sensitivity";
  const NamedUnit& response = result.responses[r];
  const std::string unit = response.unit + (indices ? " per " + units_of(result.factors, kSi) : "");
  std::vector<std::string> columns{indices ? "factor" : "errors", "samples", column(indices ? "index" : "mean", unit),
                                   column("half_width", unit)};
  folder.write("convergence_" + response.name, columns, [&](CsvTable& table) {
    for (std::size_t slot = 0; slot < slots; ++slot) {
      for (std::size_t k = 0; k < found.milestones.size() && found.milestones[k] <= found.samples[slot]; ++k) {
        const std::size_t at = (r * slots + slot) * found.milestones.size() + k;
        table.row(row_name(result, slot),
                  std::vector{static_cast<double>(found.milestones[k]), found.quantity[at], found.half_width[at]});
      }
    }
  });
}

}  // namespace

void export_convergence(TableFolder& folder, const StoredResult& result) {
  const auto& found = result.kind == "sensitivity" ? result.sensitivity.convergence : result.monte_carlo.convergence;
  if (!found) return;
  write_end(folder, result, *found);
  for (std::size_t r = 0; r < result.responses.size(); ++r) write_history(folder, result, *found, r);
}

}  // namespace poesy
