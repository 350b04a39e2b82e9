#pragma once

#include <cstddef>
#include <functional>

#include "engine/base/bytes.h"
#include "engine/run/run_in_slots.h"
#include "engine/run/run_options.h"

namespace poesy {

/// What ranks do with the numbers of a stage. Outputs stand in slots of the caller's.
struct RankWork {
  std::function<SlotJob()> make_work;  ///< as of run_in_slots
  SlotJob finish;                      ///< on rank 0, in the order of n; the slot's output is not needed afterwards
  /// Writes a slot's output of piece n for another rank.
  std::function<void(std::size_t n, std::size_t slot, ByteWriter& to)> pack;
  std::function<void(std::size_t n, std::size_t slot, ByteReader& from)> unpack;  ///< and reads it there
};

/// Slots that run_over_ranks uses on this rank.
std::size_t rank_slots(const RunOptions& options);

/// One stage on all ranks of options.team: work(n, slot) for n = 0 .. count - 1 on any rank, finish(n, slot) on rank 0
/// in the order of n. Rank 0 hands out ranges of numbers as outputs come back, and works on some itself. The calling
/// thread sends, receives and finishes; another pool works. Returns on the ranks after rank 0 when rank 0 has ended the
/// stage, and then everywhere whether it was complete; on rank 0 it is not when a rank has left. Throws what was thrown
/// on this rank, and Dismissed.
bool run_over_ranks(std::size_t count, const RunOptions& options, const RankWork& work);

}  // namespace poesy
