#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "engine/base/units.h"
#include "engine/kinds/identification/options.h"
#include "engine/kinds/study_run.h"
#include "engine/model/pose_set.h"
#include "engine/run/result.h"
#include "engine/run/runner.h"
#include "engine/stats/tolerance.h"
#include "engine/study/study.h"

namespace poesy {

/// Writes the result of a sensitivity study: /sensitivity, /tolerances and /solver, and with them /separation where the
/// model separates its errors, /fidelity where the study compares two fidelities, /convergence where its samples are
/// adaptive and /sensitivity/history where they are not. The file appears whole or not at all under its name: written
/// beside it under a temporary name, synced, renamed. Throws FileError and leaves an existing file as it was.
void write_sensitivity(const std::string& path, const Study& study, const SelectedPoses& poses,
                       const SensitivityResult& result, const RunFacts& facts);

/// Writes the result of `evaluate`, in the same way.
void write_evaluation(const std::string& path, const Study& study, const SelectedPoses& poses, const ErrorTable& errors,
                      Pairing pairing, const EvaluationResult& result, const RunFacts& facts);

/// Writes the result of an evaluate study's cases, in the same way.
void write_cases(const std::string& path, const Study& study, const SelectedPoses& poses, const CaseResult& result,
                 const RunFacts& facts);

/// Writes the result of an identification, in the same way.
void write_identification(const std::string& path, const Study& study, const SelectedPoses& poses,
                          const IdentificationResult& result, const RunFacts& facts);

/// Writes the result of a Monte Carlo study, in the same way.
void write_monte_carlo(const std::string& path, const Study& study, const SelectedPoses& poses,
                       const MonteCarloResult& result, const RunFacts& facts);

/// Writes the result of a coupling study, in the same way.
void write_coupling(const std::string& path, const Study& study, const SelectedPoses& poses,
                    const CouplingResult& result, const RunFacts& facts);

/// Writes the result of a study of any kind, in the same way.
void write_result(const std::string& path, const Study& study, const SelectedPoses& poses, const StudyResult& result,
                  const RunFacts& facts);

/// Throws when no result file can come into being at this path, before anything is computed: InputError when its
/// folder does not exist, when the file there is one of the inputs, or neither named like a result (.h5) nor an HDF5
/// file, FileError when the folder cannot be written.
void check_result_path(const std::string& path, std::span<const std::string> inputs = {});

/// A pose coordinate or response or factor as a result file names it.
struct NamedUnit {
  std::string name;              ///< as in the model's description
  std::string unit;              ///< "m", "rad" or "1"
  std::string description = {};  ///< what it is, in words; empty in files of older versions
};

/// The unit in which people read it: mm for m.
const Unit& display(const NamedUnit& named);

/// What a coupling study found, with the names of its axes.
struct StoredCoupling {
  CouplingResult found;                 ///< the numbers
  std::vector<std::string> size_names;  ///< [Z] "0.1 mm"
  std::vector<double> linear;           ///< [Z] m; NaN where no error is a length
  std::vector<double> angular;          ///< [Z] rad; NaN where no error is an angle
  std::vector<std::string> sources;     ///< [S] names
  std::vector<std::string> subsets;     ///< [K] "FS+T"
};

/// What a result file of any kind says, read back. Members that the file does not have are empty.
/// Where a model has details, evaluation.detail holds their components in the order of `details`.
struct StoredResult {
  std::string kind;            ///< "sensitivity", "identification", "evaluate", "monte-carlo" or "coupling"
  std::string title;           ///< of the study
  std::string model;           ///< name of the mechanism
  std::string study_text;      ///< the study with every default filled in
  std::string poesy_version;   ///< of the program that wrote it
  std::string git_commit;      ///< of that program
  std::string content_sha256;  ///< as the file states it
  bool changed = false;        ///< whether the content no longer has that hash
  std::string metric;  ///< ModelDescription::metric; empty where nothing is weighed, and in files of older versions
  std::vector<PlatformPoint> metric_points;  ///< of the platform's metric, in its frame, m
  std::vector<NamedUnit> pose_coordinates;   ///< names of a pose's columns
  PoseSet poses;                             ///< [M]
  std::vector<double> condition;             ///< [M] of each pose; empty in files of older versions
  std::vector<double> time;                  ///< [M] s, ascending, of poses along a trajectory; else empty
  std::vector<NamedUnit> factors;            ///< [P] errors that vary or are tried
  std::vector<double> factor_sigma;          ///< [P] standard deviations, SI
  std::vector<NamedUnit> responses;          ///< [R]
  std::vector<std::size_t> headline;  ///< positions of the responses that a summary shows: all, unless the model chose
  std::vector<std::size_t> signed_headline;      ///< that a summary of coupled sources shows
  SensitivityResult sensitivity;                 ///< `background` is empty in files of older versions
  std::vector<std::uint64_t> factor_limb;        ///< [P] of a sensitivity result; empty in files of older versions
  std::vector<std::string> factor_distribution;  ///< [P] "normal", ...; likewise
  std::vector<std::optional<ReferenceError>> tolerance_reference;  ///< [R] likewise; none where no error has an effect
  std::vector<double> mean_square_bound;                           ///< [R] Response::mean_square_bound; likewise
  std::string separation_measure;                                  ///< what length sensitivity.separation speaks of
  std::vector<std::string> published_class;  ///< [P] the literature's class of each error, where that is separated
  std::vector<std::string> fidelities;       ///< the two that sensitivity.fidelity compares
  EvaluationResult evaluation;               ///< of an evaluation, and of cases
  std::vector<Detail> details;               ///< of the evaluation
  std::vector<std::string> joints;           ///< [joints] names
  Pairing pairing = Pairing::every_pose_with_every_row;  ///< of poses with rows of errors, in an evaluation
  std::vector<double> errors;                            ///< [S x P], or [M x P] row by row; SI
  RowLabels labels;                                      ///< of the rows of errors; empty where they have no names
  std::vector<std::string> cases;                        ///< names of the evaluation's samples, where they are cases
  CaseResult case_result;               ///< its sums over the poses; its `evaluation` is empty, see above
  IdentificationResult identification;  ///< of an identification result
  std::vector<ErrorSize> groups;        ///< of the identification
  MonteCarloResult monte_carlo;         ///< of a Monte Carlo result
  StoredCoupling coupling;              ///< of a coupling result
  RunFacts facts;                       ///< of the run, no part of the content
};

/// What a failure's address says where all errors vary together.
inline constexpr std::string_view kAllFactors = "all";

/// The name of what varies in a slot of a sampled result: an error, or kAllFactors.
std::string varied_name(const StoredResult& result, std::size_t slot);

/// The listed failures of a sampled result; of another kind there are none.
const std::vector<Failure>& listed_failures(const StoredResult& result);

/// Reads a result file. Throws FileError when it is not one, or of a newer major version. One that was changed since it
/// was written is read as it is, and says so.
StoredResult read_result(const std::string& path);

/// What a recomputed content hash is compared with.
struct Verification {
  std::string stored;    ///< the hash that the file carries
  std::string computed;  ///< the hash of its content as it is now
  /// Whether the content is what was written.
  bool matches() const { return stored == computed; }
};

/// Recomputes the content hash of a result file. Throws FileError when it cannot be read as one.
Verification verify_result(const std::string& path);

/// Writes every table of a result as CSV into a folder, made if missing: one file per table, first line the column
/// names with their units. engine/RESULT_FILE.md lists them. Only the first column may hold text (names of factors),
/// nothing is quoted: in Octave `t = importdata('global.csv', ',', 1)` gives t.data and t.rowheaders. Returns the paths
/// of the files written. Throws FileError; InputError where a file in the folder is not poesy's.
std::vector<std::string> export_tables(const StoredResult& result, const std::string& folder);
/// The same for a result that is still to be read.
std::vector<std::string> export_tables(const std::string& result_path, const std::string& folder);

}  // namespace poesy
