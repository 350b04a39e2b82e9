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

/// How the results of a kind of study are stored. Each kind has one such row.
struct FileKind {
  /// Adds the names of errors and responses (add_names) and the kind's groups. found: of the kind's own type; its lists
  /// may be emptied after they are written.
  void (*write)(ResultBuilder& result, const Study& study, std::any& found);
  /// Reads StoredResult::found, and the parts of the header that this kind has. The other parts are already read.
  void (*read)(const h5::File& file, StoredResult& result);
  /// Adds the tables that `poesy export` writes, except the poses.
  void (*append_tables)(std::vector<CsvTable>& tables, const StoredResult& result);
};

/// Finds the row of this name; null if there is none.
using FindFileKind = const FileKind* (*)(std::string_view name);

/// Writes the result of a study of this kind. name: the kind's name in the file. The file is written under a temporary
/// name, synced and renamed, so it appears complete or not at all. Throws FileError and then leaves an existing file as
/// it was. drawing: null, or what the features of a drawing do.
void write_result(const std::string& path, std::string_view name, const FileKind& kind, const Study& study,
                  const SelectedPoses& poses, std::any found, const RunFacts& facts,
                  const DrawingResult* drawing = nullptr);

/// Returns the path to write to: the target of a symbolic link, or the path itself. Throws if a result cannot be
/// written there, before anything is computed. InputError: the folder does not exist, the file is one of the inputs, or
/// it exists and is neither named like a result (.h5) nor an HDF5 file. FileError: the folder is not writable.
std::string check_result_path(const std::string& path, std::span<const std::string> inputs = {});

/// A pose coordinate, response or error, as a result file names it.
struct NamedUnit {
  std::string name;              ///< name in the model's description
  std::string unit;              ///< SI unit: "m", "rad", "N m"; "1" if it has none
  std::string description = {};  ///< description in words
};

const Unit& display(const NamedUnit& named);  ///< The unit in which people read it: mm for m.

/// Errors of a result that are drawn from measured parts: E errors, SI.
struct MeasuredErrors {
  std::vector<std::string> names;            ///< [E]
  std::vector<std::size_t> factors;          ///< [E] positions among all errors of the result
  std::vector<std::uint64_t> parts;          ///< [E] number of measured parts
  std::vector<double> mean;                  ///< [E] mean of the parts and of the draws
  std::vector<double> sigma_of_parts;        ///< [E] standard deviation of the parts, with n - 1
  std::vector<double> sigma;                 ///< [E] standard deviation of the draws
  std::vector<double> least_part;            ///< [E] smallest measured value
  std::vector<double> greatest_part;         ///< [E] largest measured value
  std::vector<double> least;                 ///< [E] lower bound of the draws
  std::vector<double> greatest;              ///< [E] upper bound of the draws
  std::vector<std::string> most_correlated;  ///< [E] error with the strongest correlation; "-" for none
  std::vector<double> correlation;           ///< [E] this correlation, of normal scores; 0 for none
};

/// A result file of any kind, as read. Members that the file does not have are empty.
struct StoredResult {
  std::string kind;                          ///< name of the kind of study
  std::string title;                         ///< title of the study
  std::string model;                         ///< name of the mechanism
  std::string study_text;                    ///< the study with every default filled in
  std::string mechanism_text;                ///< the mechanism file; empty if the mechanism has none
  std::string poesy_version;                 ///< version of the program that wrote it
  std::string git_commit;                    ///< commit of that program
  std::string content_sha256;                ///< hash that the file states
  bool changed = false;                      ///< whether the content has another hash now
  std::string metric;                        ///< ModelDescription::metric; empty if there is none
  std::vector<PlatformPoint> metric_points;  ///< points of the platform's metric, in its frame, m
  std::vector<NamedUnit> pose_coordinates;   ///< coordinates of a pose
  PoseSet poses;                             ///< [M]
  std::vector<double> condition;             ///< [M] condition number at each pose
  std::vector<double> time;                  ///< [M] s, ascending, for poses along a trajectory; else empty
  std::vector<NamedUnit> factors;            ///< [P] errors that vary or are tried
  std::vector<NamedUnit> responses;          ///< [R]
  std::vector<std::size_t>
      headline;  ///< positions of the responses that a summary shows; all, unless the model selects some
  std::vector<std::size_t> signed_headline;  ///< the same for a summary of coupled sources
  std::vector<std::size_t> constant;         ///< positions of responses that do not vary (stats/indices.h)
  RunFacts facts;                            ///< facts of the run, not part of the content

  MeasuredErrors measured;                       ///< errors that were drawn from measured parts
  std::vector<double> factor_sigma;              ///< [P] standard deviations of errors that were drawn, SI
  std::vector<std::string> factor_distribution;  ///< [P] distributions of these errors: "normal", ...
  std::vector<double> factor_mean;               ///< [P] means that the study states, SI; empty if it states none
  /// [P] "per pose" for errors that a machine draws anew at each pose, else "per machine"; empty if there are none.
  std::vector<std::string> factor_draws;
  /// What the samples vary, one after the other: single errors, or kAllFactors. Empty if nothing was drawn.
  std::vector<std::string> varied;
  std::vector<Failure> failures;                 ///< the first failures; their slots are positions in `varied`
  std::optional<ConvergenceResult> convergence;  ///< set if the study had adaptive samples
  std::optional<LimitVerdicts> verdicts;         ///< set if the study states limits
  std::vector<std::string> row_names;            ///< names of the rows of errors in verdicts; empty: they have none

  std::optional<DrawingResult> drawing;  ///< set if the mechanism has features that scatter in their zones

  std::any found;  ///< result of the kind, of its own type; see found_of()
};

std::string valid_hash(const StoredResult& result);  ///< The content_sha256; empty if the content has changed.

/// The result of a kind. Precondition: `result` is of the kind that has this type.
template <class Found>
const Found& found_of(const StoredResult& result) {
  POESY_EXPECTS(result.found.type() == typeid(Found));
  return std::any_cast<const Found&>(result.found);
}

/// The name in a failure's address if all errors vary together.
inline constexpr std::string_view kAllFactors = "all";

/// Reads a result file of a kind that find_kind knows. Throws FileError if it is not one, or has another major version.
/// A file that was changed after it was written is read, and the result says so.
StoredResult read_result(const std::string& path, FindFileKind find_kind);

/// A content hash and what it should be.
struct Verification {
  std::string stored;                                  ///< the hash that the file states
  std::string computed;                                ///< the hash of its present content
  bool matches() const { return stored == computed; }  ///< Whether the content is unchanged.
};

/// Computes the content hash of a result file. Throws FileError if the file cannot be read.
Verification verify_result(const std::string& path);

/// Writes every table of a result of this kind as CSV into a folder, which is made if missing. Unchanged tables of an
/// earlier result are replaced (OutputFolder). Each table is a file whose first line has the column names with their
/// units; engine/docs/result-file.md lists them. Only the first column may be text (names of errors) and nothing is
/// quoted, so in Octave `t = importdata('global.csv', ',', 1)` gives t.data and t.rowheaders. Returns the paths of the
/// files. Throws FileError; InputError if a file that would be replaced is not poesy's, or was changed.
std::vector<std::string> export_tables(const StoredResult& result, const FileKind& kind, const std::string& folder);

}  // namespace poesy
