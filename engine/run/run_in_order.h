#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <memory>
#include <type_traits>
#include <vector>

#include "engine/run/result.h"
#include "engine/run/runner.h"

namespace poesy {

/// A job of a pool: the number of the work, and the slot for what it gives.
using SlotJob = std::function<void(std::size_t n, std::size_t slot)>;

/// Slots that run_in_slots uses: a few for each thread.
std::size_t pool_slots(const RunOptions& options);

/// Calls work(n, slot) for n = 0 .. count - 1 on a pool of threads, each with the work that make_work() gave it, and
/// finish(n, slot) in the order of n. A slot is not used again before it is finished. Returns false when stopped.
bool run_in_slots(std::size_t count, const RunOptions& options, const std::function<SlotJob()>& make_work,
                  const SlotJob& finish);

/// Calls work(worker, n) for n = 0 .. count - 1 on a pool of threads, each with its own worker, and finish(n, output)
/// in the order of n. A few outputs per thread are in flight at any time. Returns false when stopped.
template <class MakeWorker, class Work, class Finish>
bool run_in_order(std::size_t count, const RunOptions& options, MakeWorker make_worker, Work work, Finish finish) {
  using Worker = std::invoke_result_t<MakeWorker>;
  using Output = std::invoke_result_t<Work, Worker&, std::size_t>;
  std::vector<Output> outputs(pool_slots(options));
  const auto make_work = [&]() -> SlotJob {
    return [&, worker = std::make_shared<Worker>(make_worker())](std::size_t n, std::size_t slot) {
      outputs[slot] = work(*worker, n);
    };
  };
  return run_in_slots(count, options, make_work, [&](std::size_t n, std::size_t slot) { finish(n, outputs[slot]); });
}

/// Reports progress after each finished piece of work.
class ProgressCounter {
 public:
  /// before: how the solves of an earlier run ended that is continued.
  ProgressCounter(std::uint64_t total, const SolveCounts& before, const RunOptions& options) : options_(&options) {
    progress_ = {before.total(), total, before.not_converged(), before.total()};
  }

  /// So many solves are still to come, as far as is known now.
  void expect_left(std::uint64_t solves) { progress_.total = progress_.solves + solves; }

  void add(const SolveCounts& solves) {
    progress_.solves += solves.total();
    progress_.not_converged += solves.not_converged();
    if (options_->progress) options_->progress(progress_);
  }

 private:
  const RunOptions* options_;
  Progress progress_;
};

}  // namespace poesy
