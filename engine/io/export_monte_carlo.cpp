#include "engine/base/units.h"
#include "engine/io/export_tables.h"

namespace poesy {
namespace {

using Columns = std::vector<std::string>;

void add_quantile_columns(const StoredResult& result, const std::string& unit, Columns& columns) {
  for (const double level : result.monte_carlo.levels) columns.push_back(column("q_" + shortest(level), unit));
}

void append_quantiles(const std::vector<double>& quantiles, std::size_t cell, std::size_t width,
                      std::vector<double>& row) {
  const auto begin = quantiles.begin() + static_cast<std::ptrdiff_t>(cell * width);
  row.insert(row.end(), begin, begin + static_cast<std::ptrdiff_t>(width));
}

void write_response(TableFolder& folder, const StoredResult& result, std::size_t response) {
  const MonteCarloResult& found = result.monte_carlo;
  const NamedUnit& named = result.responses[response];
  Columns columns{"pose"};
  for (const char* name : {"mean", "mean_ci_low", "mean_ci_high", "std", "min", "max"}) {
    columns.push_back(column(name, named.unit));
  }
  columns.emplace_back("count");
  add_quantile_columns(result, named.unit, columns);
  folder.write("monte_carlo_" + named.name, columns, [&](CsvTable& table) {
    for (std::size_t m = 0; m < found.poses; ++m) {
      const std::size_t cell = response * found.poses + m;
      std::vector<double> row{found.mean[cell],
                              found.mean_ci_low[cell],
                              found.mean_ci_high[cell],
                              found.std[cell],
                              found.min[cell],
                              found.max[cell],
                              static_cast<double>(found.count[cell])};
      append_quantiles(found.quantiles, cell, found.levels.size(), row);
      table.row(std::to_string(m), row);
    }
  });
}

/// Responses have units of their own, so the columns name none.
void write_overall(TableFolder& folder, const StoredResult& result) {
  const MonteCarloResult& found = result.monte_carlo;
  Columns columns{"response", "mean", "std", "min", "max", "count"};
  add_quantile_columns(result, "1", columns);
  folder.write("overall", columns, [&](CsvTable& table) {
    for (std::size_t r = 0; r < found.responses; ++r) {
      std::vector<double> row{found.overall_mean[r], found.overall_std[r], found.overall_min[r], found.overall_max[r],
                              static_cast<double>(found.overall_count[r])};
      append_quantiles(found.overall_quantiles, r, found.levels.size(), row);
      table.row(result.responses[r].name, row);
    }
  });
}

void write_not_converged(TableFolder& folder, const StoredResult& result) {
  Columns columns{"pose"};
  add_solve_columns(columns);
  folder.write("not_converged", columns, [&](CsvTable& table) {
    std::size_t pose = 0;
    for (const SolveCounts& solves : result.monte_carlo.solves) {
      std::vector<double> row;
      append_solves(solves, row);
      table.row(std::to_string(pose++), row);
    }
  });
}

}  // namespace

void export_monte_carlo(TableFolder& folder, const StoredResult& result) {
  write_factors(folder, result);
  for (std::size_t r = 0; r < result.responses.size(); ++r) write_response(folder, result, r);
  write_overall(folder, result);
  write_not_converged(folder, result);
  export_failures(folder, result);
  export_convergence(folder, result);
}

}  // namespace poesy
