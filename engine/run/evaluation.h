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

/// What a table of errors does at each pose, in SI units. When paired, a pose has one sample.
struct EvaluationResult {
  Array<double, axis::Response, axis::Pose, axis::Sample> response;  ///< of the model
  Array<double, axis::Pose, axis::Sample, axis::Component> detail;   ///< components of all details
  Array<SolveStatus, axis::Pose, axis::Sample> status;               ///< how each solve ended
  Array<std::uint32_t, axis::Pose, axis::Sample> iterations;         ///< that each took
  Array<double, axis::Pose, axis::Joint> joint_displacement;         ///< of the perfect mechanism
  std::optional<LimitVerdicts> verdicts;                             ///< where the study states limits

  std::size_t poses() const { return status.length<axis::Pose>(); }            ///< Of the table.
  std::size_t samples() const { return status.length<axis::Sample>(); }        ///< At each pose.
  std::size_t responses() const { return response.length<axis::Response>(); }  ///< Of the model.
  /// Over all poses and samples.
  SolveCounts total() const;
};

/// Solves every requested (pose, row). Empty when stopped.
std::optional<EvaluationResult> run_evaluation(const Model& model, const SolverOptions& solver, const PoseSet& poses,
                                               const ErrorTable& errors, Pairing pairing, const RunOptions& options,
                                               Outcomes outcomes = Outcomes::with_details);

/// Judges limits by an evaluation, row by row of its errors: a row (a case) is within a limit if its largest magnitude
/// over all its poses is, and every one of them counts (see counts()). A limit is kept if every row is within it.
LimitVerdicts judge_rows(std::span<const ResponseLimit> limits, const EvaluationResult& found, Pairing pairing,
                         NotConverged policy);

}  // namespace poesy
