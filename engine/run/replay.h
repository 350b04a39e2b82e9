#pragma once

#include <cstdint>
#include <vector>

#include "engine/model/model.h"
#include "engine/run/evaluation.h"
#include "engine/study/study.h"

namespace poesy {

/// One sample that was solved again, with its errors and responses.
struct ReplayedSample {
  /// Errors that this sample varies. Other errors are constant: those that the study does not vary have the values of
  /// its background, all others are zero. For a row of a table, all other errors are zero.
  std::vector<FactorIndex> varied;
  std::vector<double> values;     ///< [varied] values of these errors, SI
  std::vector<double> errors;     ///< [all errors] all errors of the sample, SI
  std::vector<double> responses;  ///< [responses] SI; those of the last iterate if the solve did not converge
  SolveStatus status = SolveStatus::converged;  ///< status of the solver that the run used
  std::uint32_t iterations = 0;                 ///< iterations of the solver that the run used
};

/// Draws and solves one sample of the study again, with the same bits as in a run. slot: index in the list of the
/// study's factors; 0 if all errors vary together. Precondition: a sensitivity or Monte Carlo study, and a model that
/// reaches the pose.
ReplayedSample replay_sample(const Study& study, const Model& model, const PoseSet& poses, std::size_t slot,
                             PoseIndex pose, SampleIndex sample);

/// Solves one row of an error table at one of the poses, with the same bits as run_evaluation().
ReplayedSample replay_row(const SolverOptions& solver, const Model& model, const PoseSet& poses, PoseIndex pose,
                          const ErrorTable& row);

}  // namespace poesy
