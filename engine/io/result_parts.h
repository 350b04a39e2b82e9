#pragma once

#include <functional>
#include <numeric>
#include <optional>
#include <string>
#include <vector>

#include "engine/io/result_builder.h"
#include "engine/io/result_file.h"

/// How each kind of study is composed into a result file and read back: one source file for each kind.
namespace poesy {

/// Names of the axes of a dataset, slowest first.
using Axes = std::vector<std::string>;

/// 0 .. count - 1, the values of an axis that has no names.
inline std::vector<std::int64_t> positions(std::size_t count) {
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

/// All elements of a dataset that must have as many as its place in the result asks for.
template <class T>
std::vector<T> read_exactly(const h5::File& file, const std::string& path, std::size_t count) {
  if (h5::size(file.shape(path)) != count) throw h5::Error(path + " does not have the shape it should have");
  return file.read<T>(path);
}

/// The number of positions on an axis at the root.
inline std::size_t axis_length(const h5::File& file, const std::string& name) {
  return h5::size(file.shape("/" + name));
}

/// Names become names of files and cells of tables. Throws h5::Error for one that cannot. path: of the dataset.
void check_names(const std::vector<std::string>& names, const std::string& path);

/// The poses with all that was found when they were chosen: /poses.
void add_poses(ResultBuilder& result, const ModelDescription& model, const SelectedPoses& selected);
/// By what the mechanism weighs angles against lengths, where it does: /metric.
void add_metric(ResultBuilder& result, const Study& study);
/// Fills in `metric` and `metric_points`.
void read_metric(const h5::File& file, StoredResult& result);
/// What the ranking owes to the metric's points, [2 x R]: /metric/radius_tau. After add_metric.
void add_radius_tau(ResultBuilder& result, const std::vector<double>& tau);
/// Likewise; empty where the file has none.
std::vector<double> read_radius_tau(const h5::File& file);

/// The coordinates' names and units.
std::vector<NamedUnit> read_pose_coordinates(const h5::File& file);
/// The poses, with what is stored beside them.
SelectedPoses read_poses(const h5::File& file);
/// What composing a file wrote to /run.
RunFacts read_facts(const h5::File& file);
/// The hash that the file carries; empty where it has none.
std::string stored_hash(const h5::File& file);

/// The standard deviations of the errors that the study varies, as /factors/sigma, and what their distributions are
/// called, as /factors/distribution.
void add_sigma(ResultBuilder& result, const Study& study);
/// How the solves ended, with the counts of each cell along these axes: /solver.
void add_solver(ResultBuilder& result, const Axes& axes, const std::vector<SolveCounts>& solves);
/// /solver: how the solves of each cell ended.
std::vector<SolveCounts> read_solver(const h5::File& file, std::size_t cells);
/// The first failures, as addresses, `total` in all; slots: the name of each. Follows add_solver.
void add_failures(ResultBuilder& result, const std::vector<Failure>& failures, const std::vector<std::string>& slots,
                  std::uint64_t total);
/// None in files of older versions. Reads `kind`, `poses` and `factors` of the result.
std::vector<Failure> read_failures(const h5::File& file, const StoredResult& result);

/// /sensitivity: indices and what is behind them.
void add_sensitivity(ResultBuilder& result, const Study& study, const SensitivityResult& found);
/// Fills in `sensitivity`, `factor_sigma` and `factor_distribution`.
void read_sensitivity(const h5::File& file, StoredResult& result);

/// What a program that sets tolerances needs of a sensitivity result, without the rest: /tolerances.
void add_tolerances(ResultBuilder& result, const Study& study, const SensitivityResult& found);
/// Fills in `factor_limb`, `tolerance_reference` and `mean_square_bound`.
void read_tolerances(const h5::File& file, StoredResult& result);

/// What calibration can remove of each error's effect: /separation.
void add_separation(ResultBuilder& result, const Study& study, const SeparationResult& found);
/// Fills in `sensitivity.separation`, `separation_measure` and `published_class`.
void read_separation(const h5::File& file, StoredResult& result);

/// A second fidelity beside the first: /fidelity.
void add_fidelity(ResultBuilder& result, const Study& study, const FidelityResult& found);
/// Fills in `sensitivity.fidelity` and `fidelities`.
void read_fidelity(const h5::File& file, StoredResult& result);

/// How adaptive samples came to their end: /convergence.
void add_convergence(ResultBuilder& result, std::string_view kind, const ConvergenceResult& found);
/// Of a result of this kind.
ConvergenceResult read_convergence(const h5::File& file, std::string_view kind);

/// What the indices were after fewer samples: /sensitivity/history.
void add_history(ResultBuilder& result, const IndexHistory& found, double conf_level);
/// Empty in files of older versions.
std::optional<IndexHistory> read_history(const h5::File& file);

/// /evaluate: what the model gives for each pose and row of errors.
void add_evaluation(ResultBuilder& result, const ModelDescription& model, const EvaluationResult& found);
/// /evaluate: the errors themselves, and how they belong to poses.
void add_errors(ResultBuilder& result, const ErrorTable& errors, Pairing pairing);
/// As add_evaluation and add_errors, with axes [case x pose] for [pose x sample], and the sums over the poses.
void add_cases(ResultBuilder& result, const Study& study, const CaseResult& found);
/// Fills in `evaluation`, `details`, `joints`, `pairing`, `errors`, `cases` and `case_result`.
void read_evaluation(const h5::File& file, StoredResult& result);

/// /identification: verdicts and the numbers behind them.
void add_identification(ResultBuilder& result, const Study& study, const IdentificationResult& found);
/// Fills in `identification` and `groups`.
void read_identification(const h5::File& file, StoredResult& result);

/// /monte_carlo: moments and quantiles, at each pose and over all poses.
void add_monte_carlo(ResultBuilder& result, const Study& study, const MonteCarloResult& found);
/// Fills in `monte_carlo` and `factor_sigma`.
void read_monte_carlo(const h5::File& file, StoredResult& result);

/// How the study's limits were kept: /limits.
void add_limits(ResultBuilder& result, const ModelDescription& model, const LimitVerdicts& verdicts);
/// None where the study states none. Reads `responses` of the result.
std::optional<LimitVerdicts> read_limits(const h5::File& file, const StoredResult& result);

/// /coupling: what sources do one by one and together.
void add_coupling(ResultBuilder& result, const Study& study, const CouplingResult& found);
/// Fills in `coupling`.
void read_coupling(const h5::File& file, StoredResult& result);

/// What a shard found, of a file that is one: /shard.
void add_shard(ResultBuilder& result, const Shard& shard, std::span<const Bytes> stages);

}  // namespace poesy
