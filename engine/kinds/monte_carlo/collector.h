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

/// One response of some samples.
struct ResponseSamples {
  Moments moments;        ///< exact
  QuantileSketch sketch;  ///< for quantiles

  void state(Archive& archive) { archive.objects(moments, sketch); }  ///< Both.
};

/// Some samples, all or not, at one pose.
struct PoseSamples {
  std::vector<ResponseSamples> responses;  ///< each of them
  SolveCounts solves;                      ///< how their solves ended
  FailedSamples failed;                    ///< the first of them
  std::optional<MainEffectSums> effects;   ///< at the poses where main effects are added up

  /// No samples. errors: that vary.
  PoseSamples(std::size_t response_count, std::size_t error_count) : responses(response_count), errors_(error_count) {}
  /// Precondition: its samples come after those that are here.
  void add(const PoseUnit& unit);
  void state(Archive& archive);  ///< Every bit.

 private:
  std::size_t errors_;
};

/// Puts units together, pose by pose. Holds the samples of one pose, as sketches, and of all finished poses together
/// their sketches: memory grows neither with the samples nor, but for the result, with the poses. The sums of a
/// PoseFold. If a study with more samples is to go on from it, it also keeps the sketches of finished poses, packed, as
/// many as kMostKeptBytes hold. The order in which poses are finished changes nothing.
class MonteCarloCollector {
 public:
  /// Of packed sketches; poses beyond are solved again when more samples are wanted.
  static constexpr std::size_t kMostKeptBytes = std::size_t{64} << 20U;
  static constexpr bool kOfRound = true;  ///< Finished poses are open again when more samples are wanted.

  /// keep_checkpoint: whether to keep sketches of finished poses.
  MonteCarloCollector(const Plan& plan, std::size_t responses, const Analysis& analysis, bool keep_checkpoint = true);

  /// Units of a pose come one after another.
  void add(const WorkUnit& unit, const PoseUnit& found);
  /// Units of this pose that were added.
  std::size_t units_done(std::size_t pose) const;
  /// Over all that was added.
  SolveCounts total() const;
  /// Of the finished poses; without the overall numbers.
  const MonteCarloResult& finished() const { return columns_.result(); }
  /// Precondition: every unit was added.
  MonteCarloResult result() &&;

  /// Writes all poses, or adds those of a plan with so many samples. If these are fewer than this plan's, all poses are
  /// open again, and begin with what was kept of them.
  void state(Archive& archive, std::size_t samples);

 private:
  /// Samples at a pose that make up whole units, packed.
  struct Kept {
    SolveCounts solves;
    Bytes bytes;  ///< their state
  };

  bool is_finished(std::size_t pose) const { return columns_.result().solves[pose].total() > 0; }
  bool is_open(std::size_t pose) const { return pose == open_.value && at_pose_.solves.total() > 0; }
  void finish_pose();
  /// What follows from the moments of a response at a pose.
  void set_moments(std::size_t response, std::size_t pose, const Moments& moments);
  /// Keeps the open pose's samples, which make up whole units so far, if there is room for them.
  void keep();
  void set_kept(std::size_t pose, Kept kept);
  void finished_state(Archive& archive, std::size_t pose, std::size_t samples);
  /// The sums of some poses, whose draws are independent.
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
  PoseSamples at_pose_;                                 ///< its samples
  std::vector<QuantileSketch> sketches_;                ///< of each response at the finished poses together
  Array<Moments, axis::Pose, axis::Response> moments_;  ///< of the finished poses
  MonteCarloColumns columns_;                           ///< of the finished poses
  std::vector<std::optional<MainEffectSums>> effects_;  ///< of each finished pose that has them
  std::vector<FailedSamples> failed_;                   ///< of each finished pose
  std::vector<Kept> kept_;  ///< of each pose: finished ones for a longer study, others from a shorter study
  std::size_t kept_bytes_ = 0;
};

}  // namespace poesy
