#pragma once

#include <atomic>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "engine/app/terminal.h"
#include "engine/base/error.h"
#include "engine/result/result_file.h"
#include "engine/run/result.h"
#include "engine/run/run_options.h"
#include "engine/storage/checkpoint.h"
#include "engine/study/study.h"

namespace poesy::app {

/// The facts about a run that has just ended on this machine. wall_seconds: duration of the run, s.
RunFacts run_facts(double wall_seconds, std::size_t threads, std::uint64_t solves);
/// The number of samples of a run as text: "2000 solves". If some samples were computed from certified series
/// (engine/run/series_model.h): "2000 samples (40 solved, the others by series)".
std::string samples_text(const RunFacts& facts);

/// Options of the search for poses.
struct SearchOptions {
  bool quiet = false;  ///< true if no progress is shown on stderr
  /// A flag that another thread or a signal sets to stop the search; may be null.
  const std::atomic<bool>* stop = nullptr;
};

/// Finds the poses that the study selects, with progress on stderr. None if the search was stopped. Throws InputError
/// as select_poses() does, after a warning for each doubtful size of the mechanism (geometry_doubts()).
std::optional<SelectedPoses> find_poses(const Study& study, const Model& model, const SearchOptions& options);

/// The paths of the study file and of the files that it names.
std::vector<std::string> inputs_of(const std::string& study_path, const Study& study);

/// A study that is ready to run, with its model and its poses.
struct Job {
  const Study& study;
  const Model& model;
  SelectedPoses poses;
  std::string path;    ///< path of the result
  RunOptions options;  ///< options of the run, with its checkpoints
  /// Returns the time of this run so far, plus that of the earlier runs that it continues.
  std::function<RunTime()> time;
  std::size_t threads;  ///< number of threads of all ranks together
  std::size_t ranks = 1;

  Checkpoints& checkpoints() const { return *options.checkpoints; }
};

/// The outcome of a run. The counts of solves and the duration in `facts` include the earlier runs that the run
/// continues.
struct RunOutcome {
  SolveCounts solves;
  RunFacts facts;
  std::optional<LimitVerdicts> verdicts = std::nullopt;
  std::vector<std::string> row_names = {};   ///< names of the rows of errors in `verdicts`
  std::vector<std::string> far_limits = {};  ///< notes on limits far from the judged values (ReportKind::far_limits)
  /// Path of the study that was written beside the result (check_files_beside()); empty: none.
  std::string confirming = {};
};

/// A run may write, beside its result, a study that repeats the certificate of the result, and files that this study
/// names. Throws InputError if one of these files would replace an input, or an existing file that was not written with
/// an earlier result of this path.
void check_files_beside(const std::string& result, std::span<const std::string> inputs);

/// Runs a study of any kind, or a shard of it, and writes the result. If there are several ranks, only rank 0 writes.
/// None if the run was interrupted. Throws FileError.
std::optional<RunOutcome> run_to_file(const Job& job);

/// Prints the outcome of a run, and returns the exit code of the command.
int report_outcome(const Job& job, const std::string& study_path, const RunOutcome& outcome);

/// Advice to a user whose result is not good enough.
struct Remedies {
  std::string limits;    ///< what to do if a limit is not met
  std::string failures;  ///< what to do if too many samples failed
};

/// Says each note as a warning on the study.
void warn_each(const std::string& study_path, std::span<const std::string> notes);

/// Judges a result, and returns the exit code of the command. Prints PASS or FAIL for each limit. Messages on stderr
/// name the limits that are not met, with the values found, and say if more samples failed than the study allows. In
/// the latter case the exit code is that for failed samples, because no verdict on a limit can be trusted. study_path:
/// path of the study.
ExitCode judge(const Study& study, const SolveCounts& solves, const StoredResult& result, const std::string& study_path,
               const Remedies& remedies);

/// An amount of memory in words: "about 250 MB", or "less than 1 MB".
std::string memory_text(std::size_t bytes);

/// Makes the error that says that there is not enough memory. path: path of the result. work: what was being done,
/// "this run". needed: the memory that the work needs, as memory_text() gives it.
FileError too_little_memory(const std::string& path, const std::string& work, const std::string& needed);

/// Warns on stderr of what looks like a mistake in the mechanism (mechanism_doubts()).
void warn_of_mechanism(const Study& study, const Model& model);

/// What looks like a mistake, one line each: in the mechanism, in the sizes of drawn errors (size_doubts()), in zones
/// that are not used (zones_doubt()), in poses with a singular pose between them (sides_doubt()), in the numbers of the
/// tables that the study names and the ranges of coordinates in which it seeks poses (doubts_of()), and in limits on
/// points far from those for which the correction of the actuators is best (correction_doubt()).
std::vector<std::string> all_doubts(const Study& study, const Model& model, const SelectedPoses& poses);

/// Notes on the study, one line each: how its machines are calibrated, which errors are constant, which are left out,
/// and the note of the kind of study (StudyKind::note).
std::vector<std::string> study_notes(const Study& study);

/// Reads a result file. Warns on stderr if the file was changed after it was written. Throws FileError.
StoredResult read_result_with_warning(const std::string& path);

}  // namespace poesy::app
