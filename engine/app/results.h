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

/// The facts about a run that has just ended on this machine. wall_seconds: its duration, s.
RunFacts run_facts(double wall_seconds, std::size_t threads, std::uint64_t solves);

/// Options of the search for poses.
struct SearchOptions {
  bool quiet = false;  ///< true if no progress is shown on stderr
  /// Flag that stops the search soon if it is set from outside; may be null.
  const std::atomic<bool>* stop = nullptr;
};

/// Finds the poses that the study selects, with progress on stderr. None if the search was stopped. Throws InputError
/// as select_poses() does.
std::optional<SelectedPoses> find_poses(const Study& study, const Model& model, const SearchOptions& options);

/// The paths of the study file and of the files that it names.
std::vector<std::string> inputs_of(const std::string& study_path, const Study& study);

/// A study that is ready to run, with its model and poses.
struct Job {
  const Study& study;
  const Model& model;
  SelectedPoses poses;
  std::string path;    ///< path of the result
  RunOptions options;  ///< options of the run, with its checkpoints
  /// Gives the time of the run so far, including that of the earlier runs that it continues.
  std::function<RunTime()> time;
  std::size_t threads;  ///< number of threads of all ranks together
  std::size_t ranks = 1;

  Checkpoints& checkpoints() const { return *options.checkpoints; }
};

/// The outcome of a run: how its solves ended, how long it took, including the earlier runs that it continues, and the
/// verdicts on limits.
struct RunOutcome {
  SolveCounts solves;
  RunFacts facts;
  std::optional<LimitVerdicts> verdicts = std::nullopt;
  std::vector<std::string> row_names = {};  ///< names of the rows of errors that verdicts refer to
  std::string confirming = {};              ///< path of a study that confirms the result; empty if there is none
};

/// Checks the files of the study that confirms a result, which a run may write into the folder of the result. Throws
/// InputError if this study, or a file that it names, would replace one of the inputs or a file that does not belong to
/// such a study of an earlier run.
void check_files_beside(const std::string& result, std::span<const std::string> inputs);

/// Runs a study of any kind, or a shard of it, and writes its result. With several ranks, rank 0 writes it. None if the
/// run was interrupted. Throws FileError.
std::optional<RunOutcome> run_to_file(const Job& job);

/// Prints the outcome of a run, and returns the exit code.
int report_outcome(const Job& job, const std::string& study_path, const RunOutcome& outcome);

/// Advice to a user whose result is not good enough.
struct Remedies {
  std::string limits;    ///< what to do if a limit is not met
  std::string failures;  ///< what to do if too many samples failed
};

/// Judges a result, and returns the exit code of the command. Prints PASS or FAIL for each limit. Writes to stderr
/// which limits are not met, with the values found. If more samples failed than the study allows, the message on stderr
/// says so first, because then no limit can be trusted. study_path: path of the study.
ExitCode judge(const Study& study, const SolveCounts& solves, const StoredResult& result, const std::string& study_path,
               const Remedies& remedies);

/// An amount of memory in words: "about 250 MB", or "less than 1 MB".
std::string memory_text(std::size_t bytes);

/// Makes the error that work needs more memory than there is. path: path of the result. work: what was being done,
/// "this run". needed: the memory that it needs, see memory_text().
FileError too_little_memory(const std::string& path, const std::string& work, const std::string& needed);

/// Reads a result file. Warns on stderr if the file was changed after it was written. Throws FileError.
StoredResult read_result_with_warning(const std::string& path);

}  // namespace poesy::app
