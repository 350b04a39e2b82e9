#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string_view>
#include <vector>

#include "engine/base/array.h"
#include "engine/report/tables.h"
#include "engine/result/fields.h"
#include "engine/result/result_file.h"
#include "engine/run/result.h"
#include "engine/study/study.h"

namespace poesy {

namespace axis {
using Quantile = Axis<"quantile">;     ///< Quantiles that a study asks for.
using HistogramBin = Axis<"bin">;      ///< Bins of a histogram.
using HistogramEdge = Axis<"edge">;    ///< Where the bins of a histogram begin and end.
using EffectBin = Axis<"effect_bin">;  ///< Bins of equal probability of an error.
}  // namespace axis

/// What a Monte Carlo study alone asks.
struct MonteCarloOptions {
  std::vector<double> quantiles{0.05, 0.5, 0.95};  ///< shares of samples below, ascending
  Judge judge = Judge::rms;                        ///< of the limits; yield where a study with machines says nothing
  double share = 0.0;                              ///< for Judge::share: of the draws at each pose
  double yield = 0.0;                              ///< for Judge::yield: of the machines; 0: none is asked for
};

/// The kind of study in which all errors vary together.
extern const StudyKind kMonteCarloStudy;

/// One number of each machine: over those that are solved at each pose. SI.
struct MachineValues {
  using Numbers = Array<double, axis::Response>;                    ///< one for each response
  using Quantiles = Array<double, axis::Response, axis::Quantile>;  ///< all of each response

  Numbers mean;                                                               ///< over the machines
  Numbers mean_ci_low;                                                        ///< Student's interval
  Numbers mean_ci_high;                                                       ///< likewise
  Numbers std;                                                                ///< sample standard deviation
  Numbers min;                                                                ///< of any machine
  Numbers max;                                                                ///< of any machine
  Array<std::uint64_t, axis::Response> count;                                 ///< machines behind these
  Quantiles quantiles;                                                        ///< order statistics
  Quantiles quantiles_ci_low;                                                 ///< as MonteCarloResult has them
  Quantiles quantiles_ci_high;                                                ///< likewise
  Numbers quantile_error;                                                     ///< as MonteCarloResult has it
  Array<double, axis::Response, axis::HistogramEdge> histogram_edges;         ///< of the bins
  Array<std::uint64_t, axis::Response, axis::HistogramBin> histogram_counts;  ///< machines in each bin
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
  double conf_level = 0.95;                        ///< of all intervals
  double value = 0.0;                              ///< the yield
  double ci_low = 0.0;                             ///< of it
  double ci_high = 0.0;                            ///< of it
  std::uint64_t rejects = 0;                       ///< machines that are not within every limit at every pose
  std::uint64_t machines = 0;                      ///< that were tried
  std::uint64_t unsolved = 0;                      ///< of these, those with a pose that is not solved
  double unsolved_pass = 0.0;                      ///< the yield if samples that are not solved were within every limit
  double unsolved_pass_ci_low = 0.0;               ///< of it
  double unsolved_pass_ci_high = 0.0;              ///< of it
  std::uint64_t unsolved_pass_rejects = 0;         ///< then
  Array<double, axis::Response> by_response = {};  ///< share of the machines that are within this limit at every pose
  Array<double, axis::Response> by_response_ci_low = {};   ///< lower ends
  Array<double, axis::Response> by_response_ci_high = {};  ///< upper ends
  /// Share of the machines that are not within this limit at the pose.
  Array<double, axis::Response, axis::Pose> worst_pose_share = {};
  Array<double, axis::Factor> gradient = {};  ///< of the yield by the sigma of each error; NaN where it is not known
  Array<double, axis::Factor> gradient_ci_low = {};   ///< central limit theorem
  Array<double, axis::Factor> gradient_ci_high = {};  ///< likewise
  /// What the yield changes by if the sigma of an error grows by a tenth; NaN as the gradient. This and the lists that
  /// follow are empty where a file of version 0.2 was read.
  Array<double, axis::Factor> change = {};
  Array<double, axis::Factor> change_ci_low = {};   ///< lower ends
  Array<double, axis::Factor> change_ci_high = {};  ///< upper ends
  /// Of each limited response; NaN where not known.
  Array<double, axis::Response, axis::Factor> mean_square_share = {};
  Array<double, axis::Response, axis::Factor> mean_square_share_ci_low = {};   ///< lower ends
  Array<double, axis::Response, axis::Factor> mean_square_share_ci_high = {};  ///< upper ends
  Array<double, axis::Response> linear_share = {};  ///< of the mean square of the scatter, what is linear in the errors

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

/// How much of the scatter of each response an error makes alone.
struct MainEffects {
  using Indices = Array<double, axis::Response, axis::Factor>;                  ///< one of each error
  using Curves = Array<double, axis::Response, axis::Factor, axis::EffectBin>;  ///< one of each error

