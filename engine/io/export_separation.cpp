#include "engine/io/export_tables.h"

namespace poesy {
namespace {

/// The published classes that occur, in the order of their first errors.
std::vector<std::string> classes_of(const StoredResult& result) {
  std::vector<std::string> classes;
  for (const std::string& published : result.published_class) {
    if (!published.empty() && std::ranges::find(classes, published) == classes.end()) classes.push_back(published);
  }
  return classes;
}

void write_shares(TableFolder& folder, const StoredResult& result, const SeparationResult& found) {
  const std::vector<std::string> classes = classes_of(result);
  std::vector<std::string> columns{"factor", "drive_share", "removable"};
  for (const std::string& published : classes) columns.push_back("published_" + published);
  folder.write("separation", columns, [&](CsvTable& table) {
    for (std::size_t p = 0; p < result.factors.size(); ++p) {
      std::vector<double> row{found.drive_share[p], found.removable[p]};
      for (const std::string& published : classes) row.push_back(result.published_class[p] == published ? 1.0 : 0.0);
      table.row(result.factors[p].name, row);
    }
  });
}

}  // namespace

void export_separation(TableFolder& folder, const StoredResult& result) {
  if (!result.sensitivity.separation) return;
  const SeparationResult& found = *result.sensitivity.separation;
  const std::string unit = "m per " + units_of(result.factors, kSi);
  write_shares(folder, result, found);
  write_cells(folder, result, "separation_drive", found.drive, unit);
  write_cells(folder, result, "separation_constraint", found.constraint, unit);
  write_cells(folder, result, "separation_effect", found.effect, unit);
  write_cells(folder, result, "separation_residual", found.residual, unit);
  write_cells(folder, result, "separation_removable", found.removable_local, "1");
  folder.write("separation_together", {"errors", "removable"},
               [&](CsvTable& table) { table.row("together", std::vector{found.removable_together}); });
}

}  // namespace poesy
