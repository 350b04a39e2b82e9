#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <vector>

#include "engine/files/result_file.h"
#include "engine/report/tables.h"
#include "engine/run/result.h"
#include "engine/study/study.h"

namespace poesy {

/// What a Monte Carlo study alone asks.
struct MonteCarloOptions {
  std::vector<double> quantiles{0.05, 0.5, 0.95};  ///< shares of samples below, ascending
  Judge judge = Judge::rms;                        ///< of the limits
  double share = 0.0;                              ///< for Judge::share: of the draws at each pose
};

/// The kind of study in which all errors vary together.
extern const StudyKind kMonteCarloStudy;

/// What a Monte Carlo study found, all errors varying together: R responses, M poses, Q quantiles; SI; NaN where
/// undefined. The overall numbers are over the samples of all poses together.
struct MonteCarloResult {
  std::size_t responses = 0;             ///< R
  std::size_t poses = 0;                 ///< M
  double conf_level = 0.95;              ///< of all intervals
  double quantile_relative_error = 0.0;  ///< bound on |quantile - order statistic| / |order statistic|
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
  /// are too few for it; empty in files of older versions.
  std::vector<double> quantiles_ci_low;
  std::vector<double> quantiles_ci_high;  ///< likewise
  /// [R x M] where limits are judged by a share of the draws: the magnitude within which that share of them stays.
  /// Draws that do not count never stay within anything; infinite where they are too many.
  std::vector<double> share_magnitude;

  std::vector<double> overall_mean;               ///< [R]
  std::vector<double> overall_std;                ///< [R]
  std::vector<double> overall_min;                ///< [R]
  std::vector<double> overall_max;                ///< [R]
  std::vector<std::uint64_t> overall_count;       ///< [R]
  std::vector<double> overall_quantiles;          ///< [R x Q]
  std::vector<double> overall_rms;                ///< [R]
  std::vector<double> overall_quantiles_ci_low;   ///< [R x Q] empty in files of older versions
  std::vector<double> overall_quantiles_ci_high;  ///< [R x Q] likewise
  /// Histograms of the samples of all poses (stats/buckets.h), B bins each; empty in files of older versions.
  std::vector<double> histogram_edges;          ///< [R x (B + 1)]
  std::vector<std::uint64_t> histogram_counts;  ///< [R x B]
  std::vector<SolveCounts> solves;              ///< [M]
  std::vector<Failure> failures;                ///< the first, in the order of poses and samples
  /// Where the study has adaptive samples.
  std::optional<ConvergenceResult> convergence;
  /// Where it states limits.
  std::optional<LimitVerdicts> verdicts;

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
