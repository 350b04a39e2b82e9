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

/// Functions that write, read and export as CSV those data that several kinds of result files have.
namespace poesy {

/// The numbers 0 to count - 1, as values of an axis that has no names.
inline std::vector<std::int64_t> axis_numbers(std::size_t count) {
  std::vector<std::int64_t> list(count);
  std::iota(list.begin(), list.end(), 0);
  return list;
}

/// The texts that `member` selects, such as the names, one for each thing.
template <class Things, class Member>
std::vector<std::string> texts(const Things& things, const Member& member) {
  std::vector<std::string> list;
  for (const auto& thing : things) list.emplace_back(std::invoke(member, thing));
  return list;
}

/// The index of a name in a list of names or of named things. Throws h5::Error with `problem` if the list lacks the
/// name.
template <class Things, class Member = std::identity>
std::size_t position_in(const Things& things, const std::string& name, const std::string& problem,
                        const Member& member = {}) {
  const auto found = std::ranges::find(things, name, member);
  if (found == things.end()) throw h5::Error(problem);
  return static_cast<std::size_t>(found - things.begin());
}

/// The SI unit of a thing with a member `dimension`: "m", "rad", ...
template <class Thing>
std::string unit_of(const Thing& thing) {
  return std::string(si_unit(thing.dimension));
}

/// Throws h5::Error for a name that is empty or has a slash, a comma or a control character, so that it cannot be part
/// of a file name or of a cell of a table. path: path of the dataset with the names, for the message.
void check_names(std::span<const std::string> names, const std::string& path);

/// Writes a file with the data that all files have: attributes of the root, /study, /mechanism (if the mechanism is
/// from a file), /poses, and /run with facts of the run. compose(result): adds all other data. filetype, kind:
/// attributes of the root. Throws FileError.
void compose_file(const std::string& path, std::string_view filetype, std::string_view kind, const Study& study,
                  const SelectedPoses& poses, const RunFacts& facts,
                  const std::function<void(ResultBuilder&)>& compose);
/// Adds to the result file the errors (/factors) and responses (/responses) with their names and units, and /metric if
/// the mechanism weighs angles against lengths. factors: errors of the result.
void add_names(ResultBuilder& result, const Study& study, std::span<const FactorIndex> factors);
void read_header(const h5::File& file, StoredResult& result);  ///< Reads the members of `result` that every file has.
SelectedPoses read_poses(const h5::File& file);                ///< Reads /poses and /poses/rejected.
RunFacts read_facts(const h5::File& file);                     ///< Reads /run.
std::string stored_hash(const h5::File& file);    ///< The content hash that the file states; empty if it states none.
CsvTable pose_table(const StoredResult& result);  ///< The table of poses.csv.

/// Those errors of a study that are drawn from measured parts.
MeasuredErrors measured_errors(const Study& study);
/// [errors] The means that a study states for the errors that it varies, SI; empty if all are zero.
std::vector<double> stated_means(const Study& study);
/// Adds to the result file the distributions of the errors that the study varies: /factors/sigma with standard
/// deviations and /factors/distribution with names. Adds /factors/mean if the study states means, /factors/draws if
/// machines draw errors anew at each pose, and /measured_errors if some errors are drawn from measured parts.
void add_sigma(ResultBuilder& result, const Study& study);
/// Reads what add_sigma() wrote.
void read_sigma(const h5::File& file, StoredResult& result);
/// Adds to `tables` the table factors.csv with the standard deviation of each error. Adds measured_errors.csv if some
/// errors are drawn from measured parts.
void append_sigma_tables(CsvTables& tables, const StoredResult& result);

/// The indices of the responses that do not vary. varies: [responses] 0 or 1 for each response, or empty if all vary.
std::vector<std::size_t> constant_responses(std::span<const std::uint8_t> varies);

/// The number of statuses that every result lists, the first of kStatusNames.
inline constexpr std::size_t kLeastStatuses = 5;
/// The statuses that a result lists: the first of kStatusNames up to the last one with which a sample ended, but at
/// least kLeastStatuses. So a result that has only the first kLeastStatuses statuses has the same bits as before poesy
/// had the other statuses.
std::vector<std::string> listed_statuses(const SolveCounts& solves);
/// The number of statuses on the axis /status. Throws h5::Error if their names differ from kStatusNames.
std::size_t listed_statuses(const h5::File& file);

/// Adds to the result file the group /solver, which counts how solves ended. A cell is a varied error at a pose, or all
/// errors at a pose. solves: counts of each cell, row-major. axes: axes of the cells.
void add_solver(ResultBuilder& result, const Axes& axes, std::span<const SolveCounts> solves);
/// Adds to the result file the group /solver for an array of cells.
template <class... A>
void add_solver(ResultBuilder& result, const Array<SolveCounts, A...>& solves) {
  add_solver(result, solves.axis_names(), solves.all());
}
/// Reads /solver as a list of cells. axes: axes of the cells.
std::vector<SolveCounts> read_solver(const h5::File& file, const Axes& axes);
/// Reads /solver as an array of cells.
template <class Solves>
Solves read_solver(const h5::File& file) {
  return {lengths_in<Solves>(file), read_solver(file, Solves::axis_names())};
}
/// A number that tells how the solves of a cell ended, with the heading of its column in a CSV file.
struct SolveNumber {
  std::string name;                               ///< heading: "not_converged", "iterations_mean", ..., "solves_STATUS"
  std::function<Number(const SolveCounts&)> get;  ///< returns this number for the counts of a cell
};
/// All numbers that tell how solves ended: failures, iterations, and one for each of listed_statuses().
std::vector<SolveNumber> solve_numbers(std::span<const SolveCounts> solves);
/// Adds to the table a column for each of solve_numbers(); line n shows solves[n]. The columns keep a reference to
/// `solves`.
void append_solve_columns(CsvTable& table, std::span<const SolveCounts> solves);

/// Adds to the result file the list of the first failed samples. slots: names in StoredResult::varied, to which
/// Failure::slot refers. total: number of all failures, listed or not. Precondition: add_solver() was called.
void add_failures(ResultBuilder& result, const std::vector<Failure>& failures, const std::vector<std::string>& slots,
                  std::uint64_t total);
/// Reads the list of failures. Precondition: result.varied and result.poses have been read.
std::vector<Failure> read_failures(const h5::File& file, const StoredResult& result);
CsvTable failure_table(const StoredResult& result);  ///< The table failures.csv of a result with samples.

/// Adds to the result file the group /limits with the verdicts on the study's limits; nothing if the study states none.
void add_limits(ResultBuilder& result, const ModelDescription& model, const std::optional<LimitVerdicts>& verdicts);
/// Reads /limits; none if the study states no limits. Precondition: result.poses and result.responses have been read.
std::optional<LimitVerdicts> read_limits(const h5::File& file, const StoredResult& result);
/// Adds to `tables` the table limits.csv; nothing if the study states no limits.
void append_limit_table(CsvTables& tables, const StoredResult& result);

/// The attribute with the confidence level of the intervals in an EstimateCourse.
inline const std::vector<Attribute<EstimateCourse>> kCourseLevel{{"conf_level", &EstimateCourse::conf_level}};

/// The names and descriptions of the datasets and tables of a course of estimates (EstimateCourse).
struct CourseWords {
  /// Datasets of the course. Their axes are those of the quantities, followed by the axis of the numbers of samples.
  Group<EstimateCourse> group;
  std::string samples_axis;              ///< name of the axis along which the number of samples grows
  std::string samples_description;       ///< description of that axis
  std::string csv;                       ///< beginning of the names of the CSV files, such as "convergence_"
  std::string csv_slot;                  ///< heading of the column with the names of the varied errors
  std::vector<std::string> csv_columns;  ///< headings of the CSV columns, one for each dataset
};

/// The names and descriptions of /convergence. axes: axes of the estimated quantities, beginning with the responses.
/// name, unit, quantity: name, unit and meaning of the dataset of these quantities. rule: the rule that ends the
/// sampling, in words. csv_slot: see CourseWords.
CourseWords convergence_words(Axes axes, const std::string& name, const std::string& unit, const std::string& quantity,
                              const std::string& rule, const std::string& csv_slot);

/// Adds to the result file the group of a course of estimates (EstimateCourse): the estimates after some numbers of
/// samples.
void add_course(ResultBuilder& result, const CourseWords& words, const EstimateCourse& found);
/// Reads the course that add_course() wrote.
EstimateCourse read_course(const h5::File& file, const CourseWords& words);
/// Adds to `tables` a table for each response, with a line for each varied error (slot) and each number of samples.
/// ends: [slots] the final number of samples at each pose; empty if every slot has estimates after all numbers of
/// samples. The tables refer to the arguments, which must outlive them.
void append_course_tables(CsvTables& tables, const StoredResult& result, const CourseWords& words,
                          const EstimateCourse& found, std::span<const std::uint64_t> ends);

/// Adds to the result file the group /convergence, which tells how adaptive samples converged; nothing if the number of
/// samples was fixed.
void add_convergence(ResultBuilder& result, const CourseWords& words, const std::optional<ConvergenceResult>& found);
/// Reads /convergence; none if the number of samples was fixed.
std::optional<ConvergenceResult> read_convergence(const h5::File& file, const CourseWords& words);
/// Adds to `tables` the tables convergence.csv and convergence_RESPONSE.csv.
void append_convergence_tables(CsvTables& tables, const StoredResult& result, const CourseWords& words);

}  // namespace poesy
