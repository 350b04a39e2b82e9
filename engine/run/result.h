#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "engine/base/bytes.h"
#include "engine/model/pose_set.h"
#include "engine/model/status.h"
#include "engine/run/failed_samples.h"
#include "engine/study/study.h"

namespace poesy {

/// How solves ended and what they cost, summed over samples.
struct SolveCounts {
  /// Samples that ended so, in the order of SolveStatus.
  std::array<std::uint64_t, kStatusNames.size()> by_status{};
  std::uint64_t iterations = 0;       ///< of all samples together
  std::uint32_t most_iterations = 0;  ///< of any one sample

  /// Samples.
  std::uint64_t total() const;
  /// Samples that did not reach their fixed point.
  std::uint64_t not_converged() const;
  /// One sample.
  void add(SolveStatus status, std::uint32_t sample_iterations);
  /// The order changes nothing.
  void merge(const SolveCounts& other);

  /// For a state or a message.
  void write(ByteWriter& to) const;
  /// Throws BytesError.
  static SolveCounts read(ByteReader& from);
};

/// Which part of each error's effect the actuators can take away, to first order: P errors, M poses. Effects are those
/// of model/model.h, in m per SI unit of the error. NaN where an error has no effect.
struct SeparationResult {
  std::vector<double> drive;            ///< [P x M] part that enters through the actuated directions
  std::vector<double> constraint;       ///< [P x M] part that enters through the constrained directions
  std::vector<double> effect;           ///< [P x M] both together
  std::vector<double> residual;         ///< [P x M] what the best correction of the actuators leaves
  std::vector<double> removable_local;  ///< [P x M] 1 - residual / effect
  std::vector<double> drive_share;      ///< [P] D / (D + C), root mean squares over the poses of drive and constraint
  std::vector<double> removable;        ///< [P] 1 - residual / effect, both as root mean squares over the poses
  double removable_together = 0.0;      ///< the same for all errors at their standard deviations, independent
};

/// What a second fidelity of the model makes of the same draws, compared with the first: R responses, P errors, M
/// poses; SI. See kinds/sensitivity/fidelity.h.
struct FidelityResult {
  double linearity = 0.01;                   ///< what the two measures below may be for a verdict of 1
  std::vector<double> global;                ///< [R x P] as of SensitivityResult, by the second fidelity
  std::vector<double> discrepancy;           ///< [R x P] global of the second - global of the first
  std::vector<double> relative_discrepancy;  ///< [R x P] of the error's largest index
  std::vector<double> nonlinearity;          ///< [R x P] change of mean and spread, of the error's largest effect
  std::vector<std::uint8_t> linear;          ///< [P] verdict, 0 or 1
  std::vector<std::uint64_t> not_converged;  ///< [P x M] samples that the second did not solve
};

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

/// What a sensitivity study found: R responses, P varied factors, M poses; SI; NaN where undefined. global is the
/// published estimator; global_corrected is what tables and figures call the index, free of what sampling adds to
/// global (stats/sensitivity_index.h), and NaN where the error is too small for its effect to be told from rounding
/// (stats/rounding.h). Files of older versions have neither this nor rounding: they are empty.
struct SensitivityResult {
  std::size_t responses = 0;  ///< R
  std::size_t factors = 0;    ///< P
  std::size_t poses = 0;      ///< M
  double conf_level = 0.95;   ///< of all intervals

