#pragma once

#include <functional>
#include <optional>
#include <string>

#include "engine/io/checkpoint.h"
#include "engine/run/result.h"
#include "engine/run/runner.h"
#include "engine/study/study.h"

namespace poesy::app {

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
  /// Whether this process writes what was found: of several ranks the first.
  bool writes() const { return options.team == nullptr || options.team->leads(); }
};

/// How a study's solves ended, what they took, in all parts of the run, and what became of its limits.
struct Ended {
  SolveCounts solves;
  RunFacts facts;
  std::optional<LimitVerdicts> verdicts = std::nullopt;
};

/// Runs a study of any kind, or a shard of it, and writes its result, on rank 0 if there are several. Empty when it was
/// interrupted. Throws FileError.
std::optional<Ended> run_study(const Job& job);

/// Says what came out; the exit code.
int report_end(const Job& job, const std::string& study_path, const Ended& ended);

}  // namespace poesy::app
