#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "engine/base/array.h"
#include "engine/model/model.h"
#include "engine/run/result.h"
#include "engine/run/run_options.h"
#include "engine/study/table_file.h"

namespace poesy {

/// How poses and rows of errors are paired.
enum class Pairing {
  every_pose_with_every_row,
  row_by_row  ///< only pose m with row m of the table, which has as many rows as there are poses
};

/// Which outputs of the model are kept.
enum class Outcomes {
  with_details,  ///< all outputs
  responses      ///< all outputs except the additional ones (Detail), which would take most of the memory
};

/// The outcomes of each row of a table of errors at each pose, SI. A sample is a row of the table. With
/// Pairing::row_by_row, each pose has one sample.
struct EvaluationResult {
  Array<double, axis::Response, axis::Pose, axis::Sample> response;  ///< responses of the model
  /// Components of the model's additional outputs (Detail in model/model.h).
  Array<double, axis::Pose, axis::Sample, axis::Component> detail;
  Array<SolveStatus, axis::Pose, axis::Sample> status;        ///< how each solve ended
  Array<std::uint32_t, axis::Pose, axis::Sample> iterations;  ///< number of iterations of each solve
  Array<double, axis::Pose, axis::Joint> joint_displacement;  ///< nominal displacements of the joints (m, rad)
  std::optional<LimitVerdicts> verdicts;                      ///< set if the study states limits

  std::size_t poses() const { return status.length<axis::Pose>(); }            ///< The number of poses.
  std::size_t samples() const { return status.length<axis::Sample>(); }        ///< The number of samples at each pose.
  std::size_t responses() const { return response.length<axis::Response>(); }  ///< The number of responses.
  /// How the solves at all poses ended.
  SolveCounts total() const;
};

/// Solves every pair of a pose and a row of errors that `pairing` asks for. Empty if the run was stopped.
std::optional<EvaluationResult> run_evaluation(const Model& model, const SolverOptions& solver, const PoseSet& poses,
                                               const ErrorTable& errors, Pairing pairing, const RunOptions& options,
                                               Outcomes outcomes = Outcomes::with_details);

/// Compares an evaluation with the limits, row by row. Each row of errors is a machine. The row is within a limit if
/// the limit allows the deciding number of the row (ValueLimit::deciding), and if the solves of the row at all its
/// poses count in statistics (counts()). A limit is kept if every row is within it. Precondition: with
/// Pairing::row_by_row, no limit is on the values at several poses together (ValueLimit::is_over_poses).
LimitVerdicts judge_rows(std::span<const ResponseLimit> limits, const EvaluationResult& found, Pairing pairing,
                         NotConverged policy);

}  // namespace poesy