  Indices s1;          ///< first-order index
  Indices s1_ci_low;   ///< lower ends
  Indices s1_ci_high;  ///< upper ends
  Curves mean;         ///< of the response while the error is in the bin
  Curves ci_low;       ///< lower ends
  Curves ci_high;      ///< upper ends
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
  double conf_level = 0.95;                                ///< of all intervals
  std::vector<std::uint64_t> s1_poses;                     ///< over which effects.s1 adds up
  Array<double, axis::Factor, axis::EffectBin> bin_error;  ///< mean of the error in its bin
  /// Curves: of the machines' means over all poses; with draws per pose of all samples at s1_poses.
  MainEffects effects;
};

/// What a Monte Carlo study found, all errors varying together; SI; NaN where undefined. The overall numbers are over
/// the samples of all poses together.
struct MonteCarloResult {
  using AtPoses = Array<double, axis::Response, axis::Pose>;                           ///< a number at each pose
  using QuantilesAtPoses = Array<double, axis::Response, axis::Pose, axis::Quantile>;  ///< all at each pose
  using Overall = MachineValues::Numbers;                                              ///< a number of each response
  using OverallQuantiles = MachineValues::Quantiles;                                   ///< all of each response

  double conf_level = 0.95;              ///< of all intervals
  double quantile_relative_error = 0.0;  ///< bound on |quantile - order statistic| / |order statistic| of any quantile
  std::vector<double> levels;            ///< share of the samples below each quantile

  AtPoses mean;                                            ///< over the samples
  AtPoses mean_ci_low;                                     ///< Student's interval
  AtPoses mean_ci_high;                                    ///< likewise
  AtPoses std;                                             ///< sample standard deviation
  AtPoses min;                                             ///< of the samples
  AtPoses max;                                             ///< of the samples
  Array<std::uint64_t, axis::Response, axis::Pose> count;  ///< samples behind these
  QuantilesAtPoses quantiles;                              ///< order statistics
  AtPoses rms;                                             ///< root mean square
  /// Interval of the distribution's quantile (stats/buckets.h), an end infinite where the samples are too few for it.
  QuantilesAtPoses quantiles_ci_low;
  QuantilesAtPoses quantiles_ci_high;  ///< likewise
  /// Bound on |quantile - order statistic| of each quantile at the pose; empty in results of version 0.2.
  AtPoses quantile_error;
  /// Where limits are judged by a share of the draws, else empty: the magnitude within which that share of them stays.
  /// Draws that do not count never stay within anything; infinite where they are too many.
  AtPoses share_magnitude;

  Overall overall_mean;                                ///< as mean
  Overall overall_std;                                 ///< as std
  Overall overall_min;                                 ///< as min
  Overall overall_max;                                 ///< as max
  Array<std::uint64_t, axis::Response> overall_count;  ///< as count
  OverallQuantiles overall_quantiles;                  ///< as quantiles
  Overall overall_rms;                                 ///< as rms
  OverallQuantiles overall_quantiles_ci_low;           ///< as quantiles_ci_low
  OverallQuantiles overall_quantiles_ci_high;          ///< likewise
  Overall overall_quantile_error;                      ///< as quantile_error
  /// Of a histogram of the samples of all poses (stats/buckets.h).
  Array<double, axis::Response, axis::HistogramEdge> histogram_edges;
  Array<std::uint64_t, axis::Response, axis::HistogramBin> histogram_counts;  ///< samples in each bin
  std::vector<SolveCounts> solves;                                            ///< of each pose
  std::vector<Failure> failures;  ///< the first, in the order of poses and samples
  /// Where the study has adaptive samples.
  std::optional<ConvergenceResult> convergence;
  /// Where it states limits.
  std::optional<LimitVerdicts> verdicts;

  Array<std::uint8_t, axis::Response> varies;  ///< whether it is more than rounding: 0 or 1; empty where all are
  EffectResult effects;                        ///< first-order indices
  /// Where errors are drawn per machine.
  std::optional<MachineResult> machines;

  std::size_t responses() const { return overall_mean.size(); }  ///< Number of them.
  std::size_t poses() const { return solves.size(); }            ///< Number of them.
  SolveCounts total() const { return total_of(solves); }         ///< Over all poses.
};

/// Bytes of the numbers of a result whose axes have these lengths. machines: whether errors are drawn per machine.
std::size_t monte_carlo_bytes(const AxisLengths& lengths, bool machines);

/// What a Monte Carlo study found, read back: its failures, convergence and verdicts are those of StoredResult.
/// Precondition: a Monte Carlo result.
inline const MonteCarloResult& monte_carlo_of(const StoredResult& result) { return found_of<MonteCarloResult>(result); }

/// Per response mean, spread, extremes and quantiles over the samples of all poses
/// together; then the mean of the poses' means, and the largest mean and highest quantile with the pose where it is.
std::vector<Table> monte_carlo_tables(const StoredResult& result, const TableOptions& options = {});

}  // namespace poesy
