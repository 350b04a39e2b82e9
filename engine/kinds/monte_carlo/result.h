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

/// The options of a Monte Carlo study.
struct MonteCarloOptions {
  std::vector<double> quantiles{0.05, 0.5, 0.95};  ///< shares of samples below, ascending
  Judge judge = Judge::rms;  ///< how limits are judged; Judge::yield is the default with draws per machine
  double share = 0.0;        ///< for Judge::share: the share of the draws at each pose
  double yield = 0.0;        ///< for Judge::yield: the share of the machines; 0: no yield is asked for
};

/// The kind of study in which all errors vary together.
extern const StudyKind kMonteCarloStudy;

/// One number of each machine, over the machines that are solved at each pose; SI.
struct MachineValues {
  using Numbers = Array<double, axis::Response>;                    ///< a number for each response
  using Quantiles = Array<double, axis::Response, axis::Quantile>;  ///< all quantiles of each response

  Numbers mean;                                                               ///< mean over the machines
  Numbers mean_ci_low;                                                        ///< Student's interval
  Numbers mean_ci_high;                                                       ///< upper end
  Numbers std;                                                                ///< sample standard deviation
  Numbers min;                                                                ///< least value of a machine
  Numbers max;                                                                ///< largest value of a machine
  Array<std::uint64_t, axis::Response> count;                                 ///< number of machines
  Quantiles quantiles;                                                        ///< order statistics
  Quantiles quantiles_ci_low;                                                 ///< lower ends, see MonteCarloResult
  Quantiles quantiles_ci_high;                                                ///< upper ends
  Numbers quantile_error;                                                     ///< see MonteCarloResult::quantile_error
  Array<double, axis::Response, axis::HistogramEdge> histogram_edges;         ///< edges of the bins
  Array<std::uint64_t, axis::Response, axis::HistogramBin> histogram_counts;  ///< machines in each bin
};

/// The interval of the yield that also includes the uncertainty from the few parts on which errors were measured. It
/// contains the interval of the machines. NaN if the influence of parts is unknown (PartSums::interval).
struct PartsYield {
  double ci_low = 0.0;   ///< lower end
  double ci_high = 0.0;  ///< upper end
};

/// The yield: the share of machines that are within every limit at every pose. A machine that is not solved at a pose
/// is a reject unless stated otherwise. Intervals are two-sided at conf_level (Clopper and Pearson). NaN for a response
/// without a limit.
struct YieldResult {
  double conf_level = 0.95;                        ///< of all intervals
  double value = 0.0;                              ///< the yield
  double ci_low = 0.0;                             ///< lower end
  double ci_high = 0.0;                            ///< upper end
  std::uint64_t rejects = 0;                       ///< machines that are not within every limit at every pose
  std::uint64_t machines = 0;                      ///< machines that were tried
  std::uint64_t unsolved = 0;                      ///< rejects that were not solved at a pose
  double unsolved_pass = 0.0;                      ///< the yield if samples that are not solved were within every limit
  double unsolved_pass_ci_low = 0.0;               ///< lower end
  double unsolved_pass_ci_high = 0.0;              ///< upper end
  std::uint64_t unsolved_pass_rejects = 0;         ///< rejects in that case
  Array<double, axis::Response> by_response = {};  ///< share of the machines that are within this limit at every pose
  Array<double, axis::Response> by_response_ci_low = {};   ///< lower ends
  Array<double, axis::Response> by_response_ci_high = {};  ///< upper ends
  /// Share of the machines that are not within this limit at the pose.
  Array<double, axis::Response, axis::Pose> worst_pose_share = {};
  Array<double, axis::Factor> gradient = {};  ///< derivative of the yield by the sigma of each error; NaN if not known
  Array<double, axis::Factor> gradient_ci_low = {};   ///< lower ends, from the central limit theorem
  Array<double, axis::Factor> gradient_ci_high = {};  ///< upper ends
  /// Change of the yield if the sigma of an error grows by a tenth; NaN if not known. This and the following lists are
  /// empty in files of version 0.2.
  Array<double, axis::Factor> change = {};
  Array<double, axis::Factor> change_ci_low = {};   ///< lower ends
  Array<double, axis::Factor> change_ci_high = {};  ///< upper ends
  /// Share of each error in the mean square of each limited response; NaN if not known.
  Array<double, axis::Response, axis::Factor> mean_square_share = {};
  Array<double, axis::Response, axis::Factor> mean_square_share_ci_low = {};   ///< lower ends
  Array<double, axis::Response, axis::Factor> mean_square_share_ci_high = {};  ///< upper ends
  Array<double, axis::Response> linear_share =
      {};  ///< share of the mean square of the scatter that is linear in the errors

  /// Whether the file has these lists.
  /// @{
  bool has_change() const { return !change.empty() && !change_ci_low.empty() && !change_ci_high.empty(); }
  bool has_shares() const {
    return !mean_square_share.empty() && !mean_square_share_ci_low.empty() && !mean_square_share_ci_high.empty() &&
           !linear_share.empty();
  }
  /// @}
  std::optional<PartsYield> parts = {};  ///< set if errors are measured
};

/// The part of each response's scatter that each error makes alone.
struct MainEffects {
  using Indices = Array<double, axis::Response, axis::Factor>;                  ///< a number for each error
  using Curves = Array<double, axis::Response, axis::Factor, axis::EffectBin>;  ///< a curve for each error

  Indices s1;          ///< first-order index
  Indices s1_ci_low;   ///< lower ends
  Indices s1_ci_high;  ///< upper ends
  Curves mean;         ///< mean of the response while the error is in the bin
  Curves ci_low;       ///< lower ends
  Curves ci_high;      ///< upper ends
};

