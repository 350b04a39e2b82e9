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

namespace poesy::axis {

using Quantile = Axis<"quantile">;     ///< Quantiles that a study asks for.
using HistogramBin = Axis<"bin">;      ///< Bins of a histogram.
using HistogramEdge = Axis<"edge">;    ///< Edges of the bins of a histogram.
using EffectBin = Axis<"effect_bin">;  ///< Bins of an error's values, all of equal probability.

}  // namespace poesy::axis

namespace poesy::monte_carlo {

/// The options of a Monte Carlo study.
struct Options {
  std::vector<double> quantiles{0.05, 0.5, 0.95};  ///< levels of the quantiles that are computed, ascending
  Judge judge = Judge::rms;  ///< how limits are judged; with draws per machine, the default is Judge::yield
  double share = 0.0;        ///< share of the draws that must be within a limit at each pose; only for Judge::share
  double yield = 0.0;  ///< share of the machines that must be good, for Judge::yield; 0 if the study asks for no yield
};

/// The kind of study in which all errors vary together, `monte-carlo`.
extern const StudyKind kStudy;

/// The distribution over the machines of a number that each machine has, such as its largest magnitude; SI. Machines
/// that are not solved at every pose are left out.
struct MachineValues {
  using Numbers = Array<double, axis::Response>;                    ///< a number for each response
  using Quantiles = Array<double, axis::Response, axis::Quantile>;  ///< all quantiles of each response

  Numbers mean;  ///< mean over the machines
  /// Lower end of Student's interval of the mean.
  Numbers mean_ci_low;
  Numbers mean_ci_high;                        ///< upper end of that interval
  Numbers std;                                 ///< sample standard deviation
  Numbers min;                                 ///< smallest value
  Numbers max;                                 ///< largest value
  Array<std::uint64_t, axis::Response> count;  ///< number of machines
  Quantiles quantiles;                         ///< quantiles, as order statistics
  /// Lower ends of the intervals of quantiles; infinite if there are too few machines for an end.
  Quantiles quantiles_ci_low;
  Quantiles quantiles_ci_high;  ///< upper ends of the intervals of quantiles
  Numbers quantile_error;  ///< bound on |quantile - order statistic| for all quantiles; empty in results of version 0.2
  Array<double, axis::Response, axis::HistogramEdge> histogram_edges;         ///< edges of the histogram's bins
  Array<std::uint64_t, axis::Response, axis::HistogramBin> histogram_counts;  ///< number of machines in each bin
};

/// The interval of the yield that also includes the uncertainty from the few parts on which errors were measured. It
/// contains the interval of YieldResult. NaN if the influence of parts is unknown (PartSums::interval).
struct PartsYield {
  double ci_low = 0.0;   ///< lower end of the interval
  double ci_high = 0.0;  ///< upper end of the interval
};

/// The yield: the share of machines that are within every limit at every pose. Unless stated otherwise, a machine that
/// is not solved at some pose is a reject. Members NAME_ci_low and NAME_ci_high are the ends of the two-sided interval
/// of NAME at conf_level; those of yields are by Clopper and Pearson. Numbers of a response without a limit are NaN.
struct YieldResult {
  double conf_level = 0.95;            ///< confidence level of all intervals
  double value = 0.0;                  ///< the yield, an estimate
  double ci_low = 0.0;                 ///< lower end of the interval of the yield
  double ci_high = 0.0;                ///< upper end of the interval of the yield
  std::uint64_t rejects = 0;           ///< number of machines that are not within every limit at every pose
  std::uint64_t machines = 0;          ///< number of machines that were tried
  std::uint64_t unsolved = 0;          ///< number of rejects that were not solved at some pose
  double unsolved_pass = 0.0;          ///< yield if samples that are not solved count as within every limit
  double unsolved_pass_ci_low = 0.0;   ///< lower end of the interval of unsolved_pass
  double unsolved_pass_ci_high = 0.0;  ///< upper end of the interval of unsolved_pass
  /// Number of rejects if a sample that is not solved counted as within every limit.
  std::uint64_t unsolved_pass_rejects = 0;
  /// Share of machines that keep the limit of the response at every pose.
  Array<double, axis::Response> by_response = {};
  Array<double, axis::Response> by_response_ci_low = {};   ///< lower ends of the intervals of by_response
  Array<double, axis::Response> by_response_ci_high = {};  ///< upper ends of the intervals of by_response
  /// Share of machines that break the limit of the response and that, at this pose, are beyond the limit or not solved.
  /// NaN for a limit on the spread over the poses.
  Array<double, axis::Response, axis::Pose> worst_pose_share = {};
  /// Derivative of the yield with respect to the sigma of each error, 1/m or 1/rad; NaN if not known.
  Array<double, axis::Factor> gradient = {};
  /// Lower ends of the intervals of gradient, by the central limit theorem.
  Array<double, axis::Factor> gradient_ci_low = {};
  Array<double, axis::Factor> gradient_ci_high = {};  ///< upper ends of the intervals of gradient
  /// Change of the yield if the sigma of an error grows by a tenth; NaN if not known. Files of version 0.2 do not have
  /// this list and the following ones.
  Array<double, axis::Factor> change = {};
  Array<double, axis::Factor> change_ci_low = {};   ///< lower ends of the intervals of change
  Array<double, axis::Factor> change_ci_high = {};  ///< upper ends of the intervals of change
  /// Standard deviation that `change` would have by chance if the error had no effect; NaN if not known, as for changes
  /// by a linear map (MappedGradient).
  Array<double, axis::Factor> change_sd_without_effect = {};
  /// Share of each error in the scatter of each limited response (the mean square of the response about its mean over
  /// the machines, over all poses); NaN if not known.
  Array<double, axis::Response, axis::Factor> mean_square_share = {};
  /// Lower ends of the intervals of mean_square_share.
  Array<double, axis::Response, axis::Factor> mean_square_share_ci_low = {};
  /// Upper ends of the intervals of mean_square_share.
  Array<double, axis::Response, axis::Factor> mean_square_share_ci_high = {};
  Array<double, axis::Response> linear_share = {};  ///< share of the scatter that is linear in the errors
  /// Mean of each limited response over the machines (for a norm: of its vector), as a root mean square over the poses.
  /// NaN if not known. Files of version 0.2 do not have this list and the next one.
  Array<double, axis::Response> offset = {};
  Array<double, axis::Response> offset_share = {};  ///< share of the squared offset in the whole mean square