  std::vector<double> local;                     ///< [R x P x M] Du et al. 2022, Eqs. 51-52
  std::vector<double> local_ci_low;              ///< [R x P x M]
  std::vector<double> local_ci_high;             ///< [R x P x M]
  std::vector<double> count;                     ///< [R x P x M] samples behind local, whole numbers
  std::vector<double> mean;                      ///< [R x P x M]
  std::vector<double> std;                       ///< [R x P x M]
  std::vector<double> global;                    ///< [R x P] Eqs. 53-54
  std::vector<double> global_ci_low;             ///< [R x P]
  std::vector<double> global_ci_high;            ///< [R x P]
  std::vector<double> global_corrected;          ///< [R x P] without sampling noise, see above
  std::vector<double> global_corrected_ci_low;   ///< [R x P]
  std::vector<double> global_corrected_ci_high;  ///< [R x P]
  std::vector<double> rounding;                  ///< [R] standard deviation up to which an effect may be rounding
  /// [R x P] index at a tenth of the study's sizes over that at these sizes, less 1 (kinds/sensitivity/linearity.h); NaN where that
  /// is not known. Empty in files of older versions.
  std::vector<double> index_change;
  /// [2 x R] Kendall's tau with the ranking by points of the metric at kPointsRadii (kinds/sensitivity/points_radius.h). Empty where
  /// the mechanism has no such metric, and in files of older versions.
  std::vector<double> radius_tau;
  std::vector<double> background;              ///< [R x M] all varied errors zero; NaN where that was not solved
  std::vector<SolveCounts> solves;             ///< [P x M] of the samples; the background's solves are not among them
  std::vector<Failure> failures;               ///< the first, in the order of factors, poses, samples
  std::optional<SeparationResult> separation;  ///< where the model separates its errors
  std::optional<FidelityResult> fidelity;      ///< where the study compares two fidelities
  /// Where the study has adaptive samples.
  std::optional<ConvergenceResult> convergence;
  /// The global indices after fewer samples, where it has a fixed number of them, with intervals: each is what a study
  /// with exactly so many samples at each pose (engine/kinds/sensitivity/history_points.h) would find, bit by bit. The last is the
  /// result's. Not in files of older versions.
  std::optional<EstimateCourse> history;

  /// Over all cells.
  SolveCounts total() const;
};

/// How a limit of a response was kept (engine/run/verdict.h). SI; values are magnitudes.
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

/// All limits of a study.
struct LimitVerdicts {
  /// By which number draws are judged; none in an evaluation, whose rows are judged one by one.
  std::optional<Judge> judge = std::nullopt;
  double share = 0.0;                ///< for Judge::share: of the draws at each pose
  std::vector<LimitVerdict> limits;  ///< in the order of the responses

  /// Whether every limit is kept.
  bool passed() const;
};

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
  /// [R x M x Q] interval of the distribution's quantile (stats/quantile_interval.h), an end infinite where the samples
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
  /// Histograms of the samples of all poses (stats/histogram.h), B bins each; empty in files of older versions.
  std::vector<double> histogram_edges;          ///< [R x (B + 1)]
  std::vector<std::uint64_t> histogram_counts;  ///< [R x B]
  std::vector<SolveCounts> solves;              ///< [M]
  std::vector<Failure> failures;                ///< the first, in the order of poses and samples
  /// Where the study has adaptive samples.
  std::optional<ConvergenceResult> convergence;
  /// Where it states limits.
  std::optional<LimitVerdicts> verdicts;

  /// Over all poses.
  SolveCounts total() const;
};

/// What `evaluate` found for M poses and S samples each (S = 1 when paired): SI.
struct EvaluationResult {
  std::size_t poses = 0;      ///< M
  std::size_t samples = 0;    ///< S
  std::size_t responses = 0;  ///< R
  std::size_t details = 0;    ///< D, components of all details

  std::vector<double> response;            ///< [R x M x S]
  std::vector<double> detail;              ///< [M x S x D]
  std::vector<SolveStatus> status;         ///< [M x S]
  std::vector<std::uint32_t> iterations;   ///< [M x S]
  std::vector<double> joint_displacement;  ///< [M x joints], nominal
  std::optional<LimitVerdicts> verdicts;   ///< where the study states limits

  /// Over all poses and samples.
  SolveCounts total() const;
};

