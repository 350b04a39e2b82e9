#pragma once

#include <atomic>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <optional>

#include "engine/run/checkpoints.h"
#include "engine/run/ranks/team.h"
#include "engine/run/shard.h"

namespace poesy {

/// The progress of a run, in samples.
struct Progress {
  std::uint64_t solves = 0;  ///< samples that are done, including those of the earlier run that this run continues
  std::uint64_t total = 0;   ///< expected number of all samples
  std::uint64_t not_converged = 0;  ///< samples that are done but whose solves did not converge
  std::uint64_t before = 0;         ///< samples of the earlier run that this run continues
};

/// How a run is done. No option changes the content of a result file.
struct RunOptions {
  std::size_t threads = 0;  ///< number of threads; 0: one per processor
  /// A function that shows the progress. It is called from time to time, never from two threads at once. May be empty.
  std::function<void(const Progress&)> progress = {};
  /// A flag that another thread or a signal handler sets to stop the run soon. May be null.
  const std::atomic<bool>* stop = nullptr;
  /// Where the run gets its earlier state and saves its state; may be null. If another program or study wrote the
  /// earlier state, the run throws BytesError.
  Checkpoints* checkpoints = nullptr;
  /// The shard to run instead of the whole study. Its run returns no result: its state is in `checkpoints`.
  std::optional<Shard> shard = std::nullopt;
  /// True if a longer study may continue from the last checkpoint. A study that draws all errors together then keeps
  /// more data.
  bool keep_checkpoint = true;
  /// True if a study of machines records for each machine whether it is rejected (StudyResult::rejected).
  bool keep_rejected = false;
  /// The ranks that share the work; null: this process alone. Every rank calls the same run functions with the same
  /// arguments and gets the same results; only rank 0 has checkpoints and reports progress. If a rank is stopped or
  /// leaves, the functions return nothing, and team->left() says why. Functions on ranks other than rank 0 may throw
  /// Dismissed.
  Team* team = nullptr;
};

/// The number of threads to use: `threads`, or the number of processors if that is 0.
std::size_t resolved_threads(std::size_t threads);

/// Starts threads of the pool until it has `threads` of them. Call this function early, while there is memory and no
/// result to lose, because oneTBB ends the program if it cannot start a thread. Throws FileError if this process cannot
/// have so many threads.
void start_threads(std::size_t threads);

}  // namespace poesy