  /// Whether the result has the lists of the changes of the yield, of the shares, and of the offsets.
  /// @{
  bool has_change() const { return !change.empty() && !change_ci_low.empty() && !change_ci_high.empty(); }
  bool has_shares() const {
    return !mean_square_share.empty() && !mean_square_share_ci_low.empty() && !mean_square_share_ci_high.empty() &&
           !linear_share.empty();
  }
  bool has_offset() const { return !offset.empty() && !offset_share.empty(); }
  /// @}
  std::optional<PartsYield> parts = {};  ///< interval with the uncertainty from few parts; set if errors are measured
};

/// The effect of each error on each response, without interactions with other errors.
struct MainEffects {
  /// A number for each response and error.
  using Indices = Array<double, axis::Response, axis::Factor>;
  using Curves = Array<double, axis::Response, axis::Factor, axis::EffectBin>;  ///< a curve for each response and error

  Indices s1;          ///< first-order index: share of the variance that the error causes without interactions
  Indices s1_ci_low;   ///< lower ends of the intervals of s1
  Indices s1_ci_high;  ///< upper ends of the intervals of s1
  Curves mean;         ///< mean of the response if the error is in the bin
  Curves ci_low;       ///< lower ends of the intervals of mean
  Curves ci_high;      ///< upper ends of the intervals of mean
};

/// Yields that the calibrated machines would have without calibration, and with the best correction. The yield with
/// calibration is in YieldResult.
struct CalibrationYields {
  double uncalibrated = 0.0;          ///< yield without calibration
  double uncalibrated_ci_low = 0.0;   ///< lower end of the interval of uncalibrated
  double uncalibrated_ci_high = 0.0;  ///< upper end of the interval of uncalibrated
  /// Yield after the best correction by the actuators at each pose; NaN if the model cannot compute it.
  double best = 0.0;
  double best_ci_low = 0.0;          ///< lower end of the interval of best
  double best_ci_high = 0.0;         ///< upper end of the interval of best
  std::uint64_t not_fitted = 0;      ///< number of rejects that were not calibrated: they were not solved, or their fit
                                     ///< did not converge
  std::uint64_t fitted = 0;          ///< number of fitted errors of each machine
  std::uint64_t measured = 0;        ///< number of measured values of each machine
  std::uint64_t measured_poses = 0;  ///< number of poses at which each machine is measured
};

/// The additional result of a Monte Carlo study with draws per machine.
struct MachineResult {
  double conf_level = 0.95;                      ///< confidence level of all intervals
  MachineValues largest;                         ///< largest magnitude of a response over the poses, for each machine
  MachineValues rms;                             ///< root mean square of a response over the poses, for each machine
  std::optional<YieldResult> yield;              ///< yield; set if the study states limits
  std::optional<CalibrationYields> calibration;  ///< yields without calibration; set if machines are calibrated and the
                                                 ///< study states limits
  MainEffects effects_on_largest;                ///< main effects on the largest magnitudes of the machines
};

/// First-order indices and main effects, which every Monte Carlo study computes.
struct EffectResult {
  double conf_level = 0.95;             ///< confidence level of all intervals
  std::vector<std::uint64_t> s1_poses;  ///< poses over which the variances of `effects.s1` are summed
  Array<double, axis::Factor, axis::EffectBin> bin_error;  ///< mean of the error in each bin, SI
  /// Indices and curves. With draws per machine, the curves show the mean of each machine over all poses; with draws
  /// per pose, they show all samples at `s1_poses`.
  MainEffects effects;
};

/// The result of a Monte Carlo study, in which all errors vary together; SI; NaN where undefined. Numbers named
/// `overall` are over the samples of all poses together. `ci_low` and `ci_high` are the ends of confidence intervals.
struct Result {
  using AtPoses = Array<double, axis::Response, axis::Pose>;                           ///< a number at each pose
  using QuantilesAtPoses = Array<double, axis::Response, axis::Pose, axis::Quantile>;  ///< all quantiles at each pose
  using Overall = MachineValues::Numbers;                                              ///< a number for each response
  using OverallQuantiles = MachineValues::Quantiles;  ///< all quantiles of each response

