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
  /// Adds to the result file the names of errors and responses (add_names()) and the kind's groups. found: the result,
  /// of the kind's own type; its lists may be emptied after they are written.
  void (*write)(ResultBuilder& result, const Study& study, std::any& found);
  /// Reads StoredResult::found, and those members of the header that only some kinds have. The other members of the
  /// header have been read before.
  void (*read)(const h5::File& file, StoredResult& result);
  /// Adds to `tables` the tables that `poesy export` writes, except the poses.
  void (*append_tables)(std::vector<CsvTable>& tables, const StoredResult& result);
};

/// Finds the FileKind of the kind of study with this name; null if there is none.
using FindFileKind = const FileKind* (*)(std::string_view name);

/// Writes the result of a study. name: name of the kind in the file. found: the result, of the kind's own type.
/// drawing: the effect of the drawing's features; null if there is none. The file is written under a temporary name,
/// synced and renamed, so it appears complete or not at all. Throws FileError and then leaves an existing file as it
/// was.
void write_result(const std::string& path, std::string_view name, const FileKind& kind, const Study& study,
                  const SelectedPoses& poses, std::any found, const RunFacts& facts,
                  const DrawingResult* drawing = nullptr);

/// Checks, before anything is computed, that a result can be written to a path. Returns the path to write to: the
/// target of a symbolic link, or the path itself. Throws InputError if the folder does not exist, if the file is one of
/// the inputs, or if it exists and is neither named like a result (.h5) nor an HDF5 file. Throws FileError if the
/// folder is not writable.
std::string check_result_path(const std::string& path, std::span<const std::string> inputs = {});

/// A pose coordinate, response or error, as a result file names it.
struct NamedUnit {
  std::string name;              ///< name in the model's description
  std::string unit;              ///< SI unit: "m", "rad", "N m"; "1" if it has none
  std::string description = {};  ///< description in words
};

const Unit& display(const NamedUnit& named);  ///< The unit in which results show this quantity: mm for m.

/// The errors of a result that are drawn from measured parts, SI.
struct MeasuredErrors {
  std::vector<std::string> names;      ///< [errors] names of the errors
  std::vector<std::size_t> factors;    ///< [errors] indices among all errors of the result
  std::vector<std::uint64_t> parts;    ///< [errors] number of measured parts
  std::vector<double> mean;            ///< [errors] mean of the parts, which is also that of the draws
  std::vector<double> sigma_of_parts;  ///< [errors] standard deviation of the parts, with divisor n - 1 for n parts
  std::vector<double> sigma;           ///< [errors] standard deviation of the draws
  std::vector<double> least_part;      ///< [errors] smallest value of the parts
  std::vector<double> greatest_part;   ///< [errors] largest value of the parts
  std::vector<double> least;           ///< [errors] lower bound of the draws
  std::vector<double> greatest;        ///< [errors] upper bound of the draws
  /// [errors] The other error with which this error is correlated most; "-" for none.
  std::vector<std::string> most_correlated;
  std::vector<double> correlation;  ///< [errors] correlation with this other error, between normal scores; 0 for none
};

/// The content of a result file of any kind. A member is empty if the file lacks its data.
struct StoredResult {
  std::string kind;            ///< name of the kind of study
  std::string title;           ///< title of the study
  std::string model;           ///< name of the mechanism
  std::string study_text;      ///< the study with every default filled in
  std::string mechanism_text;  ///< the mechanism file; empty if the mechanism has none
  std::string poesy_version;   ///< version of the program that wrote it
  std::string git_commit;      ///< commit from which that program was built
  std::string content_sha256;  ///< content hash that the file states
  bool changed = false;        ///< true if the content no longer has this hash
  std::string metric;          ///< the metric of the responses (ModelDescription::metric); empty if there is none
  std::vector<PlatformPoint> metric_points;  ///< points of the platform's metric, in its frame, m
  std::vector<NamedUnit> pose_coordinates;   ///< coordinates of a pose
  PoseSet poses;                             ///< poses of the study
  std::vector<double> condition;             ///< [poses] condition number at each pose
  std::vector<double> time;                  ///< [poses] s, ascending, for poses along a trajectory; else empty
  std::vector<RejectedPoses> rejected;       ///< poses of the workspace that are not in the study, by reason
  std::uint64_t candidates = 0;              ///< number of poses examined in the workspace; 0: unknown
  std::vector<NamedUnit> factors;            ///< errors that vary or are tried
  std::vector<NamedUnit> responses;          ///< responses of the mechanism
  /// Indices of the responses that a summary shows; all, unless the model selects some.
  std::vector<std::size_t> headline;
  std::vector<std::size_t> signed_headline;  ///< indices of the responses that a summary of coupled errors shows: those
                                             ///< with a sign that the model selects, or else `headline`
  std::vector<std::size_t> constant;         ///< indices of responses that do not vary (stats/indices.h)
  RunFacts facts;                            ///< facts of the run, not part of the content

  MeasuredErrors measured;           ///< errors that were drawn from measured parts
  std::vector<double> factor_sigma;  ///< [factors] standard deviations of errors that were drawn, SI
  /// [factors] names of the distributions of these errors: "normal", ...
  std::vector<std::string> factor_distribution;
  std::vector<double> factor_mean;  ///< [factors] means that the study states, SI; empty if it states none
  /// [factors] "per pose" for errors that a machine draws anew at each pose, else "per machine"; empty if no error is
  /// drawn per pose.
  std::vector<std::string> factor_draws;
  /// The errors that samples vary: names of errors that vary alone, or kAllFactors if all vary together. Empty if
  /// nothing was drawn.
  std::vector<std::string> varied;
  std::vector<Failure> failures;  ///< first failures; Failure::slot is an index in `varied`
  /// How adaptive samples converged; none if the number of samples was fixed.
  std::optional<ConvergenceResult> convergence;
  std::optional<LimitVerdicts> verdicts;  ///< verdicts on the limits; none if the study states no limits
  std::vector<std::string> row_names;     ///< names of the rows of errors, for verdicts; empty if they have none

  /// Effect of the drawing's features; none if no features scatter in their zones.
  std::optional<DrawingResult> drawing;

  std::any found;  ///< result of the kind of study, of the kind's own type; see found_of()
};

/// The content_sha256 of a result; empty if its content has changed since it was written.
std::string valid_hash(const StoredResult& result);

/// The numbers of a result that only its kind of study has. Precondition: `result` is of the kind that has this type.
template <class Found>
const Found& found_of(const StoredResult& result) {
  POESY_EXPECTS(result.found.type() == typeid(Found));
  return std::any_cast<const Found&>(result.found);
}

/// The word that stands in place of the varied error in the description of a failure if all errors vary together.
inline constexpr std::string_view kAllFactors = "all";

/// Reads a result file. Throws FileError if the file is not a result of a kind that find_kind knows, or has another
/// major version. A file that was changed after it was written is read, with `changed` set.
StoredResult read_result(const std::string& path, FindFileKind find_kind);

/// Converts a result to what read_result() would read after write_result(), without a file and without facts of the
/// run. Needs as much memory as the file would have. Throws std::bad_alloc.
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
/// are replaced if they were not changed (OutputFolder). The first line of a file has the column names with their
/// units; engine/docs/result-file.md lists them. Most tables have text only in the first column, such as names of
/// errors. So in Octave `t = importdata('global.csv', ',', 1)` gives t.data and t.rowheaders. Returns the paths of the
/// files. Throws FileError, and InputError if a file that would be replaced is not poesy's or was changed.
std::vector<std::string> export_tables(const StoredResult& result, const FileKind& kind, const std::string& folder);

}  // namespace poesy
