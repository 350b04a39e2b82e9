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

/// How files keep what a kind of study found: a row for each kind.
struct FileKind {
  /// Adds the names of errors and responses (add_names), and the kind's groups. found: of the type that the kind finds;
  /// lists that were written may be emptied.
  void (*write)(ResultBuilder& result, const Study& study, std::any& found);
  /// Fills in StoredResult::found, and of the header what the kind's files have. The rest of the header is there.
  void (*read)(const h5::File& file, StoredResult& result);
  /// Appends the tables that `poesy export` writes, all but that of the poses.
  void (*append_tables)(std::vector<CsvTable>& tables, const StoredResult& result);
};

/// Finds the row of this name; null where there is none.
using FindFileKind = const FileKind* (*)(std::string_view name);

/// Writes what a study of this kind found; name: the kind's, as the file states it. The file appears whole or not at
/// all under its name: written beside it under a temporary name, synced, renamed. Throws FileError and leaves an
/// existing file as it was.
void write_result(const std::string& path, std::string_view name, const FileKind& kind, const Study& study,
                  const SelectedPoses& poses, std::any found, const RunFacts& facts);

/// Gives the path to write to: where a symbolic link leads; else the path itself. Throws when no result file can come
/// into being there, before anything is computed: InputError when its folder does not exist, when the file there is one
/// of the inputs, or neither named like a result (.h5) nor an HDF5 file, FileError when the folder cannot be written.
std::string check_result_path(const std::string& path, std::span<const std::string> inputs = {});

/// A pose coordinate or response or factor as a result file names it.
struct NamedUnit {
  std::string name;              ///< as in the model's description
  std::string unit;              ///< of the SI: "m", "rad", "N m"; "1" where it has none
  std::string description = {};  ///< what it is, in words
};

const Unit& display(const NamedUnit& named);  ///< The unit in which people read it: mm for m.

/// Errors of a result that are drawn as parts were measured: E of them, SI.
struct MeasuredErrors {
  std::vector<std::string> names;            ///< [E]
  std::vector<std::size_t> factors;          ///< [E] positions among all errors of the result
  std::vector<std::uint64_t> parts;          ///< [E] that were measured
  std::vector<double> mean;                  ///< [E] of the parts, and of the draws
  std::vector<double> sigma_of_parts;        ///< [E] standard deviation of the parts, with n - 1
  std::vector<double> sigma;                 ///< [E] of the draws
  std::vector<double> least_part;            ///< [E]
  std::vector<double> greatest_part;         ///< [E]
  std::vector<double> least;                 ///< [E] no draw is below
  std::vector<double> greatest;              ///< [E] no draw is above
  std::vector<std::string> most_correlated;  ///< [E] the error with which it is correlated most; "-" for none
  std::vector<double> correlation;           ///< [E] with that one, of their normal scores; 0 for none
};

/// What a result file of any kind says, read back. Members that the file does not have are empty.
struct StoredResult {
  std::string kind;                          ///< name of the kind of study
  std::string title;                         ///< of the study
  std::string model;                         ///< name of the mechanism
  std::string study_text;                    ///< the study with every default filled in
  std::string mechanism_text;                ///< the file that describes the mechanism; empty where there is none
  std::string poesy_version;                 ///< of the program that wrote it
  std::string git_commit;                    ///< of that program
  std::string content_sha256;                ///< as the file states it
  bool changed = false;                      ///< whether the content no longer has that hash
  std::string metric;                        ///< ModelDescription::metric; empty where nothing is weighed
  std::vector<PlatformPoint> metric_points;  ///< of the platform's metric, in its frame, m
  std::vector<NamedUnit> pose_coordinates;   ///< names of a pose's columns
  PoseSet poses;                             ///< [M]
  std::vector<double> condition;             ///< [M] of each pose
  std::vector<double> time;                  ///< [M] s, ascending, of poses along a trajectory; else empty
  std::vector<NamedUnit> factors;            ///< [P] errors that vary or are tried
  std::vector<NamedUnit> responses;          ///< [R]
  std::vector<std::size_t> headline;  ///< positions of the responses that a summary shows: all, unless the model chose
  std::vector<std::size_t> signed_headline;  ///< that a summary of coupled sources shows
  std::vector<std::size_t> constant;         ///< positions of responses that do not vary (stats/indices.h)
  RunFacts facts;                            ///< of the run, no part of the content

  MeasuredErrors measured;                       ///< of the errors that were drawn
  std::vector<double> factor_sigma;              ///< [P] standard deviations of errors that were drawn, SI
  std::vector<std::string> factor_distribution;  ///< [P] of these errors: "normal", ...
  /// What the samples varied, one after the other: the errors, or kAllFactors. Empty where nothing was drawn.
  std::vector<std::string> varied;
  std::vector<Failure> failures;                 ///< the first; their slots are positions in `varied`
  std::optional<ConvergenceResult> convergence;  ///< where the study had adaptive samples
  std::optional<LimitVerdicts> verdicts;         ///< where the study states limits
  std::vector<std::string> row_names;  ///< of the rows of errors that verdicts name; empty: they have no names

  std::any found;  ///< what the kind alone found, of the kind's own type: found_of()
};

std::string valid_hash(const StoredResult& result);  ///< Its content_sha256; empty where the content changed since.

/// What a kind alone found. Precondition: `result` is of the kind that has this type.
template <class Found>
const Found& found_of(const StoredResult& result) {
  POESY_EXPECTS(result.found.type() == typeid(Found));
  return std::any_cast<const Found&>(result.found);
}

/// What a failure's address says where all errors vary together.
inline constexpr std::string_view kAllFactors = "all";

/// Reads a result file of a kind that find_kind knows. Throws FileError when it is not one, or of another
/// major version. One that was changed since it was written is read as it is, and says so.
StoredResult read_result(const std::string& path, FindFileKind find_kind);

/// What a recomputed content hash is compared with.
struct Verification {
  std::string stored;                                  ///< the hash that the file carries
  std::string computed;                                ///< the hash of its content as it is now
  bool matches() const { return stored == computed; }  ///< Whether the content is what was written.
};

/// Recomputes the content hash of a result file. Throws FileError when it cannot be read as one.
Verification verify_result(const std::string& path);

/// Writes every table of a result of this kind as CSV into a folder, made if missing, in place of the unchanged tables
/// of another result (OutputFolder): one file per table, first line the column names with their units.
/// engine/docs/result-file.md lists them. Only the first column may hold text (names of factors), nothing is quoted: in
/// Octave `t = importdata('global.csv', ',', 1)` gives t.data and t.rowheaders. Returns the paths of the files written.
/// Throws FileError; InputError where a file that would go is not poesy's, or changed.
std::vector<std::string> export_tables(const StoredResult& result, const FileKind& kind, const std::string& folder);

}  // namespace poesy
