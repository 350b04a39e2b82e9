#pragma once

#include <cstddef>
#include <functional>
#include <optional>

#include "engine/base/archive.h"
#include "engine/run/run_options.h"

namespace poesy {

/// A job of a pool. n: the number of the work; slot: the place for its output.
using SlotJob = std::function<void(std::size_t n, std::size_t slot)>;

/// Whether the run is to stop.
inline bool stopped(const RunOptions& options) {
  return options.stop != nullptr && options.stop->load(std::memory_order_relaxed);
}

/// A number to work on, and a free slot for its output.
struct Ticket {
  std::size_t n;     ///< which piece of work
  std::size_t slot;  ///< where its output is kept
};

/// Returns one number after another, then nothing. Never called from two threads at once.
using TicketSource = std::function<std::optional<Ticket>()>;

/// The number of slots that run_in_slots() uses: a few for each thread.
std::size_t pool_slots(const RunOptions& options);

/// Calls work(n, slot) for the numbers of the source on a pool of threads; each thread has the work that make_work()
/// returned for it. Calls finish(n, slot) in the order of the source. At most pool_slots() numbers are in progress.
void run_in_slots(const TicketSource& source, const RunOptions& options, const std::function<SlotJob()>& make_work,
                  const SlotJob& finish);

/// The functions of a stage for its numbers. Outputs are kept in slots that the caller owns.
struct SlotWork {
  std::function<SlotJob()> make_work;  ///< see run_in_slots()
  SlotJob finish;                      ///< on rank 0, in the order of n; afterwards the slot is free
  /// Reads or writes the output of piece n in its slot, as ranks send it. The slot is empty before reading.
  std::function<void(std::size_t n, std::size_t slot, Archive& archive)> state;
};

/// Calls work(n, slot) and finish(n, slot) for n = 0 .. count - 1 in this process alone, with pool_slots() slots.
/// Returns false when stopped.
bool run_alone(std::size_t count, const RunOptions& options, const SlotWork& work);

/// The number of slots that run_over_ranks() uses on this rank.
std::size_t rank_slots(const RunOptions& options);

/// Runs one stage on all ranks of options.team: work(n, slot) for n = 0 .. count - 1 on any rank, and finish(n, slot)
/// on rank 0 in the order of n. Rank 0 hands out ranges of numbers as outputs return, and works on some itself. The
/// calling thread sends, receives and finishes; another pool works. On the other ranks it returns when rank 0 has ended
/// the stage. Returns whether the stage is complete; on rank 0 it is not complete if a rank has left. Throws exceptions
/// of this rank, and Dismissed.
bool run_over_ranks(std::size_t count, const RunOptions& options, const SlotWork& work);

}  // namespace poesy
