#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "engine/model/model.h"
#include "engine/run/result.h"
#include "engine/run/run_options.h"
#include "engine/study/error_table.h"

namespace poesy {

/// How poses and rows of errors belong together.
enum class Pairing {
  every_pose_with_every_row,
  row_by_row  ///< pose m with row m; equal numbers of both
};

/// How much of what the model gives is kept.
enum class Outcomes {
  with_details,  ///< everything the model gives
  responses      ///< without details, which take most of the memory
};

/// What a table of errors does at M poses, S samples each (S = 1 when paired): SI.
struct EvaluationResult {
  std::size_t poses = 0;      ///< M
  std::size_t samples = 0;    ///< S
  std::size_t responses = 0;  ///< R
  std::size_t details = 0;    ///< D, components of all details

  std::vector<double> response;            ///< [R x M x S]
  std::vector<double> detail;              ///< [M x S x D]
  std::vector<SolveStatus> status;         ///< [M x S]
  std::vector<std::uint32_t> iterations;   ///< [M x S]
  std::vector<double> joint_displacement;  ///< [M x joints], nominal
  std::optional<LimitVerdicts> verdicts;   ///< where the study states limits

  /// Over all poses and samples.
  SolveCounts total() const;
};

/// Solves every requested (pose, row). Empty when stopped.
std::optional<EvaluationResult> run_evaluation(const Model& model, const SolverOptions& solver, const PoseSet& poses,
                                               const ErrorTable& errors, Pairing pairing, const RunOptions& options,
                                               Outcomes outcomes = Outcomes::with_details);

}  // namespace poesy
