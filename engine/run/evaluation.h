#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "engine/base/array.h"
#include "engine/base/bytes.h"
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

/// How far an evaluation is whose outcomes fill block by block, pose by pose: a block holds the outcomes of so many
/// samples at one pose, or of those that are left there. Of all blocks of the result it takes those of one shard. Reads
/// nothing of blocks that were not added, so those may be written meanwhile.
class EvaluationProgress {
 public:
  /// Refers to the result. Precondition: block_rows > 0.
  EvaluationProgress(EvaluationResult& result, std::size_t block_rows, const Shard& shard);

  /// The next block is filled.
  void add_block() { ++next_; }
  /// Blocks that are still to be filled, in order.
  NumberRange pending() const { return {next_, blocks_.end}; }
  /// Samples of the shard's blocks, filled or not.
  std::size_t samples() const { return outcomes(blocks_.end) - outcomes(blocks_.first); }
  /// The outcomes of any block that is filled, added or not.
  void write_block(std::size_t block, ByteWriter& to) const;
  /// Fills a block that was not added; how its solves ended. Throws BytesError.
  SolveCounts read_block(std::size_t block, ByteReader& from);
  /// Over the blocks that were added.
  SolveCounts total() const;

  /// Outcomes of the blocks that were added.
  void write_state(ByteWriter& to) const;
  /// Fills in the outcomes of a state, or of states that follow each other. Throws BytesError for one of an evaluation
  /// of another size.
  void restore(std::span<const std::byte> state);

 private:
  void restore_one(ByteReader& from);
  /// What a state begins with, before the blocks.
  std::array<std::uint64_t, 6> sizes() const;
  /// Outcomes first .. end - 1, counted pose by pose.
  void write_outcomes(std::size_t first, std::size_t end, ByteWriter& to) const;
  void read_outcomes(std::size_t first, std::size_t end, ByteReader& from);
  /// Outcomes in the blocks before this one.
  std::size_t outcomes(std::size_t block) const;

  EvaluationResult* result_;
  std::size_t block_rows_;
  std::size_t blocks_per_pose_;
  NumberRange blocks_;  ///< the shard's
  std::size_t next_;    ///< block to be added
};

}  // namespace poesy
