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
  /// The outcomes of any block that is filled, added or not.
  void write_block(std::size_t block, ByteWriter& to) const;
  /// Fills a block that was not added; how its solves ended. Throws BytesError.
  SolveCounts read_block(std::size_t block, ByteReader& from);
  /// Over the blocks that were added.
  SolveCounts total() const;

  /// Outcomes of the blocks that were added.
  Bytes state() const;
  /// Fills in the outcomes of a state. Throws BytesError for one of an evaluation of another size.
  void restore(std::span<const std::byte> state);

 private:
  /// Outcomes from place to place + count of [M x S].
  void write_outcomes(std::size_t place, std::size_t count, ByteWriter& to) const;
  void read_outcomes(std::size_t place, std::size_t count, ByteReader& from);
  std::size_t blocks_in_all() const { return result_->poses * blocks_per_pose_; }
  /// Outcomes of the first so many blocks, which are the first of [M x S].
  std::size_t outcomes(std::size_t blocks) const;

  EvaluationResult* result_;
  std::size_t block_rows_;
  std::size_t blocks_per_pose_;
  std::size_t blocks_ = 0;
};

}  // namespace poesy
