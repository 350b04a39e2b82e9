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

/// Returns true if a sample with this status counts in statistics. A sample that reached the iteration limit counts
/// only with NotConverged::include; one that is singular, not finite or not assembled never counts.
constexpr bool counts(SolveStatus status, NotConverged policy) {
  return solved(status) || (policy == NotConverged::include && usable(status));
}

/// Counts of how samples ended, and of the iterations of their solves.
struct SolveCounts {
  /// The number of samples for each SolveStatus, in the order of the enum.
  std::array<std::uint64_t, kStatusNames.size()> by_status{};
  std::uint64_t iterations = 0;       ///< sum of the iterations of all samples
  std::uint32_t most_iterations = 0;  ///< largest number of iterations of one sample

  /// The number of samples.
  std::uint64_t total() const;
  /// The number of samples whose solves did not converge, for any reason.
  std::uint64_t not_converged() const;
  /// The number of samples without a solution, because the machine cannot be assembled.
  std::uint64_t not_assembled() const { return by_status[static_cast<std::size_t>(SolveStatus::not_assembled)]; }
  /// The number of samples that were computed from certified series instead of solved.
  std::uint64_t by_series() const { return by_status[static_cast<std::size_t>(SolveStatus::by_series)]; }
  /// Adds one sample.
  void add(SolveStatus status, std::uint32_t sample_iterations);
  /// Adds the counts of other samples; the order of merging does not matter.
  void merge(const SolveCounts& other);

  void state(Archive& archive);  ///< Reads or writes every count.
};

/// The sum of these counts.
SolveCounts total_of(std::span<const SolveCounts> cells);

/// A sample that was not solved.
struct FailedSample {
  SampleIndex sample;  ///< number of the sample, from 0, in its cell (one error, or all errors, at one pose)
  SolveStatus status;  ///< how its solve ended

  /// Returns true if both members are equal.
  bool operator==(const FailedSample&) const = default;
};

/// The first unsolved samples of one cell (one error, or all errors together, at one pose), or of one unit (block of
/// samples) of a cell. No memory is allocated before a sample fails.
class FailedSamples {
 public:
  /// The largest number of failures that are kept for a cell. The first failures are kept, so they do not depend on how
  /// the run was divided.
  static constexpr std::size_t kMost = 10;

  /// Adds a sample if it was not solved and fewer than kMost failures are kept. Precondition: samples are added in
  /// ascending order.
  void add(SampleIndex sample, SolveStatus status) {
    if (solved(status) || first_.size() == kMost) return;
    first_.reserve(kMost);
    first_.push_back({sample, status});
  }
  /// Adds later failures. Precondition: all samples of `later` come after those of this object.
  void merge(const FailedSamples& later);

  /// The failures in the order of samples, at most kMost.
  std::span<const FailedSample> first() const { return first_; }

  /// Reads or writes the failures. Throws BytesError if failures that are read do not fit the arguments: `failures`
  /// samples have failed, all of them in [first, end). When writing, the arguments are ignored.
  void state(Archive& archive, std::uint64_t failures, std::uint64_t first, std::uint64_t end);

 private:
  std::vector<FailedSample> first_;
};

/// Says which sample was not solved, and how its solve ended.
struct Failure {
  std::size_t slot;     ///< index of the varied error in the list of the study's factors; 0 if all errors vary together
  PoseIndex pose;       ///< index in the list of the study's poses
  FailedSample failed;  ///< the sample, and how it ended

  /// Returns true if both name the same sample with the same status.
  bool operator==(const Failure&) const = default;
};

/// The largest number of failures that a result lists.
inline constexpr std::size_t kMostFailuresListed = 1000;

/// Adds the failures of a cell to the list, up to kMostFailuresListed in all.
void append_failures(std::size_t slot, PoseIndex pose, const FailedSamples& cell, std::vector<Failure>& list);

/// Estimates of quantities after different numbers of samples at each pose, SI. There is a quantity for each response
/// and each slot (one error that varies alone, or all errors that vary together). In a sensitivity study it is a global
/// index; in a Monte Carlo study it is a mean over the samples of all poses. The uncertainty of a quantity has one of
/// two forms: the two ends of an interval, or a half-width, which is the larger distance to an end. The members of the
/// unused form are empty.
struct EstimateCourse {
  std::vector<std::uint64_t> samples;   ///< numbers of samples at each pose after which estimates were made, ascending
  std::vector<double> value;            ///< [responses x slots x numbers of samples] estimates; NaN if not known
  std::vector<double> ci_low = {};      ///< [like value] lower ends of the intervals, or empty
  std::vector<double> ci_high = {};     ///< [like value] upper ends of the intervals, or empty
  std::vector<double> half_width = {};  ///< [like value] half-widths of the intervals, or empty
  double conf_level = 0.95;             ///< confidence level of the intervals
};

