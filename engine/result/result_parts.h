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

/// The parts that all or several kinds of result files have: how each is written, read, and shown as CSV.
namespace poesy {

/// 0 .. count - 1, the values of an axis that has no names.
inline std::vector<std::int64_t> axis_numbers(std::size_t count) {
  std::vector<std::int64_t> list(count);
  std::iota(list.begin(), list.end(), 0);
  return list;
}

/// One text of each thing, such as its name.
template <class Things, class Member>
std::vector<std::string> texts(const Things& things, const Member& member) {
  std::vector<std::string> list;
  for (const auto& thing : things) list.emplace_back(std::invoke(member, thing));
  return list;
}

/// The position of a name in a list of names or of named things. Throws h5::Error if it is not there.
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

/// Throws h5::Error for a name that cannot be part of a file name or a cell of a table. path: of the dataset.
void check_names(std::span<const std::string> names, const std::string& path);

/// Writes a file with what all files have (attributes of the root, /study, /poses, and /run with facts about the run);
/// compose(result) adds the rest. filetype, kind: attributes of the root. Throws FileError.
void compose_file(const std::string& path, std::string_view filetype, std::string_view kind, const Study& study,
                  const SelectedPoses& poses, const RunFacts& facts,
                  const std::function<void(ResultBuilder&)>& compose);
/// Adds what every result has: /factors, /responses, and /metric if the mechanism weighs angles against lengths.
void add_names(ResultBuilder& result, const Study& study, std::span<const FactorIndex> factors);
void read_header(const h5::File& file, StoredResult& result);  ///< Reads what every result has.
SelectedPoses read_poses(const h5::File& file);                ///< Reads the poses, with the data stored beside them.
RunFacts read_facts(const h5::File& file);                     ///< Reads /run.
std::string stored_hash(const h5::File& file);                 ///< The hash that the file states; empty if it has none.
CsvTable pose_table(const StoredResult& result);               ///< The table of poses.csv.

/// The measured errors among those that a study varies.
MeasuredErrors measured_errors(const Study& study);
/// [P] The means that a study states for the errors that it varies, SI; empty if all are zero.
std::vector<double> stated_means(const Study& study);
/// Adds the standard deviations of the errors that the study varies, /factors/sigma, the names of their distributions,
/// /factors/distribution, /factors/mean and /factors/draws if the study states some, and /measured_errors if some are
/// measured.
void add_sigma(ResultBuilder& result, const Study& study);
/// Reads the fields of these.
void read_sigma(const h5::File& file, StoredResult& result);
/// Adds factors.csv with the standard deviation of each error, and measured_errors.csv if some are measured.
void append_sigma_tables(CsvTables& tables, const StoredResult& result);

/// Positions of the responses that do not vary. varies: [R] 0 or 1, or empty if all do.
std::vector<std::size_t> constant_responses(std::span<const std::uint8_t> varies);

/// The statuses of solves that a result lists: kStatusNames, the last of which, not_assembled, only if a solve ended
/// so. Results without such solves thus keep their bits.
std::vector<std::string> listed_statuses(std::uint64_t not_assembled);
/// The number of statuses at the axis /status. Throws h5::Error if they are others than those of kStatusNames.
std::size_t listed_statuses(const h5::File& file);

/// Adds /solver: how the solves ended, with the counts of each cell along these axes.
void add_solver(ResultBuilder& result, const Axes& axes, std::span<const SolveCounts> solves);
/// The same for an array.
template <class... A>
void add_solver(ResultBuilder& result, const Array<SolveCounts, A...>& solves) {
  add_solver(result, solves.axis_names(), solves.all());
}
/// Reads /solver: how the solves of each cell ended.
std::vector<SolveCounts> read_solver(const h5::File& file, const Axes& axes);
/// Reads /solver as an array.
template <class Solves>
Solves read_solver(const h5::File& file) {
  return {lengths_in<Solves>(file), read_solver(file, Solves::axis_names())};
}
/// A number that CSV states about how solves ended.
struct SolveNumber {
  std::string name;                               ///< "not_converged", "iterations_mean", ..., "solves_STATUS"
  std::function<Number(const SolveCounts&)> get;  ///< the number for a cell
};
/// All such numbers; solves_not_assembled only if a solve ended so.
std::vector<SolveNumber> solve_numbers(std::span<const SolveCounts> solves);
/// Adds a column for each of these numbers; line n is for the n-th cell. Refers to the solves.
void append_solve_columns(CsvTable& table, std::span<const SolveCounts> solves);

/// Adds the addresses of the first failures, of `total`. slots: the name of each slot. Precondition: add_solver() ran.
void add_failures(ResultBuilder& result, const std::vector<Failure>& failures, const std::vector<std::string>& slots,
                  std::uint64_t total);
/// Reads the list of failures. Uses `varied` and `poses` of the result.
std::vector<Failure> read_failures(const h5::File& file, const StoredResult& result);
CsvTable failure_table(const StoredResult& result);  ///< The table of failures.csv, for a sampled result.

/// Adds /limits, the verdicts on the study's limits; nothing if it states none.
void add_limits(ResultBuilder& result, const ModelDescription& model, const std::optional<LimitVerdicts>& verdicts);
/// Reads /limits; none if the study states no limits. Uses `responses` of the result.
std::optional<LimitVerdicts> read_limits(const h5::File& file, const StoredResult& result);
/// Adds limits.csv; nothing if the study states no limits.
void append_limit_table(CsvTables& tables, const StoredResult& result);

/// The level of the intervals of a course, an attribute of its group or of a dataset.
inline const std::vector<Attribute<EstimateCourse>> kCourseLevel{{"conf_level", &EstimateCourse::conf_level}};

/// The names and descriptions of a course of estimates.
struct CourseWords {
  Group<EstimateCourse> group;           ///< its datasets, along the axes of the quantity and of the numbers of samples
  std::string samples_axis;              ///< name of the axis of the numbers of samples
  std::string samples_description;       ///< description of that axis
  std::string csv;                       ///< beginning of the names of CSV files
  std::string csv_slot;                  ///< heading of the column of slots
  std::vector<std::string> csv_columns;  ///< headings of the columns of the datasets
};

/// The words of /convergence. axes: of the quantities, beginning with the responses. name: of their dataset.
CourseWords convergence_words(Axes axes, const std::string& name, const std::string& unit, const std::string& quantity,
                              const std::string& rule, const std::string& csv_slot);

/// Adds the group of a course.
void add_course(ResultBuilder& result, const CourseWords& words, const EstimateCourse& found);
EstimateCourse read_course(const h5::File& file, const CourseWords& words);  ///< Reads what add_course() wrote.
/// Adds a table for each response, with a line for each slot and number of samples. ends: [slots] the final number of
/// samples at each pose; empty if all slots reached the end of the course. Refers to all arguments.
void append_course_tables(CsvTables& tables, const StoredResult& result, const CourseWords& words,
                          const EstimateCourse& found, std::span<const std::uint64_t> ends);

/// Adds /convergence, how adaptive samples converged; nothing if the number of samples was fixed.
void add_convergence(ResultBuilder& result, const CourseWords& words, const std::optional<ConvergenceResult>& found);
/// Reads /convergence; none if the number of samples was fixed.
std::optional<ConvergenceResult> read_convergence(const h5::File& file, const CourseWords& words);
/// Adds convergence.csv and convergence_RESPONSE.csv.
void append_convergence_tables(CsvTables& tables, const StoredResult& result, const CourseWords& words);

}  // namespace poesy
