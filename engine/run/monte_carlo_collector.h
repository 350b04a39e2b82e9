#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include "engine/base/bytes.h"
#include "engine/run/monte_carlo.h"
#include "engine/run/result.h"
#include "engine/study/plan.h"

namespace poesy {

/// One response of some samples.
struct ResponseSamples {
  Moments moments;
  QuantileSketch sketch;

  void merge(const ResponseSamples& other);
  void write(ByteWriter& to) const;
  static ResponseSamples read(ByteReader& from);
};

/// Some samples, all or not, at one pose.
struct PoseSamples {
  std::vector<ResponseSamples> responses;  ///< [R]
  SolveCounts solves;

  void add(const PoseUnit& unit);
  void write(ByteWriter& to) const;
  static PoseSamples read(ByteReader& from, std::size_t responses);
};

/// Puts units together, in the order of the plan. Holds the samples of one pose, as sketches, and those of all poses
/// together: memory grows neither with the samples nor, but for the result, with the poses. So that a study with more
/// samples can go on from it, it also keeps the sketches of finished poses, packed, as many as kMostKeptBytes hold.
class MonteCarloCollector {
 public:
  static constexpr std::size_t kMostKeptBytes = std::size_t{64} << 20U;

  MonteCarloCollector(const Plan& plan, std::size_t responses, const Analysis& analysis);

  /// Units of a pose come one after another, poses in order.
  void add(PoseIndex pose, const PoseUnit& unit);
  /// Units of this pose that were added.
  std::size_t units_done(PoseIndex pose) const;
  /// Over all that was added.
  SolveCounts total() const;
  /// Of the finished poses; without the overall numbers.
  const MonteCarloResult& finished() const { return result_; }
  /// Precondition: every unit was added.
  MonteCarloResult result() &&;

  /// Everything added so far.
  Bytes state() const;
  /// Takes up a state of this plan, or of one that differs by fewer samples: then all poses are open again, and begin
  /// with what was kept of them. Throws BytesError for anything else. Precondition: nothing was added.
  void restore(std::span<const std::byte> state);

 private:
  /// Samples at a pose that make up whole units, packed.
  struct Kept {
    SolveCounts solves;
    Bytes bytes;  ///< as PoseSamples::write gives them
  };

  void finish_pose();
  /// Keeps the open pose's samples, which make up whole units so far, if there is room for them.
  void keep();
  void set_kept(std::size_t pose, Kept kept);
  void write_finished(ByteWriter& to, std::size_t pose) const;
  void read_finished(ByteReader& from, std::size_t pose);
  void read_kept(ByteReader& from, std::size_t pose, std::size_t most_samples);

  const Plan* plan_;
  std::size_t responses_;
  PoseIndex pose_;                        ///< the open pose; those before it are finished
  PoseSamples at_pose_;                   ///< its samples
  std::vector<ResponseSamples> overall_;  ///< [R] of the finished poses
  MonteCarloResult result_;               ///< of the finished poses
  std::vector<Kept> kept_;                ///< [M] finished poses for a longer study; open ones from a shorter study
  std::size_t kept_bytes_ = 0;
};

}  // namespace poesy
