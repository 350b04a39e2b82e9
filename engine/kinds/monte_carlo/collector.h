#pragma once

#include <cstddef>
#include <optional>
#include <span>
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
};

/// Some samples, all or not, at one pose.
struct PoseSamples {
  std::vector<ResponseSamples> responses;  ///< each of them
  SolveCounts solves;                      ///< how their solves ended
  FailedSamples failed;                    ///< the first of them
  std::optional<MainEffectSums> effects;   ///< at the poses where main effects are added up

  /// Precondition: its samples come after those that are here.
  void add(const PoseUnit& unit);
  /// errors: that vary, which nobody looks at where it is written.
  void state(Archive& archive, std::size_t errors);
  void write(ByteWriter& to) const;  ///< Their state.
  /// Their state. Throws BytesError for what no samples give.
  static PoseSamples read(ByteReader& from, std::size_t responses, std::size_t errors);
};

/// Puts units together, pose by pose. Holds the samples of one pose, as sketches, and of all finished poses together
/// their sketches: memory grows neither with the samples nor, but for the result, with the poses. If a study with more
/// samples is to go on from it, it also keeps the sketches of finished poses, packed, as many as kMostKeptBytes hold.
/// The order in which poses are finished changes nothing.
class MonteCarloCollector {
 public:
  /// Of packed sketches; poses beyond are solved again when more samples are wanted.
  static constexpr std::size_t kMostKeptBytes = std::size_t{64} << 20U;

  /// keep_checkpoint: whether to keep sketches of finished poses.
  MonteCarloCollector(const Plan& plan, std::size_t responses, const Analysis& analysis, bool keep_checkpoint = true);

  /// Units of a pose come one after another.
  void add(PoseIndex pose, const PoseUnit& unit);
  /// Units of this pose that were added.
  std::size_t units_done(PoseIndex pose) const;
  /// Over all that was added.
  SolveCounts total() const;
  /// Of the finished poses; without the overall numbers.
  const MonteCarloResult& finished() const { return columns_.result(); }
  /// Precondition: every unit was added.
  MonteCarloResult result() &&;

  /// Everything added so far.
  void write_state(ByteWriter& to) const;
  /// Takes up a state of this plan, or of one that differs by fewer samples: then all its poses are open again, and
  /// begin with what was kept of them. States that hold different poses may stand one behind the other. Throws
  /// BytesError for anything else. Precondition: nothing was added.
  void restore(std::span<const std::byte> state);

 private:
  /// Samples at a pose that make up whole units, packed.
  struct Kept {
    SolveCounts solves;
    Bytes bytes;  ///< as PoseSamples::write gives them
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
  void restore_one(ByteReader& from);
  /// The sums of some poses, whose draws are independent.
  EffectResult effects() const;
  void read_open(ByteReader& from, std::size_t samples);
  void read_kept(ByteReader& from, std::size_t pose, std::size_t most_samples);

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
