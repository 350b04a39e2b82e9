#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "engine/base/archive.h"
#include "engine/base/index.h"
#include "engine/model/status.h"
#include "engine/stats/moments.h"
#include "engine/study/poses/pose_selection.h"
#include "engine/study/study.h"

namespace poesy {

/// Whether a sample that ended so enters statistics. A singular or non-finite one never does, nor one that cannot be
/// assembled.
constexpr bool counts(SolveStatus status, NotConverged policy) {
  return solved(status) || (policy == NotConverged::include && usable(status));
}

/// How solves ended and what they cost, summed over samples.
struct SolveCounts {
  /// Samples that ended so, in the order of SolveStatus.
  std::array<std::uint64_t, kStatusNames.size()> by_status{};
  std::uint64_t iterations = 0;       ///< of all samples together
  std::uint32_t most_iterations = 0;  ///< of any one sample

  /// Samples.
  std::uint64_t total() const;
  /// Samples that did not reach their fixed point, for whatever reason.
  std::uint64_t not_converged() const;
  /// Of these, samples that have none: the machine cannot be assembled.
  std::uint64_t not_assembled() const { return by_status[static_cast<std::size_t>(SolveStatus::not_assembled)]; }
  /// One sample.
  void add(SolveStatus status, std::uint32_t sample_iterations);
  /// The order changes nothing.
  void merge(const SolveCounts& other);

  void state(Archive& archive);  ///< Every count.
};

/// Of all cells.
SolveCounts total_of(std::span<const SolveCounts> cells);

/// A sample that was not solved.
struct FailedSample {
  SampleIndex sample;  ///< position in the stream of its cell
  SolveStatus status;  ///< how it ended

  /// Whether both members are equal.
  bool operator==(const FailedSample&) const = default;
};

/// The first samples of one cell, or of a part of it, that were not solved. Allocates once, when one
/// fails.
class FailedSamples {
 public:
  /// No more of a cell are kept; which ones depends on its samples alone.
  static constexpr std::size_t kMost = 10;

  /// Samples come in ascending order.
  void add(SampleIndex sample, SolveStatus status) {
    if (solved(status) || first_.size() == kMost) return;
    first_.reserve(kMost);
    first_.push_back({sample, status});
  }
  /// Precondition: all samples of `later` come after those of this.
  void merge(const FailedSamples& later);

  /// In the order of samples, at most kMost.
  std::span<const FailedSample> first() const { return first_; }

  /// Of samples first .. end - 1, so many of which failed; nobody looks at these numbers where it is written.
  void state(Archive& archive, std::uint64_t failures, std::uint64_t first, std::uint64_t end);

 private:
  std::vector<FailedSample> first_;
};

/// Where a sample stands that was not solved: its address.
struct Failure {
  std::size_t slot;     ///< position among the study's factors; 0 where all vary together
  PoseIndex pose;       ///< among the study's
  FailedSample failed;  ///< which sample, and how it ended

