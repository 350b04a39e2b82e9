#pragma once

#include <any>
#include <cstddef>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <typeinfo>
#include <vector>

#include "engine/base/contract.h"
#include "engine/base/units.h"
#include "engine/result/drawing_result.h"
#include "engine/run/evaluation.h"
#include "engine/run/result.h"
#include "engine/stats/tolerance.h"
#include "engine/study/poses/pose_selection.h"
#include "engine/study/study.h"

namespace poesy {

namespace h5 {
class File;
}
class ResultBuilder;
struct CsvTable;
struct StoredResult;

/// How results of a kind of study are stored. Each kind of study has one such object.
struct FileKind {
  /// Adds to the result file the names of errors and responses (add_names()) and the groups of this kind. found: the
  /// result, of the type that the kind uses; its lists may be emptied after they are written.
  void (*write)(ResultBuilder& result, const Study& study, std::any& found);
  /// Reads StoredResult::found, and those other members of StoredResult that only some kinds have. The members that all
  /// kinds have were read before (read_header()).
  void (*read)(const h5::File& file, StoredResult& result);
  /// Adds to `tables` the tables that `poesy export` writes for this kind; the table of poses is already there.
  void (*append_tables)(std::vector<CsvTable>& tables, const StoredResult& result);
};

/// Finds the FileKind of the kind of study with this name; null if there is none.
using FindFileKind = const FileKind* (*)(std::string_view name);

/// Writes the result of a study. name: name of the kind in the file. found: the result, of the type that the kind uses.
/// drawing: the effect of the drawing's features; null if there is none. The file is written under a temporary name,
/// synced and renamed, so it appears complete or not at all. Throws FileError and then leaves an existing file as it
/// was.
void write_result(const std::string& path, std::string_view name, const FileKind& kind, const Study& study,
                  const SelectedPoses& poses, std::any found, const RunFacts& facts,
                  const DrawingResult* drawing = nullptr);

/// Checks, before anything is computed, that a result can be written to a path. Returns the path to write to: the
/// target of a symbolic link, or the path itself. Throws InputError if the folder does not exist, if the file is one of
/// the inputs, or if it exists and is neither a result or shard of poesy (even a damaged one) nor empty. Throws
/// FileError if the folder is not writable.
std::string check_result_path(const std::string& path, std::span<const std::string> inputs = {});

/// The name, unit and description of a pose coordinate, a response or an error in a result file.
struct NamedUnit {
  std::string name;              ///< name in the model's description
  std::string unit;              ///< SI unit: "m", "rad", "N m"; "1" if it has none
  std::string description = {};  ///< description in words
};

const Unit& display(const NamedUnit& named);  ///< The unit in which results show this quantity: mm for m.

/// The errors of a result that are drawn from measured parts, SI.
struct MeasuredErrors {
  std::vector<std::string> names;      ///< [errors] names of the errors
  std::vector<std::size_t> factors;    ///< [errors] indices in StoredResult::factors
  std::vector<std::uint64_t> parts;    ///< [errors] number of measured parts
  std::vector<double> mean;            ///< [errors] mean of the parts, and also of the draws
  std::vector<double> sigma_of_parts;  ///< [errors] standard deviation of the parts, with the divisor `parts` - 1
  std::vector<double> sigma;           ///< [errors] standard deviation of the draws
  std::vector<double> least_part;      ///< [errors] smallest value of the parts
  std::vector<double> greatest_part;   ///< [errors] largest value of the parts
  std::vector<double> least;           ///< [errors] lower bound of the draws
  std::vector<double> greatest;        ///< [errors] upper bound of the draws
  /// [errors] Name of the other error with which this error is correlated most; "-" if it is not correlated.
  std::vector<std::string> most_correlated;
  std::vector<double> correlation;  ///< [errors] correlation with that error, between normal scores; 0 if there is none
};

/// The content of a result file of any kind of study. A member is empty if the file has no such data.
struct StoredResult {
  std::string kind;            ///< name of the kind of study
  std::string title;           ///< title of the study
  std::string model;           ///< name of the mechanism
  std::string study_text;      ///< the study file (TOML) with every default filled in
  std::string mechanism_text;  ///< the mechanism file; empty if the mechanism has none
  std::string poesy_version;   ///< version of the program that wrote the file
  std::string git_commit;      ///< commit from which that program was built
  std::string content_sha256;  ///< content hash that the file states
  bool changed = false;        ///< true if the content of the file does not have this hash
  std::string metric;          ///< the metric of the responses (ModelDescription::metric); empty if there is none
  std::vector<PlatformPoint> metric_points;  ///< points by which the metric measures mismatch (platform's frame, m)
  std::vector<NamedUnit> pose_coordinates;   ///< coordinates of a pose
  PoseSet poses;                             ///< poses of the study
  std::vector<double> condition;             ///< [poses] condition number at each pose (Model::condition)
  std::vector<double> time;                  ///< [poses] s, ascending, for poses along a trajectory; else empty
  std::vector<RejectedPoses> rejected;       ///< numbers of poses that the selection rejected, by reason
  std::uint64_t candidates = 0;              ///< number of poses that the selection examined; 0: unknown
  std::vector<NamedUnit> factors;            ///< errors (factors) to which the result refers
  std::vector<NamedUnit> responses;          ///< responses of the mechanism
  /// Indices of the responses that a summary shows; all, unless the model selects some.
  std::vector<std::size_t> headline;
  std::vector<std::size_t> signed_headline;  ///< indices of the responses that the summary of a coupling study shows:
                                             ///< those with a sign that the model selects, or else `headline`
  std::vector<std::size_t> constant;         ///< indices of responses that do not vary (stats/indices.h)
  RunFacts facts;                            ///< facts of the run, which the content hash does not cover

