#pragma once

#include <atomic>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <optional>
#include <vector>

#include "engine/model/model.h"
#include "engine/run/checkpoints.h"
#include "engine/run/ranks/team.h"
#include "engine/run/result.h"
#include "engine/run/shard.h"
#include "engine/study/error_table.h"
#include "engine/study/plan.h"

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
  /// A longer study may go on from the last checkpoint; a Monte Carlo study keeps more for that (MonteCarloCollector).
  bool keep_checkpoint = true;
  /// The ranks that share the work; null: this process alone. Every rank calls the same run functions with the same
  /// arguments and gets the same results; rank 0 alone has checkpoints and reports progress. When a rank is stopped or
  /// leaves, the functions give nothing, and team->left() says why. The ranks after rank 0 may get Dismissed thrown.
  Team* team = nullptr;
};

/// Number of threads that RunOptions::threads stands for.
std::size_t resolved_threads(std::size_t threads);

/// Runs a sensitivity study on a pool of threads. Units are merged in plan order, so the result has the same bits
/// for any number of threads, and whether it was continued from checkpoints or not: also from those of a plan with
/// fewer samples. Memory does not grow with the number of samples. Empty when stopped, and of a shard.
std::optional<SensitivityResult> run_sensitivity(const Plan& plan, const Model& model, double conf_level,
                                                 const RunOptions& options);

/// Runs a Monte Carlo study on a pool of threads: as run_sensitivity, and memory does not grow with the number of
/// samples either; a pose's samples are dropped once its quantiles are known, but for what MonteCarloCollector keeps
/// for a longer study. Of the analysis it takes conf_level and quantiles.
std::optional<MonteCarloResult> run_monte_carlo(const Plan& plan, const Model& model, const Analysis& analysis,
                                                const RunOptions& options);

/// How poses and rows of errors belong together.
enum class Pairing {
  every_pose_with_every_row,
  row_by_row  ///< pose m with row m; equal numbers of both
};

/// How much of what the model gives is kept.
enum class Outcomes {
  with_details,  ///< everything the model gives
  responses      ///< without details, which take most of the memory
};

/// Solves every requested (pose, row). Empty when stopped.
std::optional<EvaluationResult> run_evaluation(const Model& model, const SolverOptions& solver, const PoseSet& poses,
                                               const ErrorTable& errors, Pairing pairing, const RunOptions& options,
                                               Outcomes outcomes = Outcomes::with_details);

/// Identifies which of the study's errors deform the mechanism, see identify(). Empty when stopped.
std::optional<IdentificationResult> run_identification(const Study& study, const Model& model, const PoseSet& poses,
                                                       const RunOptions& options);

}  // namespace poesy