  /// Whether address and end are equal.
  bool operator==(const Failure&) const = default;
};

/// A result lists no more failures than this.
inline constexpr std::size_t kMostFailuresListed = 1000;

/// Appends the failures of a cell, as far as the list has room.
void append_failures(std::size_t slot, PoseIndex pose, const FailedSamples& cell, std::vector<Failure>& list);

/// What quantities were after the first samples of each pose: R responses, P slots (the factors of a sensitivity study;
/// one in a Monte Carlo study), K numbers of samples. A quantity is a global index in a sensitivity study and a mean
/// over the samples of all poses in a Monte Carlo study. SI. How sure it is, either the ends of its interval say or its
/// half-width, which is the larger distance from it to one of them; the others are empty.
struct EstimateCourse {
  std::vector<std::uint64_t> samples;   ///< [K] at each pose, ascending
  std::vector<double> value;            ///< [R x P x K] NaN where it is not known
  std::vector<double> ci_low = {};      ///< [R x P x K] or empty
  std::vector<double> ci_high = {};     ///< [R x P x K] or empty
  std::vector<double> half_width = {};  ///< [R x P x K] or empty
  double conf_level = 0.95;             ///< of the intervals
};

/// How a study with adaptive samples came to its end (engine/run/rounds.h): R responses, P slots.
struct ConvergenceResult {
  std::size_t min = 0;          ///< samples at each pose, as the study sets them
  std::size_t max = 0;          ///< samples at each pose, at the most
  double relative_error = 0.0;  ///< that is asked for: half-width over |quantity|
  /// At the milestones, with half-widths; the last may be max, where nothing is decided. NaN after a slot came to its
  /// end.
  EstimateCourse course;
  std::vector<std::uint8_t> reached;        ///< [R x P] whether the half-width at the end is small enough, 0 or 1
  std::vector<double> relative_half_width;  ///< [R x P] half-width over |quantity| at the end; NaN for 0 / 0
  std::vector<std::uint64_t> samples;       ///< [P] at each pose
};

/// How a limit of a response was kept (engine/run/evaluation.h). SI; values are magnitudes.
struct LimitVerdict {
  std::size_t response = 0;  ///< position among the responses
  double limit = 0.0;        ///< the study's
  double value = 0.0;        ///< what is compared with it; infinite or NaN where too few samples were solved
  bool passed = false;       ///< whether the limit is kept
  std::uint64_t tried = 0;   ///< draws at all poses together; of an evaluation its rows
  std::uint64_t within = 0;  ///< of these, those within the limit; a row is if it is at each of its poses
  std::optional<std::size_t> pose = std::nullopt;  ///< where `value` was found, if at one pose
  std::optional<std::size_t> row = std::nullopt;   ///< of an evaluation: the row of `value`
};

/// The share of machines that are within all limits at all poses, for Judge::yield. A machine that is not solved at a
/// pose is a reject.
struct YieldVerdict {
  /// What is shown by the one-sided bounds on the yield (Clopper and Pearson) at conf_level.
  enum class Decision {
    not_asked,  ///< no yield was asked for
    kept,       ///< the lower bound is at least the yield that was asked for
    not_kept,   ///< the upper bound is below it
    undecided   ///< the machines are too few to tell
  };
  Decision decision = Decision::not_asked;  ///< on `asked`
  double asked = 0.0;                       ///< 0: none
  double conf_level = 0.95;                 ///< of the interval, and of each bound
  double value = 0.0;                       ///< share of the machines that are no rejects
  double ci_low = 0.0;                      ///< of its two-sided interval
  double ci_high = 0.0;                     ///< likewise
  std::uint64_t machines = 0;               ///< tried
  std::uint64_t rejects = 0;                ///< of these, those that are not within every limit at every pose
  std::uint64_t unsolved = 0;               ///< of the rejects, those that no solved pose rejects
  /// Where errors are measured: the interval that counts how few parts there are as well; NaN where it is not known.
  std::optional<Interval> with_parts = {};
  SolveCounts solves = {};  ///< of the machines at all poses
};

/// All limits of a study.
struct LimitVerdicts {
  /// By which number draws are judged; none in an evaluation, whose rows are judged one by one.
  std::optional<Judge> judge = std::nullopt;
  double share = 0.0;                ///< for Judge::share: of the draws at each pose
  std::vector<LimitVerdict> limits;  ///< in the order of the responses
  /// For Judge::yield, which judges all limits together; what `limits` says of each alone decides nothing then.
  std::optional<YieldVerdict> yield = std::nullopt;

  /// Whether every limit is kept; by Judge::yield, whether it is not shown that the yield is too low.
  bool passed() const;
};

/// Facts about one run that differ from machine to machine and are not part of the result's content.
struct RunFacts {
  std::string created;              ///< UTC, ISO 8601
  std::string host;                 ///< name of the machine, of rank 0
  std::string cpu;                  ///< its processor, as it names itself
  std::size_t threads = 1;          ///< of all ranks together
  std::size_t ranks = 1;            ///< processes that shared the run
  double wall_seconds = 0.0;        ///< of all parts of a run that was stopped and resumed
  double checkpoint_seconds = 0.0;  ///< of these, for checkpoints
  std::uint64_t solves = 0;         ///< of all parts of the run
};

}  // namespace poesy
