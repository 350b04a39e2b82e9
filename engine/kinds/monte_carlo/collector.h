#pragma once

#include <cstddef>
#include <optional>
#include <vector>

#include "engine/base/archive.h"
#include "engine/base/array.h"
#include "engine/kinds/monte_carlo/columns.h"
#include "engine/kinds/monte_carlo/result.h"
#include "engine/run/evaluate_unit.h"
#include "engine/run/result.h"
#include "engine/stats/main_effects.h"
#include "engine/stats/quantile_sketch.h"
#include "engine/study/plan.h"
#include "engine/study/study.h"

namespace poesy::monte_carlo {

/// The statistics of one response over some samples.
struct ResponseSamples {
  Moments moments;        ///< mean and standard deviation, more exact than those of the quantile sketch
  QuantileSketch sketch;  ///< approximate distribution of the samples, for quantiles

  void state(Archive& archive) { archive.objects(moments, sketch); }  ///< Reads or writes the statistics.
};

/// The statistics of some or all samples at one pose.
struct PoseSamples {
  std::vector<ResponseSamples> responses;  ///< [responses] statistics of each response
  SolveCounts solves;                      ///< how the solves ended
  FailedSamples failed;                    ///< the first samples that failed
  std::optional<MainEffectSums> effects;   ///< sums for main effects; only at the poses where main effects are computed

  /// Statistics without samples, for this many responses and varying errors.
  PoseSamples(std::size_t response_count, std::size_t error_count) : responses(response_count), errors_(error_count) {}
  /// Adds the statistics of a unit (a block of samples). Precondition: its samples come after those already added.
  void add(const PoseUnit& unit);
  void state(Archive& archive);  ///< Reads or writes the statistics, bit for bit.

 private:
  std::size_t errors_;
};

/// Merges the units (blocks of samples) of a Monte Carlo study with draws per pose, pose by pose; a pose is finished
/// when all its samples are merged. PoseFold (run/pose_fold.h) adds the units to an object of this class. Quantile
/// sketches are in memory only for the pose that is being merged, and for each response over all finished poses. So
/// memory does not depend on the number of samples, and each finished pose takes only a few numbers. For a later study
/// with more samples, packed quantile sketches of finished poses are kept as well, up to kMostKeptBytes. The result
/// does not depend on the order in which poses are finished.
class Collector {
 public:
  /// The largest number of bytes of packed quantile sketches that are kept for a later study with more samples. If the
  /// sketches of a pose no longer fit, that study solves the pose again from its first sample.
  static constexpr std::size_t kMostKeptBytes = std::size_t{64} << 20U;
  /// Tells PoseFold to make new sums for each round of adaptive sampling, because a finished pose takes no more
  /// samples.
  static constexpr bool kOfRound = true;

  /// Keeps a reference to the plan. keep_checkpoint: whether to keep packed quantile sketches of finished poses.
  Collector(const Plan& plan, std::size_t responses, const Analysis& analysis, bool keep_checkpoint = true);

  /// Adds a unit. Precondition: no pose is begun before all units of the previous pose are added.
  void add(const WorkUnit& unit, const PoseUnit& found);
  /// The number of units at this pose that were added.
  std::size_t units_done(std::size_t pose) const;
  /// How the solves of all added units ended.
  SolveCounts total() const;
  /// The result at the finished poses. The numbers over all poses are not set.
  const Result& finished() const { return columns_.result(); }
  /// The result. Precondition: every unit was added.
  Result result() &&;

  /// Writes the statistics of all poses; or reads those that a study with `samples` samples at each pose wrote, and
  /// adds them. If this study has more samples, the poses that are read are unfinished, and continue from their packed
  /// quantile sketches.
  void state(Archive& archive, std::size_t samples);

 private:
  /// The statistics of full units (of Plan::kUnitSamples samples) at one pose, packed as bytes.
  struct Kept {
    SolveCounts solves;
    Bytes bytes;  ///< what PoseSamples::state() writes; empty if nothing is kept
  };

  bool is_finished(std::size_t pose) const { return columns_.result().solves[pose].total() > 0; }
  bool is_open(std::size_t pose) const { return pose == open_.value && at_pose_.solves.total() > 0; }
  void finish_pose();
  /// Sets the numbers that depend on the moments of a response at a pose.
  void set_moments(std::size_t response, std::size_t pose, const Moments& moments);
  /// Packs the statistics of the pose whose units are being added, and keeps them if kMostKeptBytes allows it.
  /// Precondition: all its units so far are full units.
  void keep();
  void set_kept(std::size_t pose, Kept kept);
  void finished_state(Archive& archive, std::size_t pose, std::size_t samples);
  /// Computes first-order indices and main effects, for draws that are independent between poses.
  EffectResult effects() const;
  PoseSamples no_samples() const { return {responses_, plan_->factors().size()}; }
  void open_state(Archive& archive, std::size_t samples);
  void kept_state(Archive& archive, std::size_t pose, std::size_t most_samples);

  const Plan* plan_;
  std::size_t responses_;
  std::vector<ResponseLimit> limits_;
  Options asked_;
  bool keep_checkpoint_;
  PoseIndex open_;                                      ///< the open pose: the one whose units are being added
  PoseSamples at_pose_;                                 ///< statistics of the open pose; no samples if no pose is open
  std::vector<QuantileSketch> sketches_;                ///< [responses] quantile sketch over all finished poses
  Array<Moments, axis::Pose, axis::Response> moments_;  ///< moments at the finished poses
  MonteCarloColumns columns_;                           ///< result at the finished poses
  /// [poses] Sums for main effects; set for a finished pose at which they are computed.
  std::vector<std::optional<MainEffectSums>> effects_;
  std::vector<FailedSamples> failed_;  ///< [poses] the first failed samples of each finished pose
  /// [poses] Packed statistics. Those of a finished pose are kept for a later study with more samples; those of an
  /// unfinished pose were read from a study with fewer samples.
  std::vector<Kept> kept_;
  std::size_t kept_bytes_ = 0;
};

}  // namespace poesy::monte_carlo
