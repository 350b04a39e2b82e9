#include "engine/run/run_in_slots.h"

#include <oneapi/tbb/enumerable_thread_specific.h>
#include <oneapi/tbb/global_control.h>
#include <oneapi/tbb/parallel_for.h>
#include <oneapi/tbb/parallel_pipeline.h>
#include <oneapi/tbb/task_arena.h>

#include <algorithm>
#include <atomic>
#include <chrono>
#include <thread>
#include <utility>

#include "engine/base/sanitizers.h"
#include "engine/run/threads.h"

#ifdef POESY_THREAD_SANITIZER
#include <sanitizer/tsan_interface.h>
#endif

namespace poesy {
namespace {

namespace tbb = oneapi::tbb;

namespace handover {

/// Tells ThreadSanitizer about an order of events that oneTBB guarantees and the sanitizer cannot see inside the
/// library: everything before a publish() happens before everything after a later receive(). Does nothing in other
/// builds.
#ifdef POESY_THREAD_SANITIZER
inline char place;
inline void publish() { __tsan_release(&place); }
inline void receive() { __tsan_acquire(&place); }
#else
inline void publish() {}
inline void receive() {}
#endif

/// Tells the sanitizer that all writes while one Block exists are visible to each Block that begins after its end. Code
/// with objects of oneTBB needs this, because their memory moves from thread to thread inside the allocator of oneTBB.
class Block {
 public:
  Block() { receive(); }
  ~Block() { publish(); }
  Block(const Block&) = delete;
  Block& operator=(const Block&) = delete;
};

/// The destructor tells the sanitizer that all earlier Blocks have ended. It does so whether the function with this
/// object returns or throws.
class Waiting {
 public:
  Waiting() = default;
  ~Waiting() { receive(); }
  Waiting(const Waiting&) = delete;
  Waiting& operator=(const Waiting&) = delete;
};

/// A function that oneTBB copies and calls on any of its threads. The thread sanitizer sees no order between
/// overlapping calls, so it still finds real races between them.
template <class Function>
class Task {
 public:
  /// A copy of the task copies the function.
  explicit Task(Function function) : function_(std::move(function)) {}
  /// A copy may run on another thread, where the writes of this thread must be visible.
  Task(const Task& other) : function_(other.function_) { publish(); }
  Task& operator=(const Task&) = delete;
  ~Task() = default;

  /// Calls the function while a Block exists.
  template <class... Arguments>
  decltype(auto) operator()(Arguments&&... arguments) const {
    const Block block;
    return function_(std::forward<Arguments>(arguments)...);
  }

 private:
  Function function_;
};

}  // namespace handover

/// An arena of oneTBB with `threads` threads.
struct Pool {
  explicit Pool(std::size_t threads)
      : limit(tbb::global_control::max_allowed_parallelism, threads),
        stack(tbb::global_control::thread_stack_size, kThreadStackBytes),
        arena(static_cast<int>(threads)) {}

  tbb::global_control limit;
  tbb::global_control stack;
  tbb::task_arena arena;
};

/// Makes oneTBB start its threads now, while there is memory for them. Waits until all threads have started, for at
/// most 20 ms.
#ifdef POESY_THREAD_SANITIZER
// Does nothing: the sanitizer would report races, because it does not see in which order oneTBB runs the tasks of
// parallel_for.
void start_workers(std::size_t /*threads*/) {}
#else
void start_workers(std::size_t threads) {
  constexpr std::chrono::milliseconds kLongest{20};
  Pool pool(threads);
  std::atomic<std::size_t> here{0};
  const auto end = std::chrono::steady_clock::now() + kLongest;
  const auto meet = [&](std::size_t) {
    ++here;
    while (here < threads && std::chrono::steady_clock::now() < end) std::this_thread::yield();
  };
  pool.arena.execute([&] { tbb::parallel_for(std::size_t{0}, threads, meet, tbb::simple_partitioner()); });
}
#endif

}  // namespace

std::size_t resolved_threads(std::size_t threads) {
  return threads != 0 ? threads : std::max<std::size_t>(1, std::thread::hardware_concurrency());
}

std::size_t pool_slots(const RunOptions& options) { return 4 * resolved_threads(options.threads); }

void start_threads(std::size_t threads) {
  static std::atomic<std::size_t> started{1};
  if (threads <= started) return;
  expect_threads(threads);
  start_workers(threads);
  started = threads;
}

void run_in_slots(const TicketSource& source, const RunOptions& options, const std::function<SlotJob()>& make_work,
                  const SlotJob& finish) {
  const handover::Block block;
  const std::size_t threads = resolved_threads(options.threads);
  start_threads(threads);
  Pool pool(threads);
  // The lambda refers to make_work instead of copying it: the copy would be in memory of oneTBB, which moves from
  // thread to thread.
  tbb::enumerable_thread_specific<SlotJob> works([&make_work] { return make_work(); });
  const handover::Task start([&](tbb::flow_control& control) -> Ticket {
    if (const auto ticket = source()) return *ticket;
    control.stop();
    return {};
  });
  const handover::Task work([&](Ticket ticket) {
    works.local()(ticket.n, ticket.slot);
    return ticket;
  });
  const handover::Task collect([&](Ticket ticket) { finish(ticket.n, ticket.slot); });
  const handover::Waiting for_all;
  pool.arena.execute([&] {
    tbb::parallel_pipeline(pool_slots(options),
                           tbb::make_filter<void, Ticket>(tbb::filter_mode::serial_in_order, start) &
                               tbb::make_filter<Ticket, Ticket>(tbb::filter_mode::parallel, work) &
                               tbb::make_filter<Ticket, void>(tbb::filter_mode::serial_in_order, collect));
  });
}

bool run_alone(std::size_t count, const RunOptions& options, const SlotWork& work) {
  // The pipeline finishes pieces in order, and at most `slots` pieces are in progress, so no two of them share a slot
  // (place for an output).
  const std::size_t slots = pool_slots(options);
  std::size_t next = 0;
  std::size_t finished = 0;
  const auto source = [&]() -> std::optional<Ticket> {
    if (next == count || stopped(options)) return std::nullopt;
    const std::size_t n = next++;
    return Ticket{n, n % slots};
  };
  run_in_slots(source, options, work.make_work, [&](std::size_t n, std::size_t slot) {
    work.finish(n, slot);
    ++finished;
  });
  return finished == count;
}

}  // namespace poesy