/// The additional result of a Monte Carlo study with draws per machine.
struct MachineResult {
  double conf_level = 0.95;          ///< of all intervals
  MachineValues largest;             ///< the largest magnitude of each machine over the poses
  MachineValues rms;                 ///< the root mean square of each machine over the poses
  std::optional<YieldResult> yield;  ///< set if the study states limits
  MainEffects effects_on_largest;    ///< main effects on the machines' largest magnitudes
};

/// First-order indices and main effects, which every Monte Carlo study computes.
struct EffectResult {
  double conf_level = 0.95;                                ///< of all intervals
  std::vector<std::uint64_t> s1_poses;                     ///< the poses over which effects.s1 sums
  Array<double, axis::Factor, axis::EffectBin> bin_error;  ///< [P x bins] mean of the error in its bin
  /// Curves are of the machines' means over all poses, or with draws per pose of all samples at s1_poses.
  MainEffects effects;
};

/// The result of a Monte Carlo study, in which all errors vary together; SI; NaN where undefined. The overall numbers
/// are over the samples of all poses together.
struct MonteCarloResult {
  using AtPoses = Array<double, axis::Response, axis::Pose>;                           ///< a number at each pose
  using QuantilesAtPoses = Array<double, axis::Response, axis::Pose, axis::Quantile>;  ///< all quantiles at each pose
  using Overall = MachineValues::Numbers;                                              ///< a number for each response
  using OverallQuantiles = MachineValues::Quantiles;  ///< all quantiles of each response

  double conf_level = 0.95;              ///< of all intervals
  double quantile_relative_error = 0.0;  ///< bound on |quantile - order statistic| / |order statistic| of any quantile
  std::vector<double> levels;            ///< share of the samples below each quantile

  AtPoses mean;                                            ///< over the samples
  AtPoses mean_ci_low;                                     ///< Student's interval
  AtPoses mean_ci_high;                                    ///< upper end
  AtPoses std;                                             ///< sample standard deviation
  AtPoses min;                                             ///< least sample
  AtPoses max;                                             ///< largest sample
  Array<std::uint64_t, axis::Response, axis::Pose> count;  ///< number of samples
  QuantilesAtPoses quantiles;                              ///< order statistics
  AtPoses rms;                                             ///< root mean square
  /// Interval of the distribution's quantile (stats/buckets.h). An end is infinite if the samples are too few for it.
  QuantilesAtPoses quantiles_ci_low;
  QuantilesAtPoses quantiles_ci_high;  ///< upper ends
  /// Bound on |quantile - order statistic| of each quantile at the pose; empty in results of version 0.2.
  AtPoses quantile_error;
  /// The magnitude that a share of the draws stays within, if limits are judged by that share, else empty. Draws that
  /// do not count exceed every magnitude; infinite if they are too many. For a response whose limit has other ends: the
  /// value of the draw that is worst of that share (value_at_rank); NaN if too many draws do not count.
  AtPoses share_magnitude;

  Overall overall_mean;                                ///< the same as mean, for the samples of all poses
  Overall overall_std;                                 ///< the same as std
  Overall overall_min;                                 ///< the same as min
  Overall overall_max;                                 ///< the same as max
  Array<std::uint64_t, axis::Response> overall_count;  ///< the same as count
  OverallQuantiles overall_quantiles;                  ///< the same as quantiles
  Overall overall_rms;                                 ///< the same as rms
  OverallQuantiles overall_quantiles_ci_low;           ///< the same as quantiles_ci_low
  OverallQuantiles overall_quantiles_ci_high;          ///< the same as quantiles_ci_high
  Overall overall_quantile_error;                      ///< the same as quantile_error
  /// Edges of a histogram of the samples of all poses (stats/buckets.h).
  Array<double, axis::Response, axis::HistogramEdge> histogram_edges;
  Array<std::uint64_t, axis::Response, axis::HistogramBin> histogram_counts;  ///< samples in each bin
  std::vector<SolveCounts> solves;                                            ///< [M]
  std::vector<Failure> failures;  ///< the first, in the order of poses and samples
  /// Set if the study has adaptive samples.
  std::optional<ConvergenceResult> convergence;
  /// Set if the study states limits.
  std::optional<LimitVerdicts> verdicts;

  Array<std::uint8_t, axis::Response> varies;  ///< whether the response is more than rounding, 0 or 1; empty if all are
  EffectResult effects;                        ///< first-order indices
  /// Set if errors are drawn per machine.
  std::optional<MachineResult> machines;

  std::size_t responses() const { return overall_mean.size(); }  ///< The number of responses.
  std::size_t poses() const { return solves.size(); }            ///< The number of poses.
  SolveCounts total() const { return total_of(solves); }         ///< The solves at all poses.
};

/// Bytes of the numbers of a result with axes of these lengths. machines: whether errors are drawn per machine.
std::size_t monte_carlo_bytes(const AxisLengths& lengths, bool machines);

/// The Monte Carlo result in a stored result; StoredResult has its failures, convergence and verdicts.
/// Precondition: the result is of that kind.
inline const MonteCarloResult& monte_carlo_of(const StoredResult& result) { return found_of<MonteCarloResult>(result); }

/// For each response a table of mean, spread, extremes and quantiles over the samples of all poses, then one of the
/// mean of the poses' means, and the largest mean and highest quantile with their poses.
std::vector<Table> monte_carlo_tables(const StoredResult& result, const TableOptions& options = {});

}  // namespace poesy
