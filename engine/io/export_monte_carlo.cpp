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

/// Columns and numbers that stand behind those of older versions: the root mean square and the quantiles' intervals.
void add_interval_columns(const StoredResult& result, const std::string& unit, Columns& columns) {
  columns.push_back(column("rms", unit));
  if (result.monte_carlo.quantiles_ci_low.empty()) return;
  for (const double level : result.monte_carlo.levels) {
    for (const char* end : {"_ci_low", "_ci_high"}) columns.push_back(column("q_" + shortest(level) + end, unit));
  }
}

void append_intervals(const std::vector<double>& low, const std::vector<double>& high, std::size_t cell,
                      std::size_t width, std::vector<double>& row) {
  if (low.empty()) return;
  for (std::size_t q = 0; q < width; ++q) row.insert(row.end(), {low[cell * width + q], high[cell * width + q]});
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
  add_interval_columns(result, named.unit, columns);
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
      row.push_back(found.rms[cell]);
      append_intervals(found.quantiles_ci_low, found.quantiles_ci_high, cell, found.levels.size(), row);
      table.row(std::to_string(m), row);
    }
  });
}

/// Responses have units of their own, so a row ends with its unit.
void write_overall(TableFolder& folder, const StoredResult& result) {
  const MonteCarloResult& found = result.monte_carlo;
  Columns columns{"response", "mean", "std", "min", "max", "count"};
  add_quantile_columns(result, "1", columns);
  add_interval_columns(result, "1", columns);
  columns.emplace_back("unit");
  folder.write("overall", columns, [&](CsvTable& table) {
    for (std::size_t r = 0; r < found.responses; ++r) {
      std::vector<double> row{found.overall_mean[r], found.overall_std[r], found.overall_min[r], found.overall_max[r],
                              static_cast<double>(found.overall_count[r])};
      append_quantiles(found.overall_quantiles, r, found.levels.size(), row);
      row.push_back(found.overall_rms[r]);
      append_intervals(found.overall_quantiles_ci_low, found.overall_quantiles_ci_high, r, found.levels.size(), row);
      table.row(result.responses[r].name, row, result.responses[r].unit);
    }
  });
}

/// Bins of no width, which fill up the result's table, are left out.
void write_histogram(TableFolder& folder, const StoredResult& result, std::size_t response) {
  const MonteCarloResult& found = result.monte_carlo;
  const std::size_t bins = found.histogram_counts.size() / found.responses;
  const std::string& unit = result.responses[response].unit;
  const Columns columns{"bin", column("low", unit), column("high", unit), "count"};
  folder.write("histogram_" + result.responses[response].name, columns, [&](CsvTable& table) {
    for (std::size_t b = 0; b < bins; ++b) {
      const std::size_t edge = response * (bins + 1) + b;
      const std::uint64_t count = found.histogram_counts[response * bins + b];
      const double low = found.histogram_edges[edge];
      const double high = found.histogram_edges[edge + 1];
      if (count == 0 && !(low < high)) continue;
      table.row(std::to_string(b), std::vector{low, high, static_cast<double>(count)});
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
  if (!result.monte_carlo.histogram_counts.empty()) {
    for (std::size_t r = 0; r < result.responses.size(); ++r) write_histogram(folder, result, r);
  }
  export_limits(folder, result.monte_carlo.verdicts, result);
  write_not_converged(folder, result);
  export_failures(folder, result);
  export_convergence(folder, result);
}

}  // namespace poesy
