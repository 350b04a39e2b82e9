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

/// Whether a sample with this status counts in statistics. A singular or non-finite one, or one that cannot be
/// assembled, never does.
constexpr bool counts(SolveStatus status, NotConverged policy) {
  return solved(status) || (policy == NotConverged::include && usable(status));
}

/// How solves ended and their iterations, summed over samples.
struct SolveCounts {
  /// The number of samples for each SolveStatus, in its order.
  std::array<std::uint64_t, kStatusNames.size()> by_status{};
  std::uint64_t iterations = 0;       ///< sum over all samples
  std::uint32_t most_iterations = 0;  ///< largest number of a sample

  /// The number of samples.
  std::uint64_t total() const;
  /// The number of samples that did not reach their fixed point, for any reason.
  std::uint64_t not_converged() const;
  /// The number of these that have no fixed point: the machine cannot be assembled.
  std::uint64_t not_assembled() const { return by_status[static_cast<std::size_t>(SolveStatus::not_assembled)]; }
  /// Adds one sample.
  void add(SolveStatus status, std::uint32_t sample_iterations);
  /// Adds other counts; the order does not matter.
  void merge(const SolveCounts& other);

  void state(Archive& archive);  ///< Reads or writes every count.
};

/// The counts of all cells together.
SolveCounts total_of(std::span<const SolveCounts> cells);

/// A sample that was not solved.
struct FailedSample {
  SampleIndex sample;  ///< position in the stream of its cell
  SolveStatus status;  ///< how it ended

  /// Whether both members are equal.
  bool operator==(const FailedSample&) const = default;
};

/// The first samples of one cell, or of a part of it, that were not solved. Memory is allocated only if a sample fails.
class FailedSamples {
 public:
  /// The largest number of failures that are kept of a cell; which ones depends only on its samples.
  static constexpr std::size_t kMost = 10;

  /// Adds a failed sample. Precondition: samples are added in ascending order.
  void add(SampleIndex sample, SolveStatus status) {
    if (solved(status) || first_.size() == kMost) return;
    first_.reserve(kMost);
    first_.push_back({sample, status});
  }
  /// Adds later failures. Precondition: all samples of `later` come after those of this object.
  void merge(const FailedSamples& later);

  /// The failures in the order of samples, at most kMost.
  std::span<const FailedSample> first() const { return first_; }

  /// Reads or writes the failures. What is read must fit these numbers: samples in [first, end), of which `failures`
  /// failed. A writer ignores them.
  void state(Archive& archive, std::uint64_t failures, std::uint64_t first, std::uint64_t end);

 private:
  std::vector<FailedSample> first_;
};

/// The address and the status of a sample that was not solved.
struct Failure {
  std::size_t slot;     ///< position among the study's factors; 0 if all vary together
  PoseIndex pose;       ///< position among the study's poses
  FailedSample failed;  ///< which sample, and how it ended

  /// Whether address and status are equal.
  bool operator==(const Failure&) const = default;
};

/// The largest number of failures that a result lists.
inline constexpr std::size_t kMostFailuresListed = 1000;

/// Adds the failures of a cell to the list, as far as it has room.
void append_failures(std::size_t slot, PoseIndex pose, const FailedSamples& cell, std::vector<Failure>& list);

/// Estimates after the first samples of each pose: R responses, P slots (the factors of a sensitivity study; one in a
/// Monte Carlo study), K numbers of samples; SI. A quantity is a global index in a sensitivity study and a mean over
/// the samples of all poses in a Monte Carlo study. Its uncertainty is stated by the ends of an interval or by a
/// half-width, which is the larger distance to one end; the members of the other form are empty.
struct EstimateCourse {
  std::vector<std::uint64_t> samples;   ///< [K] samples at each pose, ascending
  std::vector<double> value;            ///< [R x P x K] NaN if not known
  std::vector<double> ci_low = {};      ///< [R x P x K] or empty
  std::vector<double> ci_high = {};     ///< [R x P x K] or empty
  std::vector<double> half_width = {};  ///< [R x P x K] or empty
  double conf_level = 0.95;             ///< level of the intervals
};