  double conf_level = 0.95;              ///< confidence level of all intervals
  double quantile_relative_error = 0.0;  ///< bound on |quantile - order statistic| / |order statistic|, for all
                                         ///< quantiles
  std::vector<double> levels;            ///< levels of the quantiles

  AtPoses mean;                                            ///< mean of the samples
  AtPoses mean_ci_low;                                     ///< lower end of Student's interval of the mean
  AtPoses mean_ci_high;                                    ///< upper end of that interval
  AtPoses std;                                             ///< sample standard deviation
  AtPoses min;                                             ///< smallest sample
  AtPoses max;                                             ///< largest sample
  Array<std::uint64_t, axis::Response, axis::Pose> count;  ///< number of samples that count in statistics
  QuantilesAtPoses quantiles;                              ///< quantiles, as order statistics
  AtPoses rms;                                             ///< root mean square
  /// Lower ends of the quantiles' intervals (stats/buckets.h). An end is infinite if there are too few samples for it.
  QuantilesAtPoses quantiles_ci_low;
  QuantilesAtPoses quantiles_ci_high;  ///< upper ends of the quantiles' intervals
  /// Bound on |quantile - order statistic| for all quantiles at the pose; empty in results of version 0.2.
  AtPoses quantile_error;
  /// For Judge::share, the magnitude that the asked share of the draws does not exceed; otherwise empty. A draw that
  /// does not count in statistics (counts()) is taken to exceed every magnitude, so the value is infinite if there are
  /// too many of them. For a limit that is not on magnitudes: the worst value within that share (value_at_rank), or NaN
  /// if too many draws do not count.
  AtPoses share_magnitude;

  Overall overall_mean;  ///< mean over the samples of all poses
  Overall overall_std;   ///< sample standard deviation over all poses
  Overall overall_min;   ///< smallest sample of all poses
  Overall overall_max;   ///< largest sample of all poses
  /// Number of samples that count in statistics (counts()), at all poses together.
  Array<std::uint64_t, axis::Response> overall_count;
  OverallQuantiles overall_quantiles;          ///< quantiles over all poses
  Overall overall_rms;                         ///< root mean square over all poses
  OverallQuantiles overall_quantiles_ci_low;   ///< lower ends of the intervals of overall quantiles
  OverallQuantiles overall_quantiles_ci_high;  ///< upper ends of the intervals of overall quantiles
  Overall overall_quantile_error;  ///< bound on |quantile - order statistic| for all quantiles over all poses; empty in
                                   ///< results of version 0.2
  /// Edges of the bins in a histogram of the samples of all poses (stats/buckets.h).
  Array<double, axis::Response, axis::HistogramEdge> histogram_edges;
  Array<std::uint64_t, axis::Response, axis::HistogramBin> histogram_counts;  ///< number of samples in each bin
  std::vector<SolveCounts> solves;  ///< [poses] how the solves at each pose ended
  std::vector<Failure> failures;    ///< the first failed samples, ordered by pose and sample
  /// The estimates after each round of adaptive samples. Set if the study has adaptive samples.
  std::optional<ConvergenceResult> convergence;
  /// The verdicts on limits. Set if the study states limits.
  std::optional<LimitVerdicts> verdicts;

  Array<std::uint8_t, axis::Response> varies;  ///< 1 if the response varies by more than rounding, otherwise 0; empty
                                               ///< if all vary
  EffectResult effects;                        ///< first-order indices and main effects
  /// Results for machines. Set if errors are drawn per machine.
  std::optional<MachineResult> machines;
  /// 1 if the machine is rejected, otherwise 0, for the first MachineTable::kept() machines. Not part of a result file.
  std::vector<std::uint8_t> rejected;

  std::size_t responses() const { return overall_mean.size(); }  ///< The number of responses.
  std::size_t poses() const { return solves.size(); }            ///< The number of poses.
  SolveCounts total() const { return total_of(solves); }         ///< How the solves at all poses ended.
};

/// The size in bytes of the numbers of a result whose axes have these lengths. machines: whether errors are drawn per
/// machine.
std::size_t monte_carlo_bytes(const AxisLengths& lengths, bool machines);

/// The Monte Carlo result in a stored result. Its `failures`, `convergence` and `verdicts` are in StoredResult itself.
/// Precondition: the result is of kind `monte-carlo`.
inline const Result& monte_carlo_of(const StoredResult& result) { return found_of<Result>(result); }

/// The tables of a Monte Carlo result: statistics of each response over the samples of all poses, the worst poses of
/// each response, and first-order indices. With draws per machine there are also tables of the machines; with limits
/// also of the yield, of the errors on which it depends, and of the poses at which machines are rejected.
std::vector<Table> monte_carlo_tables(const StoredResult& result, const TableOptions& options = {});

}  // namespace poesy::monte_carlo
