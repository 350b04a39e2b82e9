#include <fmt/format.h>

#include <cmath>

#include "engine/base/units.h"
#include "engine/io/export_tables.h"
#include "engine/io/result_format.h"

namespace poesy {
namespace {

/// A count is written with all its digits.
std::string cell(double value) {
  constexpr double kLongest = 1e15;
  if (std::isnan(value)) return "NaN";
  return std::abs(value) < kLongest && value == std::trunc(value) ? fmt::format("{:.0f}", value) : shortest(value);
}

void write_poses(TableFolder& folder, const StoredResult& result) {
  std::vector<std::string> columns{"pose"};
  if (!result.time.empty()) columns.push_back(column("time", "s"));
  for (const NamedUnit& coordinate : result.pose_coordinates) {
    columns.push_back(column(coordinate.name, coordinate.unit));
  }
  if (!result.condition.empty()) columns.push_back("condition");
  folder.write("poses", columns, [&](CsvTable& table) {
    for (std::size_t m = 0; m < result.poses.size(); ++m) {
      const auto pose = result.poses[PoseIndex(m)];
      std::vector<double> row;
      if (!result.time.empty()) row.push_back(result.time[m]);
      row.insert(row.end(), pose.begin(), pose.end());
      if (!result.condition.empty()) row.push_back(result.condition[m]);
      table.row(std::to_string(m), row);
    }
  });
}

void add_tables(TableFolder& tables, const StoredResult& result) {
  write_poses(tables, result);
  if (result.kind == result_format::kSensitivity) {
    export_sensitivity(tables, result);
  } else if (result.kind == result_format::kIdentification) {
    export_identification(tables, result);
  } else if (result.kind == result_format::kMonteCarlo) {
    export_monte_carlo(tables, result);
  } else if (result.kind == result_format::kCoupling) {
    export_coupling(tables, result);
  } else {
    export_evaluation(tables, result);
  }
}

}  // namespace

CsvTable::CsvTable(const std::string& path, const std::vector<std::string>& columns) : writer_(path) {
  for (const std::string& name : columns) text_ += (text_.empty() ? "" : ",") + name;
  text_ += '\n';
}

void CsvTable::row(const std::string& first, std::span<const double> rest, const std::string& last) {
  constexpr std::size_t kChunk = 1 << 20;
  text_ += first;
  for (const double value : rest) text_ += ',' + cell(value);
  if (!last.empty()) text_ += ',' + last;
  text_ += '\n';
  if (text_.size() > kChunk) flush();
}

void CsvTable::commit() {
  flush();
  writer_.commit();
}

void CsvTable::flush() {
  writer_.write(text_);
  text_.clear();
}

std::string column(const std::string& name, const std::string& unit) {
  return unit == "1" ? name : name + " [" + unit + "]";
}

void add_solve_columns(std::vector<std::string>& columns) {
  columns.insert(columns.end(), {"not_converged", "iterations_mean", "iterations_max"});
  for (const std::string_view status : kStatusNames) columns.push_back("solves_" + std::string(status));
}

void append_solves(const SolveCounts& solves, std::vector<double>& row) {
  row.insert(row.end(), {static_cast<double>(solves.not_converged()),
                         static_cast<double>(solves.iterations) / static_cast<double>(solves.total()),
                         static_cast<double>(solves.most_iterations)});
  for (const std::uint64_t count : solves.by_status) row.push_back(static_cast<double>(count));
}

void write_factors(TableFolder& folder, const StoredResult& result) {
  const std::vector<std::string> columns{"factor", column("sigma", units_of(result.factors, kSi)),
                                         column("sigma", units_of(result.factors, kDisplay))};
  folder.write("factors", columns, [&](CsvTable& table) {
    for (std::size_t p = 0; p < result.factors.size(); ++p) {
      const double sigma = result.factor_sigma[p];
      table.row(result.factors[p].name, std::vector{sigma, sigma / display(result.factors[p]).si});
    }
  });
}

std::vector<std::string> export_tables(const std::string& result_path, const std::string& folder) {
  return export_tables(read_result(result_path), folder);
}

std::vector<std::string> export_tables(const StoredResult& result, const std::string& folder) {
  OutputFolder output(folder);
  TableFolder claimed(output);
  add_tables(claimed, result);
  output.open();
  TableFolder written(folder);
  add_tables(written, result);
  output.close();
  return written.files();
}

}  // namespace poesy
