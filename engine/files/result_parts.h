#pragma once

#include <functional>
#include <numeric>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "engine/files/csv_table.h"
#include "engine/files/fields.h"
#include "engine/files/result_file.h"

/// The parts of result files: for each how it is written, read back, and shown as CSV.
namespace poesy {

/// 0 .. count - 1, the values of an axis that has no names.
inline std::vector<std::int64_t> axis_numbers(std::size_t count) {
  std::vector<std::int64_t> list(count);
  std::iota(list.begin(), list.end(), 0);
  return list;
}

/// One text of each thing: its name, for instance.
template <class Things, class Member>
std::vector<std::string> texts(const Things& things, const Member& member) {
  std::vector<std::string> list;
  for (const auto& thing : things) list.emplace_back(std::invoke(member, thing));
  return list;
}

/// The SI unit of a thing with a dimension.
template <class Thing>
std::string unit_of(const Thing& thing) {
  return std::string(si_unit(thing.dimension));
}

/// Names become names of files and cells of tables. Throws h5::Error for one that cannot. path: of the dataset.
void check_names(const std::vector<std::string>& names, const std::string& path);

/// What every file has: what the file is, /study and /poses. filetype, kind: attributes of the root.
void add_header(ResultBuilder& result, std::string_view filetype, const StudyKind& kind, const Study& study,
                const SelectedPoses& poses);
/// What every result has: /factors, /responses, and /metric where the mechanism weighs angles against lengths.
void add_names(ResultBuilder& result, const Study& study, std::span<const FactorIndex> factors);
/// Facts about the run: /run.
void add_facts(ResultBuilder& result, const RunFacts& facts);
/// Fills in all that every result has.
void read_header(const h5::File& file, StoredResult& result);
/// The poses, with what is stored beside them.
SelectedPoses read_poses(const h5::File& file);
/// What composing a file wrote to /run.
RunFacts read_facts(const h5::File& file);
/// The hash that the file carries; empty where it has none.
std::string stored_hash(const h5::File& file);
/// poses.csv.
CsvTable pose_table(const StoredResult& result);

/// What the ranking owes to the metric's points, [2 x R]: /metric/radius_tau. After add_names.
void add_radius_tau(ResultBuilder& result, const std::vector<double>& tau);
/// Likewise; empty where the file has none.
std::vector<double> read_radius_tau(const h5::File& file);

/// The standard deviations of the errors that the study varies, as /factors/sigma, and what their distributions are
/// called, as /factors/distribution.
void add_sigma(ResultBuilder& result, const Study& study);
/// Fills in `factor_sigma`.
void read_sigma(const h5::File& file, StoredResult& result);
/// factors.csv: the standard deviation of each error.
CsvTable sigma_table(const StoredResult& result);

/// How the solves ended, with the counts of each cell along these axes: /solver.
void add_solver(ResultBuilder& result, const Axes& axes, const std::vector<SolveCounts>& solves);
/// /solver: how the solves of each cell ended.
std::vector<SolveCounts> read_solver(const h5::File& file, const Axes& axes);
/// A number that CSV says about how solves ended.
struct SolveNumber {
  std::string name;                               ///< "not_converged", "iterations_mean", ..., "solves_STATUS"
  std::function<double(const SolveCounts&)> get;  ///< of a cell
};
/// All of them.
const std::vector<SolveNumber>& solve_numbers();
/// Appends a column for each of them; line n is of the n-th cell.
void append_solve_columns(CsvTable& table, const std::vector<SolveCounts>& solves);

/// The first failures, as addresses, `total` in all; slots: the name of each. Follows add_solver.
void add_failures(ResultBuilder& result, const std::vector<Failure>& failures, const std::vector<std::string>& slots,
                  std::uint64_t total);
/// None in files of older versions. Reads `kind`, `poses` and `factors` of the result.
std::vector<Failure> read_failures(const h5::File& file, const StoredResult& result);
/// failures.csv, of a sensitivity or Monte Carlo result.
CsvTable failure_table(const StoredResult& result);

/// How the study's limits were kept: /limits; nothing where it states none.
void add_limits(ResultBuilder& result, const ModelDescription& model, const std::optional<LimitVerdicts>& verdicts);
/// None where the study states none. Reads `responses` of the result.
std::optional<LimitVerdicts> read_limits(const h5::File& file, const StoredResult& result);
/// limits.csv; nothing where the study states none.
void append_limit_table(CsvTables& tables, const StoredResult& result, const std::optional<LimitVerdicts>& verdicts);

/// How adaptive samples came to their end: /convergence; nothing where the number of samples was fixed.
void add_convergence(ResultBuilder& result, const StudyKind& kind, const std::optional<ConvergenceResult>& found);
/// Of a result of this kind.
std::optional<ConvergenceResult> read_convergence(const h5::File& file, const StudyKind& kind);
/// convergence.csv and convergence_RESPONSE.csv.
void append_convergence_tables(CsvTables& tables, const StoredResult& result, const StudyKind& kind,
                               const std::optional<ConvergenceResult>& found);
/// What the indices were after fewer samples: /sensitivity/history; nothing where there is none.
void add_history(ResultBuilder& result, const std::optional<EstimateCourse>& found);
/// None in files of older versions.
std::optional<EstimateCourse> read_history(const h5::File& file);
/// history_RESPONSE.csv.
void append_history_tables(CsvTables& tables, const StoredResult& result);

/// What a program that sets tolerances needs of a sensitivity result, without the rest: /tolerances.
void add_tolerances(ResultBuilder& result, const Study& study, const SensitivityResult& found);
/// Fills in `factor_limb`, `tolerance_reference` and `mean_square_bound`.
void read_tolerances(const h5::File& file, StoredResult& result);
/// tolerances_RESPONSE.csv; none for a file of an older version.
void append_tolerance_tables(CsvTables& tables, const StoredResult& result);

/// What calibration can remove of each error's effect: /separation.
void add_separation(ResultBuilder& result, const Study& study, const std::optional<SeparationResult>& found);
/// Fills in `sensitivity.separation`, `separation_measure` and `published_class`.
void read_separation(const h5::File& file, StoredResult& result);
/// separation.csv and its tables by pose.
void append_separation_tables(CsvTables& tables, const StoredResult& result);

/// A second fidelity beside the first: /fidelity.
void add_fidelity(ResultBuilder& result, const Study& study, const std::optional<FidelityResult>& found);
/// Fills in `sensitivity.fidelity` and `fidelities`.
void read_fidelity(const h5::File& file, StoredResult& result);
/// fidelity.csv and fidelity_not_converged.csv.
void append_fidelity_tables(CsvTables& tables, const StoredResult& result);

/// /sensitivity and the groups that belong to it: indices and what is behind them.
/// @{
void add_sensitivity(ResultBuilder& result, const Study& study, const SensitivityResult& found);
void read_sensitivity(const h5::File& file, StoredResult& result);
void append_sensitivity_tables(CsvTables& tables, const StoredResult& result);
/// @}

/// /evaluate and /errors: what the model gives for each pose and row of errors.
/// @{
void add_evaluation(ResultBuilder& result, const ModelDescription& model, const EvaluationResult& found,
                    const ErrorTable& errors, Pairing pairing);
void read_evaluation(const h5::File& file, StoredResult& result);
void append_evaluation_tables(CsvTables& tables, const StoredResult& result);
/// @}
/// As add_evaluation, with axes [case x pose] for [pose x sample], and the sums over the poses.
void add_cases(ResultBuilder& result, const Study& study, const ErrorTable& errors, const CaseResult& found);

/// /identification: verdicts and the numbers behind them.
/// @{
void add_identification(ResultBuilder& result, const Study& study, const IdentificationResult& found);
void read_identification(const h5::File& file, StoredResult& result);
void append_identification_tables(CsvTables& tables, const StoredResult& result);
/// @}

/// /monte_carlo: moments and quantiles, at each pose and over all poses.
/// @{
void add_monte_carlo(ResultBuilder& result, const Study& study, const MonteCarloResult& found);
void read_monte_carlo(const h5::File& file, StoredResult& result);
void append_monte_carlo_tables(CsvTables& tables, const StoredResult& result);
/// @}

/// /coupling: what sources do one by one and together.
/// @{
void add_coupling(ResultBuilder& result, const Study& study, const CouplingResult& found);
void read_coupling(const h5::File& file, StoredResult& result);
void append_coupling_tables(CsvTables& tables, const StoredResult& result);
/// @}

/// What a shard found, of a file that is one: /shard.
void add_shard(ResultBuilder& result, const Shard& shard, std::span<const Bytes> stages);

}  // namespace poesy
