#pragma once

#include <algorithm>
#include <functional>
#include <numeric>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "engine/result/csv_table.h"
#include "engine/result/fields.h"
#include "engine/result/result_file.h"
#include "engine/run/evaluation.h"

/// The parts that result files of all or of several kinds have: for each how it is written, read back, and shown as
/// CSV.
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

/// The position of a name among these, or among the names of these things. Throws h5::Error where it is not there.
template <class Things, class Member = std::identity>
std::size_t position_in(const Things& things, const std::string& name, const std::string& problem,
                        const Member& member = {}) {
  const auto found = std::ranges::find(things, name, member);
  if (found == things.end()) throw h5::Error(problem);
  return static_cast<std::size_t>(found - things.begin());
}

/// The SI unit of a thing with a dimension.
template <class Thing>
std::string unit_of(const Thing& thing) {
  return std::string(si_unit(thing.dimension));
}

/// Names become names of files and cells of tables. Throws h5::Error for one that cannot. path: of the dataset.
void check_names(std::span<const std::string> names, const std::string& path);

/// Composes what every file has (what it is, /study, /poses, and /run with facts about the run), with compose(result)
/// for the rest, and writes it. filetype, kind: attributes of the root. Throws FileError.
void compose_file(const std::string& path, std::string_view filetype, std::string_view kind, const Study& study,
                  const SelectedPoses& poses, const RunFacts& facts,
                  const std::function<void(ResultBuilder&)>& compose);
/// What every result has: /factors, /responses, and /metric where the mechanism weighs angles against lengths.
void add_names(ResultBuilder& result, const Study& study, std::span<const FactorIndex> factors);
void read_header(const h5::File& file, StoredResult& result);  ///< Fills in all that every result has.
SelectedPoses read_poses(const h5::File& file);                ///< The poses, with what is stored beside them.
RunFacts read_facts(const h5::File& file);                     ///< What composing a file wrote to /run.
std::string stored_hash(const h5::File& file);    ///< The hash that the file carries; empty where it has none.
CsvTable pose_table(const StoredResult& result);  ///< poses.csv.

/// The measured ones among the errors that a study varies.
MeasuredErrors measured_errors(const Study& study);
/// The standard deviations of the errors that the study varies, as /factors/sigma, and what their distributions are
/// called, as /factors/distribution; where some are measured, /measured_errors.
void add_sigma(ResultBuilder& result, const Study& study);
/// Fills in `factor_sigma`, `factor_distribution` and `measured`.
void read_sigma(const h5::File& file, StoredResult& result);
/// factors.csv: the standard deviation of each error; measured_errors.csv where some are measured.
void append_sigma_tables(CsvTables& tables, const StoredResult& result);

/// Positions of the responses that do not vary. varies: of each response 0 or 1, or empty where all do.
std::vector<std::size_t> constant_responses(std::span<const std::uint8_t> varies);

/// How solves end, as a result lists it: kStatusNames, the last of which, not_assembled, only where a solve ended so.
/// Hence results without it keep their bits.
std::vector<std::string> listed_statuses(std::uint64_t not_assembled);
/// How many a result lists at its axis /status. Throws h5::Error where they are others.
std::size_t listed_statuses(const h5::File& file);

/// How the solves ended, with the counts of each cell along these axes: /solver.
void add_solver(ResultBuilder& result, const Axes& axes, std::span<const SolveCounts> solves);
/// The same of an array.
template <class... A>
void add_solver(ResultBuilder& result, const Array<SolveCounts, A...>& solves) {
  add_solver(result, solves.axis_names(), solves.all());
}
/// /solver: how the solves of each cell ended.
std::vector<SolveCounts> read_solver(const h5::File& file, const Axes& axes);
/// The same as an array.
template <class Solves>
Solves read_solver(const h5::File& file) {
  return {lengths_in<Solves>(file), read_solver(file, Solves::axis_names())};
}
/// A number that CSV says about how solves ended.
struct SolveNumber {
  std::string name;                               ///< "not_converged", "iterations_mean", ..., "solves_STATUS"
  std::function<Number(const SolveCounts&)> get;  ///< of a cell
};
/// All of them; solves_not_assembled only where a solve ended so.
std::vector<SolveNumber> solve_numbers(std::span<const SolveCounts> solves);
/// Appends a column for each of them; line n is of the n-th cell. Refers to them.
void append_solve_columns(CsvTable& table, std::span<const SolveCounts> solves);

/// The first failures, as addresses, `total` in all; slots: the name of each. Follows add_solver.
void add_failures(ResultBuilder& result, const std::vector<Failure>& failures, const std::vector<std::string>& slots,
                  std::uint64_t total);
/// What add_failures listed. Reads `varied` and `poses` of the result.
std::vector<Failure> read_failures(const h5::File& file, const StoredResult& result);
CsvTable failure_table(const StoredResult& result);  ///< failures.csv, of a sampled result.

/// How the study's limits were kept: /limits; nothing where it states none.
void add_limits(ResultBuilder& result, const ModelDescription& model, const std::optional<LimitVerdicts>& verdicts);
/// None where the study states none. Reads `responses` of the result.
std::optional<LimitVerdicts> read_limits(const h5::File& file, const StoredResult& result);
/// limits.csv; nothing where the study states none.
void append_limit_table(CsvTables& tables, const StoredResult& result);

/// The level of the intervals of a course, beside its group or a dataset.
inline const std::vector<Attribute<EstimateCourse>> kCourseLevel{{"conf_level", &EstimateCourse::conf_level}};

/// A course of estimates in the words of its group.
struct CourseWords {
  Group<EstimateCourse> group;           ///< its datasets, along the axes of a quantity and samples_axis
  std::string samples_axis;              ///< of the numbers of samples
  std::string samples_description;       ///< of that axis
  std::string csv;                       ///< names of files begin so
  std::string csv_slot;                  ///< heading of what the samples were of
  std::vector<std::string> csv_columns;  ///< of the rows
};

/// The words of /convergence. axes: of the quantities, the responses first. name: of the dataset of the quantities.
CourseWords convergence_words(Axes axes, const std::string& name, const std::string& unit, const std::string& quantity,
                              const std::string& rule, const std::string& csv_slot);

/// Adds the group of a course.
void add_course(ResultBuilder& result, const CourseWords& words, const EstimateCourse& found);
EstimateCourse read_course(const h5::File& file, const CourseWords& words);  ///< What add_course wrote.
/// A table for each response with a line for each slot and number of samples. ends: [slots] samples at each pose at
/// the end; empty where all went through the whole course. Refers to all.
void append_course_tables(CsvTables& tables, const StoredResult& result, const CourseWords& words,
                          const EstimateCourse& found, std::span<const std::uint64_t> ends);

/// How adaptive samples came to their end: /convergence; nothing where the number of samples was fixed.
void add_convergence(ResultBuilder& result, const CourseWords& words, const std::optional<ConvergenceResult>& found);
/// None where the number of samples was fixed.
std::optional<ConvergenceResult> read_convergence(const h5::File& file, const CourseWords& words);
/// convergence.csv and convergence_RESPONSE.csv.
void append_convergence_tables(CsvTables& tables, const StoredResult& result, const CourseWords& words);

}  // namespace poesy
