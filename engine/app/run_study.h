#pragma once

#include <optional>
#include <string>

#include "engine/app/resumable.h"
#include "engine/run/result.h"
#include "engine/run/runner.h"
#include "engine/study/study.h"

namespace poesy::app {

/// A study that is ready to run.
struct Job {
  const Study& study;
  const Model& model;
  SelectedPoses poses;
  std::string path;  ///< of the result
  RunOptions options;
  const ResumableRun* kept;  ///< null on the ranks that write no result
};

/// How a study's solves ended, and what they took, in all parts of the run.
struct Ended {
  SolveCounts solves;
  RunFacts facts;
};

/// Runs a study of any kind and writes its result; on ranks after rank 0 that is left out. Empty when it was
/// interrupted. Throws FileError.
std::optional<Ended> run_study(const Job& job);

}  // namespace poesy::app
