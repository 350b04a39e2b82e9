#pragma once

#include <cstddef>
#include <span>

#include "engine/base/bytes.h"
#include "engine/run/result.h"

namespace poesy {

/// How far an evaluation is whose outcomes fill block by block, pose by pose: a block holds the outcomes of so many
/// samples at one pose, or of those that are left there. Reads nothing of blocks that were not added, so those may be
/// written meanwhile.
class EvaluationProgress {
 public:
  /// Refers to the result. Precondition: block_rows > 0.
  EvaluationProgress(EvaluationResult& result, std::size_t block_rows);

  /// The next block is filled.
  void add_block() { ++blocks_; }
  std::size_t blocks() const { return blocks_; }
  /// Over the blocks that were added.
  SolveCounts total() const;

  /// Outcomes of the blocks that were added.
  Bytes state() const;
  /// Fills in the outcomes of a state. Throws BytesError for one of an evaluation of another size.
  void restore(std::span<const std::byte> state);

 private:
  std::size_t blocks_in_all() const { return result_->poses * blocks_per_pose_; }
  /// Outcomes of the blocks that were added, which are the first of [M x S].
  std::size_t outcomes() const;

  EvaluationResult* result_;
  std::size_t block_rows_;
  std::size_t blocks_per_pose_;
  std::size_t blocks_ = 0;
};

}  // namespace poesy
