#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <vector>

#include "engine/report/tables.h"
#include "engine/result/result_file.h"
#include "engine/run/result.h"
#include "engine/study/study.h"

namespace poesy {

/// What a Monte Carlo study alone asks.
struct MonteCarloOptions {
  std::vector<double> quantiles{0.05, 0.5, 0.95};  ///< shares of samples below, ascending
  Judge judge = Judge::rms;                        ///< of the limits; yield where a study with machines says nothing
  double share = 0.0;                              ///< for Judge::share: of the draws at each pose
  double yield = 0.0;                              ///< for Judge::yield: of the machines; 0: none is asked for
};

/// The kind of study in which all errors vary together.
extern const StudyKind kMonteCarloStudy;

/// One number of each machine: over those that are solved at each pose. R responses, Q quantiles, B bins; SI.
struct MachineValues {
  std::vector<double> mean;                     ///< [R] over the machines
  std::vector<double> mean_ci_low;              ///< [R] Student's interval
  std::vector<double> mean_ci_high;             ///< [R] likewise
  std::vector<double> std;                      ///< [R] sample standard deviation
  std::vector<double> min;                      ///< [R]
  std::vector<double> max;                      ///< [R]
  std::vector<std::uint64_t> count;             ///< [R] machines behind these
  std::vector<double> quantiles;                ///< [R x Q]
  std::vector<double> quantiles_ci_low;         ///< [R x Q] as MonteCarloResult has them
  std::vector<double> quantiles_ci_high;        ///< [R x Q] likewise
  std::vector<double> quantile_error;           ///< [R] as MonteCarloResult has it
  std::vector<double> histogram_edges;          ///< [R x (B + 1)]
  std::vector<std::uint64_t> histogram_counts;  ///< [R x B]
};

/// What a yield may be, as far as the few parts tell on which errors were measured: an interval that holds the one of
/// the machines. NaN where the rejects do not say how much a part weighs (PartSums::interval).
struct PartsYield {
  double ci_low = 0.0;   ///< of the yield
  double ci_high = 0.0;  ///< of it
};

/// The share of machines that are within every limit at every pose. A machine that is not solved at a pose is a reject,
/// unless said otherwise. Intervals: Clopper and Pearson, two-sided, at conf_level. NaN for a response without a limit.
struct YieldResult {
  double conf_level = 0.95;                      ///< of all intervals
  double value = 0.0;                            ///< the yield
  double ci_low = 0.0;                           ///< of it
  double ci_high = 0.0;                          ///< of it
  std::uint64_t rejects = 0;                     ///< machines that are not within every limit at every pose
  std::uint64_t machines = 0;                    ///< that were tried
  std::uint64_t unsolved = 0;                    ///< of these, those with a pose that is not solved
  double unsolved_pass = 0.0;                    ///< the yield if samples that are not solved were within every limit
  double unsolved_pass_ci_low = 0.0;             ///< of it
  double unsolved_pass_ci_high = 0.0;            ///< of it
  std::uint64_t unsolved_pass_rejects = 0;       ///< then
  std::vector<double> by_response = {};          ///< [R] share of the machines that are within this limit at every pose
  std::vector<double> by_response_ci_low = {};   ///< [R]
  std::vector<double> by_response_ci_high = {};  ///< [R]
  std::vector<double> worst_pose_share =
      {};                             ///< [R x M] share of the machines that are not within this limit at the pose
  std::vector<double> gradient = {};  ///< [P] of the yield by the sigma of each error; NaN where it is not known
  std::vector<double> gradient_ci_low = {};   ///< [P] central limit theorem
  std::vector<double> gradient_ci_high = {};  ///< [P]
  /// [P] what the yield changes by if the sigma of an error grows by a tenth; NaN as the gradient. This and the lists
  /// that follow are empty where a file of version 0.2 was read.
  std::vector<double> change = {};
  std::vector<double> change_ci_low = {};              ///< [P]
  std::vector<double> change_ci_high = {};             ///< [P]
  std::vector<double> mean_square_share = {};          ///< [R x P] of each limited response; NaN where not known
  std::vector<double> mean_square_share_ci_low = {};   ///< [R x P]
  std::vector<double> mean_square_share_ci_high = {};  ///< [R x P]
  std::vector<double> linear_share = {};  ///< [R] of the mean square of the scatter, what is linear in the errors