  MeasuredErrors measured;           ///< errors that were drawn from measured parts
  std::vector<double> factor_sigma;  ///< [factors] standard deviations of the errors, SI; empty if no errors were drawn
  /// [factors] names of the distributions of the errors: "normal", ...; empty if no errors were drawn.
  std::vector<std::string> factor_distribution;
  std::vector<double> factor_mean;  ///< [factors] means that the study states, SI; empty if all are 0
  /// [factors] "per pose" for errors that a machine draws anew at each pose, else "per machine"; empty if no error is
  /// drawn per pose.
  std::vector<std::string> factor_draws;
  /// Names of the errors that vary alone, one after the other; or only kAllFactors if all vary together. Empty if no
  /// errors were drawn.
  std::vector<std::string> varied;
  std::vector<Failure> failures;  ///< the first samples that failed; Failure::slot is an index in `varied`
  /// How adaptive samples converged; none if the number of samples was fixed.
  std::optional<ConvergenceResult> convergence;
  std::optional<LimitVerdicts> verdicts;  ///< verdicts on the limits; none if the study states no limits
  std::vector<std::string> row_names;     ///< names of the rows of errors, for verdicts; empty if rows have no names

  /// Effect of the drawing's features; none if no features scatter in their zones.
  std::optional<DrawingResult> drawing;

  std::any found;  ///< numbers that only this kind of study has, in a type of its own; see found_of()
};

/// The content_sha256 of a result; empty if the file was changed after it was written.
std::string valid_hash(const StoredResult& result);

/// StoredResult::found as an object of the type `Found`. Precondition: it has this type.
template <class Found>
const Found& found_of(const StoredResult& result) {
  POESY_EXPECTS(result.found.type() == typeid(Found));
  return std::any_cast<const Found&>(result.found);
}

/// The word that results use instead of the name of the varied error if all errors vary together.
inline constexpr std::string_view kAllFactors = "all";

/// Reads a result file. Throws FileError if the file is not a result of a kind that find_kind knows, or has another
/// major version. A file that was changed after it was written is read, with `changed` set.
StoredResult read_result(const std::string& path, FindFileKind find_kind);

/// Returns what read_result() would read after write_result(), but writes no file, and leaves out the facts of the run.
/// The memory that it needs is about the size of the file. Throws std::bad_alloc.
StoredResult as_stored(std::string_view name, const FileKind& kind, const Study& study, const SelectedPoses& poses,
                       std::any found, const DrawingResult* drawing = nullptr);

/// The content hash that a file states, and the hash of its present content.
struct Verification {
  std::string stored;                                  ///< hash that the file states
  std::string computed;                                ///< hash of the file's present content
  bool matches() const { return stored == computed; }  ///< Returns true if the content is unchanged.
};

/// Computes the content hash of a result file. Throws FileError if the file cannot be read.
Verification verify_result(const std::string& path);

/// Writes every table of a result as a CSV file into a folder, which is made if missing. Tables of an earlier result
/// are replaced if the user did not change them (OutputFolder). The first line of a file has the column names with
/// their units; engine/docs/result-file.md lists them. Most tables have text only in the first column, such as names of
/// errors. So in Octave `t = importdata('global.csv', ',', 1)` gives t.data and t.rowheaders. Returns the paths of the
/// files. Throws FileError, and InputError if a file that would be replaced is not poesy's or was changed.
std::vector<std::string> export_tables(const StoredResult& result, const FileKind& kind, const std::string& folder);

}  // namespace poesy