/// How the adaptive sampling of a study ended (engine/run/rounds.h). A slot is one error that varies alone, or all
/// errors that vary together.
struct ConvergenceResult {
  std::size_t min = 0;          ///< least number of samples at each pose as stated; milestones() rounds it up
  std::size_t max = 0;          ///< largest number of samples at each pose
  double relative_error = 0.0;  ///< wanted half-width, divided by |quantity| (see EstimateCourse)
  /// The estimates, with half-widths, after each number of samples at which it was decided whether to continue
  /// (milestone). The last number may be `max`, where nothing has to be decided. An estimate is NaN if the sampling of
  /// its slot had ended before.
  EstimateCourse course;
  std::vector<std::uint8_t> reached;  ///< [responses x slots] 1 if the half-width at the end is small enough, else 0
  /// [responses x slots] half-width divided by |quantity| at the end; NaN for 0 / 0.
  std::vector<double> relative_half_width;
  std::vector<std::uint64_t> samples;  ///< [slots] number of samples at each pose while the errors of the slot vary
};

/// The verdict on a limit of a response (engine/run/evaluation.h). SI.
struct LimitVerdict {
  std::size_t response = 0;  ///< index in the list of responses
  ValueLimit limit = 0.0;    ///< limit that the study states
  /// Number that is compared with the limit: a magnitude for a limit on magnitudes, a spread for a limit on the spread,
  /// otherwise a value. Infinite or NaN if too few samples were solved.
  double value = 0.0;
  bool passed = false;      ///< true if the limit is kept
  std::uint64_t tried = 0;  ///< number of draws at all poses; or of machines (Judge::yield); or of rows (evaluation)
  /// Number of these draws, machines or rows that keep the limit (ValueLimit::keeps); an unsolved one does not.
  std::uint64_t within = 0;
  std::optional<std::size_t> pose = std::nullopt;  ///< pose at which `value` occurs, if it is the value at one pose
  std::optional<std::size_t> row = std::nullopt;   ///< row to which `value` belongs, for an evaluation
};

/// The verdict on the yield, for Judge::yield: the share of machines that keep all limits (ValueLimit::keeps). A
/// machine that is not solved at a pose is a reject.
struct YieldVerdict {
  /// The decision, by one-sided bounds on the yield (Clopper and Pearson) at the level conf_level.
  enum class Decision {
    not_asked,  ///< the study asks for no yield
    kept,       ///< the lower bound is at least the wanted yield
    not_kept,   ///< the upper bound is below the wanted yield
    undecided   ///< neither bound decides; there are too few machines
  };
  Decision decision = Decision::not_asked;  ///< decision on the wanted yield
  double asked = 0.0;                       ///< wanted yield; 0: none
  double conf_level = 0.95;                 ///< confidence level of the interval and of each bound
  double value = 0.0;                       ///< yield: share of the machines that are not rejects
  double ci_low = 0.0;                      ///< lower end of the two-sided interval of `value`
  double ci_high = 0.0;                     ///< upper end of the two-sided interval of `value`
  std::uint64_t machines = 0;               ///< number of machines that were tried
  std::uint64_t rejects = 0;                ///< number of machines that break a limit or are not solved at a pose
  std::uint64_t unsolved = 0;  ///< number of machines that are rejects only because they are not solved at a pose
  /// If errors are drawn from measured parts: the interval that also includes the uncertainty from the small number of
  /// parts; NaN if not known.
  std::optional<Interval> with_parts = {};
  SolveCounts solves = {};  ///< solves of the machines at all poses

  /// Whether the machines keep the wanted yield, but the interval `with_parts` does not show it.
  bool parts_leave_open() const { return decision == Decision::kept && with_parts && !(with_parts->low >= asked); }
};

/// The verdicts on all limits of a study.
struct LimitVerdicts {
  /// How draws are judged; none for an evaluation, which judges each row of its error table.
  std::optional<Judge> judge = std::nullopt;
  double share = 0.0;  ///< share of the draws at each pose that must be within the limit; only for Judge::share
  std::vector<LimitVerdict> limits;  ///< one verdict for each limit, in the order of the responses
  /// For an evaluation: the number of rows that are within all limits; none if they were not counted.
  std::optional<std::uint64_t> rows_within = std::nullopt;
  /// For Judge::yield: the verdict on all limits together. The verdicts in `limits` are then for information only.
  std::optional<YieldVerdict> yield = std::nullopt;

  /// Returns true if every limit is kept. For Judge::yield: returns false only if the yield is shown to be too low.
  bool passed() const;
};

/// Facts about one run, such as its time and its computer. The content hash of a result does not cover them.
struct RunFacts {
  std::string created;              ///< time of creation, UTC, ISO 8601
  std::string host;                 ///< name of the computer of rank 0
  std::string cpu;                  ///< name of the processor of this computer
  std::size_t threads = 1;          ///< threads of all ranks together
  std::size_t ranks = 1;            ///< processes that shared the run
  double wall_seconds = 0.0;        ///< wall time of the whole run, including the earlier runs that it continues
  double checkpoint_seconds = 0.0;  ///< part of the wall time that checkpoints took
  /// Samples that the whole run solved, including those of the earlier runs that it continues.
  std::uint64_t solves = 0;
  std::uint64_t by_series = 0;  ///< samples that the whole run computed from certified series instead of solving them

  std::uint64_t samples() const { return solves + by_series; }  ///< All samples.
};

}  // namespace poesy
