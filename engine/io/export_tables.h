#pragma once

#include <algorithm>
#include <filesystem>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "engine/io/file_writer.h"
#include "engine/io/output_folder.h"
#include "engine/io/result_file.h"

/// How each kind of result is written as CSV: one source file for each kind.
namespace poesy {

/// One CSV file that is being written.
class CsvTable {
 public:
  /// Writes the line of names.
  CsvTable(const std::string& path, const std::vector<std::string>& columns);

  /// A line: its first cell (or cells, with their commas) as it stands, then numbers, with NaN as "NaN" and all digits
  /// of whole numbers, then a text where one is given.
  void row(const std::string& first, std::span<const double> rest, const std::string& last = {});
  /// The file appears under its name.
  void commit();

 private:
  void flush();

  FileWriter writer_;
  std::string text_;
};

/// The folder of a result's tables.
class TableFolder {
 public:
  /// Writes tables into a folder, which must exist.
  explicit TableFolder(std::filesystem::path folder) : folder_(std::move(folder)) {}
  /// Writes nothing, but claims the files of the tables.
  explicit TableFolder(OutputFolder& claims) : claims_(&claims) {}

  /// Writes NAME.csv with these columns; fill(table) gives its rows.
  template <class Fill>
  void write(const std::string& name, const std::vector<std::string>& columns, const Fill& fill) {
    const std::string file = name + ".csv";
    if (claims_ != nullptr) return claims_->claim(file);
    const std::string path = (folder_ / file).string();
    CsvTable table(path, columns);
    fill(table);
    table.commit();
    files_.push_back(path);
  }

  /// Paths of the tables, in the order in which they were written.
  const std::vector<std::string>& files() const { return files_; }

 private:
  std::filesystem::path folder_;
  OutputFolder* claims_ = nullptr;
  std::vector<std::string> files_;
};

/// "name [unit]", or the name alone for a pure number.
std::string column(const std::string& name, const std::string& unit);

/// "m", or "m or rad" where factors differ.
template <class UnitName>
std::string units_of(const std::vector<NamedUnit>& things, const UnitName& unit_name) {
  std::vector<std::string> seen;
  for (const NamedUnit& thing : things) {
    const std::string unit(unit_name(thing.unit));
    if (std::ranges::find(seen, unit) == seen.end()) seen.push_back(unit);
  }
  std::string text;
  for (const std::string& unit : seen) text += (text.empty() ? "" : " or ") + unit;
  return text;
}

/// Names of units for units_of: as stored, in SI.
inline const auto kSi = [](const std::string& unit) { return unit; };
/// Names of units for units_of: as people read them.
inline const auto kDisplay = [](const std::string& unit) { return std::string(display_unit(dimension_of(unit)).name); };

/// The columns of append_solves.
void add_solve_columns(std::vector<std::string>& columns);
/// How solves ended: not converged, mean and most iterations, then the number of each status.
void append_solves(const SolveCounts& solves, std::vector<double>& row);

/// failures.csv, of a sensitivity or Monte Carlo result.
void export_failures(TableFolder& folder, const StoredResult& result);

/// factors.csv: the standard deviation of each error.
void write_factors(TableFolder& folder, const StoredResult& result);

/// A table of a sensitivity result with a row for each factor and a column for each pose, from values [P x M].
void write_cells(TableFolder& folder, const StoredResult& result, const std::string& name,
                 std::span<const double> values, const std::string& unit);

/// global.csv, and tables with a row for each factor and a column for each pose.
void export_sensitivity(TableFolder& folder, const StoredResult& result);
/// tolerances_RESPONSE.csv for every response; none for a file of an older version.
void export_tolerances(TableFolder& folder, const StoredResult& result);
/// Nothing where the result has no such part.
void export_separation(TableFolder& folder, const StoredResult& result);
/// fidelity.csv; nothing where the study does not compare two.
void export_fidelity(TableFolder& folder, const StoredResult& result);
/// convergence.csv, and convergence_RESPONSE.csv for every response; nothing where the number of samples was fixed.
void export_convergence(TableFolder& folder, const StoredResult& result);
/// history.csv; nothing where the study has none.
void export_history(TableFolder& folder, const StoredResult& result);
/// evaluate.csv, errors.csv and, for named cases, cases.csv.
void export_evaluation(TableFolder& folder, const StoredResult& result);
/// groups.csv, identification.csv and couplings.csv.
void export_identification(TableFolder& folder, const StoredResult& result);
/// limits.csv; nothing where the study states none.
void export_limits(TableFolder& folder, const std::optional<LimitVerdicts>& verdicts, const StoredResult& result);
/// overall.csv, limits.csv, and monte_carlo_RESPONSE.csv and histogram_RESPONSE.csv for every response.
void export_monte_carlo(TableFolder& folder, const StoredResult& result);
/// coupling.csv and coupling_summary.csv.
void export_coupling(TableFolder& folder, const StoredResult& result);

}  // namespace poesy