/// How the adaptive samples of a study ended (engine/run/rounds.h): R responses, P slots.
struct ConvergenceResult {
  std::size_t min = 0;          ///< least number of samples at each pose
  std::size_t max = 0;          ///< largest number of samples at each pose
  double relative_error = 0.0;  ///< wanted half-width over |quantity|
  /// The estimates at the milestones, with half-widths; the last milestone may be max, where nothing is decided. NaN
  /// after the end of a slot.
  EstimateCourse course;
  std::vector<std::uint8_t> reached;        ///< [R x P] whether the half-width at the end is small enough, 0 or 1
  std::vector<double> relative_half_width;  ///< [R x P] half-width over |quantity| at the end; NaN for 0 / 0
  std::vector<std::uint64_t> samples;       ///< [P] samples at each pose
};

/// The verdict on a limit of a response (engine/run/evaluation.h). SI.
struct LimitVerdict {
  std::size_t response = 0;  ///< position among the responses
  ValueLimit limit = 0.0;    ///< limit that the study states
  /// Number that is compared with it: a magnitude for a limit on magnitudes, a spread for one on the spread, otherwise
  /// a value; infinite or NaN if too few samples were solved.
  double value = 0.0;
  bool passed = false;       ///< whether the limit is kept
  std::uint64_t tried = 0;   ///< draws at all poses together; for an evaluation its rows
  std::uint64_t within = 0;  ///< those within the limit; a row must be within it at each of its poses
  std::optional<std::size_t> pose = std::nullopt;  ///< pose of `value`, if it belongs to one pose
  std::optional<std::size_t> row = std::nullopt;   ///< row of `value`, for an evaluation
};

/// The verdict on the yield, for Judge::yield: the share of machines that are within all limits at all poses. A machine
/// that is not solved at a pose is a reject.
struct YieldVerdict {
  /// The decision by one-sided bounds on the yield (Clopper and Pearson) at conf_level.
  enum class Decision {
    not_asked,  ///< the study asks for no yield
    kept,       ///< the lower bound is at least the wanted yield
    not_kept,   ///< the upper bound is below the wanted yield
    undecided   ///< neither; there are too few machines to decide
  };
  Decision decision = Decision::not_asked;  ///< decision on the wanted yield
  double asked = 0.0;                       ///< wanted yield; 0: none
  double conf_level = 0.95;                 ///< level of the interval and of each bound
  double value = 0.0;                       ///< share of the machines that are not rejects
  double ci_low = 0.0;                      ///< lower end of its two-sided interval
  double ci_high = 0.0;                     ///< upper end of its two-sided interval
  std::uint64_t machines = 0;               ///< machines that were tried
  std::uint64_t rejects = 0;                ///< machines that are not within every limit at every pose
  std::uint64_t unsolved = 0;               ///< machines rejected only because a pose was not solved
  /// If errors are measured: the interval that includes the uncertainty from few parts; NaN if not known.
  std::optional<Interval> with_parts = {};
  SolveCounts solves = {};  ///< solves of the machines at all poses
};

/// The verdicts on all limits of a study.
struct LimitVerdicts {
  /// The number by which draws are judged; none for an evaluation, whose rows are judged one by one.
  std::optional<Judge> judge = std::nullopt;
  double share = 0.0;                ///< for Judge::share: the share of the draws at each pose
  std::vector<LimitVerdict> limits;  ///< in the order of the responses
  /// Of an evaluation: the rows that are within all limits; none if they were not counted.
  std::optional<std::uint64_t> rows_within = std::nullopt;
  /// For Judge::yield, which judges all limits together; the verdicts in `limits` on each alone then decide nothing.
  std::optional<YieldVerdict> yield = std::nullopt;

  /// Whether every limit is kept. For Judge::yield: whether the yield is not shown to be too low.
  bool passed() const;
};

/// Facts of one run that depend on the machine and are not part of the result's content.
struct RunFacts {
  std::string created;              ///< UTC, ISO 8601
  std::string host;                 ///< name of the machine of rank 0
  std::string cpu;                  ///< name of its processor
  std::size_t threads = 1;          ///< of all ranks together
  std::size_t ranks = 1;            ///< processes that shared the run
  double wall_seconds = 0.0;        ///< wall time of all parts of a run that was stopped and resumed
  double checkpoint_seconds = 0.0;  ///< the part of it that checkpoints took
  std::uint64_t solves = 0;         ///< solves of all parts of the run
};

}  // namespace poesy
