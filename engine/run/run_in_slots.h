#pragma once

#include <cstddef>
#include <functional>
#include <optional>

#include "engine/base/archive.h"
#include "engine/run/run_options.h"

namespace poesy {

/// A function that a pool of threads calls for each piece of work. n: number of the piece. slot: place for its output.
using SlotJob = std::function<void(std::size_t n, std::size_t slot)>;

/// Returns true if the run must stop soon.
inline bool stopped(const RunOptions& options) {
  return options.stop != nullptr && options.stop->load(std::memory_order_relaxed);
}

/// The number of a piece of work, and a free place (slot) for its output.
struct Ticket {
  std::size_t n;     ///< number of the piece of work
  std::size_t slot;  ///< place for its output
};

/// A function that returns one ticket after another, and none after the last. It is never called from two threads at
/// once.
using TicketSource = std::function<std::optional<Ticket>()>;

/// The number of places for outputs (slots) that run_in_slots() uses: a few for each thread.
std::size_t pool_slots(const RunOptions& options);

/// Takes each ticket (n, slot) of the source, and calls work(n, slot) on a pool of threads. Each thread has its own
/// function `work`, which make_work() returned. Calls finish(n, slot) in the order of the source. At most pool_slots()
/// tickets are in progress.
void run_in_slots(const TicketSource& source, const RunOptions& options, const std::function<SlotJob()>& make_work,
                  const SlotJob& finish);

/// The functions that do the pieces of a stage. The caller owns a place (slot) for the output of each piece in
/// progress.
struct SlotWork {
  std::function<SlotJob()> make_work;  ///< makes a function that does pieces of work, see run_in_slots()
  SlotJob finish;                      ///< merges an output: called on rank 0 in the order of n; then the slot is free
  /// Writes the output of piece n from its slot as a message to rank 0, or reads such a message into an empty slot.
  std::function<void(std::size_t n, std::size_t slot, Archive& archive)> state;
};

/// Calls work(n, slot) and finish(n, slot) for each piece n = 0 .. count - 1 in this process alone, with pool_slots()
/// places for outputs. Returns false if the run was stopped.
bool run_alone(std::size_t count, const RunOptions& options, const SlotWork& work);

/// The number of places for outputs (slots) that run_over_ranks() uses on this rank.
std::size_t rank_slots(const RunOptions& options);

/// Runs one stage on all ranks of options.team: work(n, slot) for each piece n = 0 .. count - 1 on any rank, and
/// finish(n, slot) on rank 0 in the order of n. Rank 0 hands out ranges of pieces as outputs return, and works on some
/// of them itself. The calling thread exchanges messages and calls finish(), while a pool of threads works. On the
/// other ranks the function returns when rank 0 has ended the stage. Returns true if the stage is complete; it is not
/// if the run was stopped or a rank has left. Throws the exceptions of the work on this rank, and Dismissed.
bool run_over_ranks(std::size_t count, const RunOptions& options, const SlotWork& work);

}  // namespace poesy