/// What named cases of errors do: C cases, R responses. evaluation has the cases as its samples.
struct CaseResult {
  EvaluationResult evaluation;       ///< with the cases as its samples
  std::vector<double> mean;          ///< [R x C] over the poses that count; NaN where there is none
  std::vector<double> max;           ///< [R x C]
  std::vector<std::uint64_t> count;  ///< [R x C] poses that count
};

/// Two errors of one frame that deform together and not alone.
struct Coupling {
  std::size_t group;              ///< position among the groups
  std::size_t first;              ///< position among the factors
  std::size_t second;             ///< position among the factors
  std::uint64_t deforming_poses;  ///< poses where both together deform, and neither alone
};

/// Which of P errors deform the mechanism, tried at G groups of sizes and M poses.
struct IdentificationResult {
  std::size_t factors = 0;  ///< P
  std::size_t groups = 0;   ///< G
  /// M.
  std::size_t poses = 0;             ///< M
  double rounding = 0.0;             ///< deformations up to this cannot be told from zero
  std::uint64_t required_poses = 0;  ///< that a verdict asks for

  std::vector<std::uint64_t> single_below;     ///< [G x P] poses where the error alone gives no more than rounding
  std::vector<double> single_max;              ///< [G x P] largest deformation over the solved poses; NaN where none
  std::vector<std::uint64_t> not_solved;       ///< [G x P] poses without a solution, single stage
  std::vector<std::uint64_t> coupled_below;    ///< [G x P] as single_below, for all errors tried together in its frame
  std::vector<std::uint64_t> coupled_reduced;  ///< [G x P] poses where leaving it out takes nine tenths away
  std::vector<std::uint8_t> single_by_group;   ///< [G x P] verdict of the single stage, 0 or 1
  std::vector<std::uint8_t> coupled_by_group;  ///< [G x P] verdict of both stages
  std::vector<std::uint8_t> single;            ///< [P] in any group
  std::vector<std::uint8_t> coupled;           ///< [P] in any group
  std::vector<Coupling> couplings;             ///< pairs that deform together only, by group and position
  SolveCounts solves;                          ///< of all solves of both stages
};

/// What error sources do one by one and together: R responses, Z sizes, K subsets of the sources, M poses; SI. NaN
/// where a solve that a number rests on does not count. What each number means: engine/kinds/coupling/coupling.h.
struct CouplingResult {
  std::size_t responses = 0;  ///< R
  std::size_t sizes = 0;      ///< Z
  std::size_t subsets = 0;    ///< K
  std::size_t poses = 0;      ///< M

  std::vector<double> effect;           ///< [R x Z x K x M]
  std::vector<double> sum;              ///< [R x Z x K x M]
  std::vector<double> interaction;      ///< [R x Z x K x M]
  std::vector<double> worst_case;       ///< [R x Z x K x M]
  std::vector<double> root_sum_square;  ///< [R x Z x K x M]
  std::vector<double> cancellation;     ///< [R x Z x K x M] from 0 to 1

  // Over the poses where all of these are known; where there is none, NaN and pose -1.
  std::vector<std::uint64_t> count;                 ///< [R x Z x K] such poses
  std::vector<double> effect_max;                   ///< [R x Z x K] largest |effect|
  std::vector<std::int64_t> effect_max_pose;        ///< [R x Z x K] the first pose that has it
  std::vector<double> interaction_max;              ///< [R x Z x K] largest |interaction|
  std::vector<double> worst_case_max;               ///< [R x Z x K]
  std::vector<double> root_sum_square_max;          ///< [R x Z x K]
  std::vector<double> opposed_share;                ///< [R x Z x K] share of the poses where sources oppose each other
  std::vector<double> cancellation_max;             ///< [R x Z x K]
  std::vector<std::int64_t> cancellation_max_pose;  ///< [R x Z x K]
  std::vector<SolveCounts> solves;                  ///< [Z x M] of all sets of errors that were solved

  /// Over all sizes and poses.
  SolveCounts total() const;
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
