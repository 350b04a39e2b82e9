#pragma once

#include <cstddef>
#include <span>

#include "engine/base/bytes.h"
#include "engine/run/evaluation.h"
#include "engine/run/result.h"
#include "engine/run/shard.h"

namespace poesy {

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
  Bytes state() const;
  /// Fills in the outcomes of a state, or of states that follow each other. Throws BytesError for one of an evaluation
  /// of another size.
  void restore(std::span<const std::byte> state);

 private:
  void restore_one(ByteReader& from);
  /// Outcomes from place to place + count of [M x S].
  void write_outcomes(std::size_t place, std::size_t count, ByteWriter& to) const;
  void read_outcomes(std::size_t place, std::size_t count, ByteReader& from);
  /// Outcomes in the blocks before this one: the first of [M x S].
  std::size_t outcomes(std::size_t block) const;

  EvaluationResult* result_;
  std::size_t block_rows_;
  std::size_t blocks_per_pose_;
  NumberRange blocks_;  ///< the shard's
  std::size_t next_;    ///< block to be added
};

}  // namespace poesy
