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

namespace poesy {

/// One response in some samples.
struct ResponseSamples {
  Moments moments;        ///< exact
  QuantileSketch sketch;  ///< for quantiles

  void state(Archive& archive) { archive.objects(moments, sketch); }  ///< Reads or writes both.
};

/// Some of the samples at one pose, or all.
struct PoseSamples {
  std::vector<ResponseSamples> responses;  ///< [R] each response
  SolveCounts solves;                      ///< how their solves ended
  FailedSamples failed;                    ///< the first failed samples
  std::optional<MainEffectSums> effects;   ///< main effects, at the poses where they are summed

  /// Without samples. errors: the number of errors that vary.
  PoseSamples(std::size_t response_count, std::size_t error_count) : responses(response_count), errors_(error_count) {}
  /// Adds a unit. Precondition: its samples come after those already added.
  void add(const PoseUnit& unit);
  void state(Archive& archive);  ///< Reads or writes every bit.

 private:
  std::size_t errors_;
};

/// Merges units, pose by pose: the sums of a PoseFold. It holds the samples of one pose as sketches, and one sketch for
/// each response of all finished poses. Memory is independent of the number of samples; only the result grows with the
/// poses. If a study with more samples may continue it, it also keeps packed sketches of finished poses, up to
/// kMostKeptBytes. The result does not depend on the order in which poses are finished.
class MonteCarloCollector {
 public:
  /// Bytes of packed sketches that are kept; other poses are solved again when more samples are wanted.
  static constexpr std::size_t kMostKeptBytes = std::size_t{64} << 20U;
  static constexpr bool kOfRound = true;  ///< Finished poses are opened again when more samples are wanted.

  /// keep_checkpoint: whether to keep the sketches of finished poses.
  MonteCarloCollector(const Plan& plan, std::size_t responses, const Analysis& analysis, bool keep_checkpoint = true);

  /// Adds a unit. Units of a pose must follow each other.
  void add(const WorkUnit& unit, const PoseUnit& found);
  /// The number of units of this pose that were added.
  std::size_t units_done(std::size_t pose) const;
  /// The solves of all units that were added.
  SolveCounts total() const;
  /// The result at the finished poses, without the overall numbers.
  const MonteCarloResult& finished() const { return columns_.result(); }
  /// The result. Precondition: every unit was added.
  MonteCarloResult result() &&;

  /// Writes all poses, or reads those of a plan with this many samples and adds them. If these are fewer than this
  /// plan's samples, all poses are open again, and start from what was kept of them.
  void state(Archive& archive, std::size_t samples);

 private:
  /// The packed samples of whole units at a pose.
  struct Kept {
    SolveCounts solves;
    Bytes bytes;  ///< their state
  };

  bool is_finished(std::size_t pose) const { return columns_.result().solves[pose].total() > 0; }
  bool is_open(std::size_t pose) const { return pose == open_.value && at_pose_.solves.total() > 0; }
  void finish_pose();
  /// Sets the numbers that depend on the moments of a response at a pose.
  void set_moments(std::size_t response, std::size_t pose, const Moments& moments);
  /// Keeps the samples of the open pose if they are whole units and there is room for them.
  void keep();
  void set_kept(std::size_t pose, Kept kept);
  void finished_state(Archive& archive, std::size_t pose, std::size_t samples);
  /// First-order indices and main effects from poses whose draws are independent.
  EffectResult effects() const;
  PoseSamples no_samples() const { return {responses_, plan_->factors().size()}; }
  void open_state(Archive& archive, std::size_t samples);
  void kept_state(Archive& archive, std::size_t pose, std::size_t most_samples);

  const Plan* plan_;
  std::size_t responses_;
  std::vector<ResponseLimit> limits_;
  MonteCarloOptions asked_;
  bool keep_checkpoint_;
  PoseIndex open_;                                      ///< the open pose, if there is one
  PoseSamples at_pose_;                                 ///< the samples of the open pose
  std::vector<QuantileSketch> sketches_;                ///< [R] all finished poses together
  Array<Moments, axis::Pose, axis::Response> moments_;  ///< of the finished poses
  MonteCarloColumns columns_;                           ///< of the finished poses
  std::vector<std::optional<MainEffectSums>> effects_;  ///< main effects of each finished pose that has them
  std::vector<FailedSamples> failed_;                   ///< of each finished pose
  std::vector<Kept>
      kept_;  ///< kept samples of each pose: finished ones for a longer study, others from a shorter study
  std::size_t kept_bytes_ = 0;
};

}  // namespace poesy
