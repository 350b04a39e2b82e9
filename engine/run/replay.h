#pragma once

#include <cstdint>
#include <vector>

#include "engine/model/model.h"
#include "engine/run/evaluation.h"
#include "engine/study/study.h"

namespace poesy {

/// One sample, solved again.
struct ReplayedSample {
  std::vector<FactorIndex> varied;  ///< errors that the study varies together; the others have the background's value
  std::vector<double> values;       ///< [varied], SI
  std::vector<double> errors;       ///< [F] all errors of the sample, SI
  std::vector<double> responses;    ///< [R], SI; the last iterate where not converged
  SolveStatus status = SolveStatus::converged;  ///< status in the run's own solver
  std::uint32_t iterations = 0;                 ///< iterations of the run's own solver
};

/// Draws and solves the sample of this address, with the same bits as in a run of the study. slot: see Failure.
/// Precondition: a sensitivity or Monte Carlo study, and a model that reaches the pose.
ReplayedSample replay_sample(const Study& study, const Model& model, const PoseSet& poses, std::size_t slot,
                             PoseIndex pose, SampleIndex sample);

/// Solves one row of an error table at a pose of a list, with the same bits as run_evaluation().
ReplayedSample replay_row(const SolverOptions& solver, const Model& model, const PoseSet& poses, PoseIndex pose,
                          const ErrorTable& row);

}  // namespace poesy
