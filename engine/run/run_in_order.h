#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <memory>
#include <type_traits>
#include <utility>
#include <vector>

#include "engine/run/ranks/run_over_ranks.h"
#include "engine/run/result.h"
#include "engine/run/run_in_slots.h"
#include "engine/run/run_options.h"

namespace poesy {

/// Calls work(worker, n) for n = 0 .. count - 1 on a pool of threads, each with its own worker, and finish(n, output)
/// in the order of n. A few outputs per thread are in flight at any time. Returns false when stopped. With a team, work
/// is done on all ranks, and finish called on rank 0 alone (run_over_ranks.h): pack(n, output, to) writes an output,
/// unpack(n, from) gives it back on rank 0.
template <class MakeWorker, class Work, class Finish, class Pack, class Unpack>
bool run_in_order(std::size_t count, const RunOptions& options, MakeWorker make_worker, Work work, Finish finish,
                  Pack pack, Unpack unpack) {
  using Worker = std::invoke_result_t<MakeWorker>;
  using Output = std::invoke_result_t<Work, Worker&, std::size_t>;
  std::vector<Output> outputs(options.team == nullptr ? pool_slots(options) : rank_slots(options));
  const auto make_work = [&]() -> SlotJob {
    return [&, worker = std::make_shared<Worker>(make_worker())](std::size_t n, std::size_t slot) {
      outputs[slot] = work(*worker, n);
    };
  };
  if (options.team == nullptr) {
    return run_counted(count, options, make_work, [&](std::size_t n, std::size_t slot) { finish(n, outputs[slot]); });
  }
  return run_over_ranks(
      count, options,
      {make_work, [&](std::size_t n, std::size_t slot) { finish(n, std::exchange(outputs[slot], Output{})); },
       [&](std::size_t n, std::size_t slot, ByteWriter& to) { pack(n, outputs[slot], to); },
       [&](std::size_t n, std::size_t slot, ByteReader& from) { outputs[slot] = unpack(n, from); }});
}

/// Reports progress after each finished piece of work.
class ProgressCounter {
 public:
  /// before: how the solves of an earlier run ended that is continued.
  ProgressCounter(const SolveCounts& before, const RunOptions& options)
      : options_(&options), progress_{before.total(), before.total(), before.not_converged(), before.total()} {}

  /// So many solves are still to come, as far as is known now.
  void expect_left(std::uint64_t solves) { progress_.total = progress_.solves + solves; }

  /// A finished piece of work.
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
