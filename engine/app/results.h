#pragma once

#include <atomic>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <optional>
#include <string>

#include "engine/app/terminal.h"
#include "engine/base/error.h"
#include "engine/result/result_file.h"
#include "engine/run/result.h"
#include "engine/run/run_options.h"
#include "engine/storage/checkpoint.h"
#include "engine/study/study.h"

namespace poesy::app {

/// Facts about a run that has just ended, on this machine.
RunFacts run_facts(double wall_seconds, std::size_t threads, std::uint64_t solves);

/// How poses are searched.
struct SearchOptions {
  bool quiet = false;                       ///< no progress on stderr
  const std::atomic<bool>* stop = nullptr;  ///< set from outside to stop the search soon; may be null
};

/// The poses that the study selects, with progress on stderr; none if the search was stopped. Throws InputError as
/// select_poses() does.
std::optional<SelectedPoses> find_poses(const Study& study, const Model& model, const SearchOptions& options);

/// A study that is ready to run.
struct Job {
  const Study& study;
  const Model& model;
  SelectedPoses poses;
  std::string path;               ///< path of the result
  RunOptions options;             ///< options with checkpoints
  std::function<RunTime()> time;  ///< the time of all parts of the run so far
  std::size_t threads;            ///< threads of all ranks together
  std::size_t ranks = 1;

  Checkpoints& checkpoints() const { return *options.checkpoints; }
};

/// The outcome of a run: how solves ended, the time of all its parts, and verdicts on the limits.
struct RunOutcome {
  SolveCounts solves;
  RunFacts facts;
  std::optional<LimitVerdicts> verdicts = std::nullopt;
  std::vector<std::string> row_names = {};  ///< names of rows of errors in a verdict
  std::string confirming = {};              ///< path of the study that confirms the result; empty if there is none
};

/// A run may write a study that confirms its result beside it. Throws InputError if this study, or a file that it
/// names, would replace one of the inputs, or a file that is not of an earlier such study.
void check_files_beside(const std::string& result, std::span<const std::string> inputs);

/// Runs a study of any kind, or a shard of it, and writes its result; with several ranks on rank 0. Empty if it was
/// interrupted. Throws FileError.
std::optional<RunOutcome> run_to_file(const Job& job);

/// Prints the outcome and returns the exit code.
int report_outcome(const Job& job, const std::string& study_path, const RunOutcome& outcome);

/// Advice for a result that is not good enough.
struct Remedies {
  std::string limits;    ///< advice if a limit is not kept
  std::string failures;  ///< advice if too many samples failed
};

/// Returns the exit code of a finished command. Prints PASS or FAIL for each limit of the result. Names on stderr the
/// limits that are not kept, with the values found. If more samples failed than the study allows, it says this first,
/// because no limit can then be trusted. study_path: path of the study.
ExitCode judge(const Study& study, const SolveCounts& solves, const StoredResult& result, const std::string& study_path,
               const Remedies& remedies);

/// The part of a study's result that judge() needs.
StoredResult with_verdicts(const Study& study, const SelectedPoses& poses, const std::optional<LimitVerdicts>& verdicts,
                           const std::vector<std::string>& row_names);

/// "about 250 MB", or "less than 1 MB".
std::string memory_text(std::size_t bytes);

/// The error for work ("this run") that needs more memory than there is. needed: see memory_text(). path: of the
/// result.
FileError too_little_memory(const std::string& path, const std::string& work, const std::string& needed);

/// Reads a result, and warns on stderr if it was changed after it was written. Throws FileError.
StoredResult read_result_with_warning(const std::string& path);

}  // namespace poesy::app
