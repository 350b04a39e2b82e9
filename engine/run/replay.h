#pragma once

#include <cstdint>
#include <vector>

#include "engine/model/model.h"
#include "engine/run/evaluation.h"
#include "engine/study/study.h"

namespace poesy {

/// One sample that was solved again, with its errors and responses.
struct ReplayedSample {
  /// Errors that vary in this sample. All other errors are 0, except those that the study holds at a constant value
  /// (Plan::background()).
  std::vector<FactorIndex> varied;
  std::vector<double> values;     ///< [varied] values of the varied errors, SI
  std::vector<double> errors;     ///< [all errors] all errors of the sample, SI
  std::vector<double> responses;  ///< [responses] responses, SI; of the last iterate if the solve did not converge
  SolveStatus status = SolveStatus::converged;  ///< how the solve ended
  std::uint32_t iterations = 0;                 ///< number of iterations of the solve
};

/// Draws and solves one sample of a study again. The numbers have the same bits as in a run of the study. slot: index
/// in the list of the study's factors; 0 if all errors vary together. Preconditions: it is a sensitivity or Monte Carlo
/// study, and the model reaches the pose.
ReplayedSample replay_sample(const Study& study, const Model& model, const PoseSet& poses, std::size_t slot,
                             PoseIndex pose, SampleIndex sample);

/// Solves a table with one row of errors at one of the poses. The numbers have the same bits as those of
/// run_evaluation().
ReplayedSample replay_row(const SolverOptions& solver, const Model& model, const PoseSet& poses, PoseIndex pose,
                          const ErrorTable& row);

}  // namespace poesy
