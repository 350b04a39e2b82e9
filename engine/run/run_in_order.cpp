#include "engine/run/run_in_order.h"

#include <oneapi/tbb/enumerable_thread_specific.h>
#include <oneapi/tbb/global_control.h>
#include <oneapi/tbb/parallel_pipeline.h>
#include <oneapi/tbb/task_arena.h>

#include "engine/run/handover.h"

namespace poesy {
namespace {

namespace tbb = oneapi::tbb;

bool stopped(const RunOptions& options) {
  return options.stop != nullptr && options.stop->load(std::memory_order_relaxed);
}

}  // namespace

std::size_t pool_slots(const RunOptions& options) { return 4 * resolved_threads(options.threads); }

bool run_in_slots(std::size_t count, const RunOptions& options, const std::function<SlotJob()>& make_work,
                  const SlotJob& finish) {
  const std::size_t threads = resolved_threads(options.threads);
  // The pipeline finishes in order with at most in_flight numbers under way, so no two of those share a slot.
  const std::size_t in_flight = pool_slots(options);
  const tbb::global_control limit(tbb::global_control::max_allowed_parallelism, threads);
  tbb::task_arena arena(static_cast<int>(threads));
  tbb::enumerable_thread_specific<SlotJob> works(make_work);
  std::size_t next = 0;
  std::size_t finished = 0;
  const handover::Task start([&](tbb::flow_control& control) -> std::size_t {
    if (next == count || stopped(options)) {
      control.stop();
      return 0;
    }
    return next++;
  });
  const handover::Task work([&](std::size_t n) {
    works.local()(n, n % in_flight);
    return n;
  });
  const handover::Task collect([&](std::size_t n) {
    finish(n, n % in_flight);
    ++finished;
  });
  arena.execute([&] {
    tbb::parallel_pipeline(in_flight,
                           tbb::make_filter<void, std::size_t>(tbb::filter_mode::serial_in_order, start) &
                               tbb::make_filter<std::size_t, std::size_t>(tbb::filter_mode::parallel, work) &
                               tbb::make_filter<std::size_t, void>(tbb::filter_mode::serial_in_order, collect));
  });
  handover::receive();
  return finished == count;
}

}  // namespace poesy