  /// Whether these lists are there.
  /// @{
  bool has_change() const { return !change.empty() && !change_ci_low.empty() && !change_ci_high.empty(); }
  bool has_shares() const {
    return !mean_square_share.empty() && !mean_square_share_ci_low.empty() && !mean_square_share_ci_high.empty() &&
           !linear_share.empty();
  }
  /// @}
  std::optional<PartsYield> parts = {};  ///< where errors are measured
};

/// How much of the scatter of each response an error makes alone: P errors, E bins.
struct MainEffects {
  std::vector<double> s1;          ///< [R x P] first-order index
  std::vector<double> s1_ci_low;   ///< [R x P]
  std::vector<double> s1_ci_high;  ///< [R x P]
  std::vector<double> mean;        ///< [R x P x E] of the response while the error is in the bin
  std::vector<double> ci_low;      ///< [R x P x E]
  std::vector<double> ci_high;     ///< [R x P x E]
};

/// What a Monte Carlo study of machines found in addition.
struct MachineResult {
  double conf_level = 0.95;          ///< of all intervals
  MachineValues largest;             ///< of each machine its largest magnitude over the poses
  MachineValues rms;                 ///< of each machine its root mean square over the poses
  std::optional<YieldResult> yield;  ///< where the study states limits
  MainEffects effects_on_largest;    ///< of the machines' largest magnitudes
};

/// First-order indices and main effects that every Monte Carlo study finds.
struct EffectResult {
  double conf_level = 0.95;             ///< of all intervals
  std::vector<std::uint64_t> s1_poses;  ///< over which effects.s1 adds up
  std::vector<double> bin_error;        ///< [P x E] mean of the error in its bin
  /// Curves: of the machines' means over all poses; with draws per pose of all samples at s1_poses.
  MainEffects effects;
};

/// What a Monte Carlo study found, all errors varying together: R responses, M poses, Q quantiles; SI; NaN where
/// undefined. The overall numbers are over the samples of all poses together.
struct MonteCarloResult {
  std::size_t responses = 0;             ///< R
  std::size_t poses = 0;                 ///< M
  double conf_level = 0.95;              ///< of all intervals
  double quantile_relative_error = 0.0;  ///< bound on |quantile - order statistic| / |order statistic| of any quantile
  std::vector<double> levels;            ///< [Q] share of the samples below each quantile

  std::vector<double> mean;          ///< [R x M]
  std::vector<double> mean_ci_low;   ///< [R x M]
  std::vector<double> mean_ci_high;  ///< [R x M]
  std::vector<double> std;           ///< [R x M]
  std::vector<double> min;           ///< [R x M]
  std::vector<double> max;           ///< [R x M]
  std::vector<std::uint64_t> count;  ///< [R x M] samples behind these
  std::vector<double> quantiles;     ///< [R x M x Q]
  std::vector<double> rms;           ///< [R x M] root mean square
  /// [R x M x Q] interval of the distribution's quantile (stats/buckets.h), an end infinite where the samples
  /// are too few for it.
  std::vector<double> quantiles_ci_low;
  std::vector<double> quantiles_ci_high;  ///< likewise
  /// [R x M] bound on |quantile - order statistic| of each quantile at the pose; empty in results of version 0.2.
  std::vector<double> quantile_error;
  /// [R x M] where limits are judged by a share of the draws, else empty: the magnitude within which that share of them
  /// stays. Draws that do not count never stay within anything; infinite where they are too many.
  std::vector<double> share_magnitude;

  std::vector<double> overall_mean;               ///< [R]
  std::vector<double> overall_std;                ///< [R]
  std::vector<double> overall_min;                ///< [R]
  std::vector<double> overall_max;                ///< [R]
  std::vector<std::uint64_t> overall_count;       ///< [R]
  std::vector<double> overall_quantiles;          ///< [R x Q]
  std::vector<double> overall_rms;                ///< [R]
  std::vector<double> overall_quantiles_ci_low;   ///< [R x Q]
  std::vector<double> overall_quantiles_ci_high;  ///< [R x Q] likewise
  std::vector<double> overall_quantile_error;     ///< [R] as quantile_error
  /// Histograms of the samples of all poses (stats/buckets.h), B bins each.
  std::vector<double> histogram_edges;          ///< [R x (B + 1)]
  std::vector<std::uint64_t> histogram_counts;  ///< [R x B]
  std::vector<SolveCounts> solves;              ///< [M]
  std::vector<Failure> failures;                ///< the first, in the order of poses and samples
  /// Where the study has adaptive samples.
  std::optional<ConvergenceResult> convergence;
  /// Where it states limits.
  std::optional<LimitVerdicts> verdicts;

  std::vector<std::uint8_t> varies;  ///< [R] whether it is more than rounding: 0 or 1; empty where all are
  EffectResult effects;              ///< first-order indices
  /// Where errors are drawn per machine.
  std::optional<MachineResult> machines;

  /// Over all poses.
  SolveCounts total() const { return total_of(solves); }
};

/// What a Monte Carlo study found, read back: its failures, convergence and verdicts are those of StoredResult.
/// Precondition: a Monte Carlo result.
inline const MonteCarloResult& monte_carlo_of(const StoredResult& result) { return found_of<MonteCarloResult>(result); }

/// Per response mean, spread, extremes and quantiles over the samples of all poses
/// together; then the mean of the poses' means, and the largest mean and highest quantile with the pose where it is.
std::vector<Table> monte_carlo_tables(const StoredResult& result, const TableOptions& options = {});

}  // namespace poesy
