#pragma once

#include <cstddef>
#include <functional>
#include <optional>

#include "engine/run/run_options.h"

namespace poesy {

/// A job of a pool: the number of the work, and the slot for what it gives.
using SlotJob = std::function<void(std::size_t n, std::size_t slot)>;

/// Whether the run is to end soon.
inline bool stopped(const RunOptions& options) {
  return options.stop != nullptr && options.stop->load(std::memory_order_relaxed);
}

/// Slots that run_in_slots uses: a few for each thread.
std::size_t pool_slots(const RunOptions& options);

/// A number to work on, and the slot that is free for it.
struct Ticket {
  std::size_t n;     ///< which piece of work
  std::size_t slot;  ///< where its output stands
};

/// Gives one number after another, then nothing. Never called from two threads at once.
using TicketSource = std::function<std::optional<Ticket>()>;

/// Calls work(n, slot) for the numbers of the source on a pool of threads, each with the work that make_work() gave it,
/// and finish(n, slot) in the order in which the source gave them. At most pool_slots() are under way.
void run_in_slots(const TicketSource& source, const RunOptions& options, const std::function<SlotJob()>& make_work,
                  const SlotJob& finish);

/// run_in_slots for n = 0 .. count - 1, in this process alone. Returns false when stopped.
bool run_counted(std::size_t count, const RunOptions& options, const std::function<SlotJob()>& make_work,
                 const SlotJob& finish);

}  // namespace poesy
