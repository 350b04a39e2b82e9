#pragma once

#include <cstddef>
#include <functional>
#include <optional>

#include "engine/base/archive.h"
#include "engine/run/run_options.h"

namespace poesy {

/// A job of a pool: the number of the work, and the slot for what it gives.
using SlotJob = std::function<void(std::size_t n, std::size_t slot)>;

/// Whether the run is to end soon.
inline bool stopped(const RunOptions& options) {
  return options.stop != nullptr && options.stop->load(std::memory_order_relaxed);
}

/// A number to work on, and the slot that is free for it.
struct Ticket {
  std::size_t n;     ///< which piece of work
  std::size_t slot;  ///< where its output is kept
};

/// Gives one number after another, then nothing. Never called from two threads at once.
using TicketSource = std::function<std::optional<Ticket>()>;

/// Slots that run_in_slots uses: a few for each thread.
std::size_t pool_slots(const RunOptions& options);

/// Calls work(n, slot) for the numbers of the source on a pool of threads, each with the work that make_work() gave it,
/// and finish(n, slot) in the order in which the source gave them. At most pool_slots() are under way.
void run_in_slots(const TicketSource& source, const RunOptions& options, const std::function<SlotJob()>& make_work,
                  const SlotJob& finish);

/// What is done with the numbers of a stage. Outputs are kept in slots of the caller's.
struct SlotWork {
  std::function<SlotJob()> make_work;  ///< as of run_in_slots
  SlotJob finish;                      ///< on rank 0, in the order of n; the slot's output is not needed afterwards
  /// The slot's output of piece n on its way between ranks. Where it is read, the slot is empty.
  std::function<void(std::size_t n, std::size_t slot, Archive& archive)> state;
};

/// work(n, slot) and finish(n, slot) for n = 0 .. count - 1, in this process alone, with pool_slots(). Returns false
/// when stopped.
bool run_alone(std::size_t count, const RunOptions& options, const SlotWork& work);

/// Slots that run_over_ranks uses on this rank.
std::size_t rank_slots(const RunOptions& options);

/// One stage on all ranks of options.team: work(n, slot) for n = 0 .. count - 1 on any rank, finish(n, slot) on rank 0
/// in the order of n. Rank 0 hands out ranges of numbers as outputs come back, and works on some itself. The calling
/// thread sends, receives and finishes; another pool works. Returns on the ranks after rank 0 when rank 0 has ended the
/// stage, and then everywhere whether it was complete; on rank 0 it is not when a rank has left. Throws what was thrown
/// on this rank, and Dismissed.
bool run_over_ranks(std::size_t count, const RunOptions& options, const SlotWork& work);

}  // namespace poesy
