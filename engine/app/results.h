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

/// How poses are looked for.
struct SearchOptions {
  bool quiet = false;                       ///< without progress
  const std::atomic<bool>* stop = nullptr;  ///< set by somebody else to stop the search soon; may be null
};

/// The poses that the study selects, with progress on stderr; none where the search was stopped. Throws InputError as
/// select_poses().
std::optional<SelectedPoses> find_poses(const Study& study, const Model& model, const SearchOptions& options);

/// A study that is ready to run.
struct Job {
  const Study& study;
  const Model& model;
  SelectedPoses poses;
  std::string path;               ///< of the result
  RunOptions options;             ///< with checkpoints
  std::function<RunTime()> time;  ///< that the run took so far, in all its parts
  std::size_t threads;            ///< of all ranks together
  std::size_t ranks = 1;

  Checkpoints& checkpoints() const { return *options.checkpoints; }
};

/// How a study's solves ended, what they took, in all parts of the run, and what became of its limits.
struct RunOutcome {
  SolveCounts solves;
  RunFacts facts;
  std::optional<LimitVerdicts> verdicts = std::nullopt;
  std::vector<std::string> row_names = {};  ///< of which a verdict may speak
  std::string confirming = {};              ///< path of the study that confirms the result; empty: there is none
};

/// Throws InputError where the study that a run writes beside its result, to confirm it, or a file that it names would
/// replace one of the inputs, or a file that is not of an earlier such study.
void check_files_beside(const std::string& result, std::span<const std::string> inputs);

/// Runs a study of any kind, or a shard of it, and writes its result, on rank 0 if there are several. Empty when it was
/// interrupted. Throws FileError.
std::optional<RunOutcome> run_to_file(const Job& job);

/// Says what came out; the exit code.
int report_outcome(const Job& job, const std::string& study_path, const RunOutcome& outcome);

/// Where a user is told to look when a result is not good enough.
struct Remedies {
  std::string limits;    ///< where a limit is not kept
  std::string failures;  ///< where too many samples failed
};

/// The exit code of a command that is done. Prints PASS or FAIL for each limit of the result. Says on stderr which
/// limits are not kept, with the values found, and whether more samples failed than the study allows, which goes first
/// because no limit can be trusted then. study_path names the study.
ExitCode judge(const Study& study, const SolveCounts& solves, const StoredResult& result, const std::string& study_path,
               const Remedies& remedies);

/// As much of a study's result as judge() needs.
StoredResult with_verdicts(const Study& study, const SelectedPoses& poses, const std::optional<LimitVerdicts>& verdicts,
                           const std::vector<std::string>& row_names);

/// "about 250 MB", or "less than 1 MB".
std::string memory_text(std::size_t bytes);

/// Memory was too little for this work ("this run"), which needs this much, a memory_text(). path names its result.
FileError too_little_memory(const std::string& path, const std::string& work, const std::string& needed);

/// Reads a result, and warns on stderr where it was changed since it was written. Throws FileError.
StoredResult read_result_with_warning(const std::string& path);

}  // namespace poesy::app
