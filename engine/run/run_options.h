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

/// How far a run is, in samples.
struct Progress {
  std::uint64_t solves = 0;         ///< done, with those of an earlier run that is continued
  std::uint64_t total = 0;          ///< expected in all
  std::uint64_t not_converged = 0;  ///< of those done
  std::uint64_t before = 0;         ///< of the solves, those of an earlier run that is continued
};

/// How a run is done. None of it changes a bit of the result.
struct RunOptions {
  std::size_t threads = 0;  ///< 0: one per processor
  /// Called now and then, never from two threads at once. May be empty.
  std::function<void(const Progress&)> progress = {};
  /// Set by somebody else to stop the run soon. May be null.
  const std::atomic<bool>* stop = nullptr;
  /// Where the run's state comes from and goes to. May be null. Then a run function throws BytesError for a state that
  /// is not one of its own.
  Checkpoints* checkpoints = nullptr;
  /// The shard to run, instead of the whole. It gives no result, only its state to the checkpoints.
  std::optional<Shard> shard = std::nullopt;
  /// A longer study may go on from the last checkpoint; one that draws all errors together keeps more for that.
  bool keep_checkpoint = true;
  /// The ranks that share the work; null: this process alone. Every rank calls the same run functions with the same
  /// arguments and gets the same results; rank 0 alone has checkpoints and reports progress. When a rank is stopped or
  /// leaves, the functions give nothing, and team->left() says why. The ranks after rank 0 may get Dismissed thrown.
  Team* team = nullptr;
};

/// Number of threads that RunOptions::threads stands for.
std::size_t resolved_threads(std::size_t threads);

/// Starts so many threads of the pool, unless it has them. Whoever may lose something asks for them first, and while
/// there is memory: oneTBB ends the whole program when it cannot start one. Throws FileError where this process cannot
/// have so many.
void start_threads(std::size_t threads);

}  // namespace poesy
