#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "engine/result/result_file.h"
#include "engine/run/result.h"
#include "engine/stats/tolerance.h"
#include "engine/study/study.h"

namespace poesy {

/// The error from which equal-effect tolerances are counted, and its own tolerance.
struct ToleranceReference {
  FactorIndex factor;  ///< one of those that vary
  double tolerance;    ///< SI
};

/// What a sensitivity study alone asks.
struct SensitivityOptions {
  std::optional<ToleranceReference> reference;  ///< empty: the error of smallest effect
  double linearity = 0.01;                      ///< at two fidelities: up to this an error is linear
};

/// The kind of study that tells what each error does on its own.
extern const StudyKind kSensitivityStudy;

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

/// What a sensitivity study found: R responses, P varied factors, M poses; SI; NaN where undefined. global is the
/// published estimator; global_corrected is what tables and figures call the index, free of what sampling adds to
/// global (stats/indices.h), and NaN where the error is too small for its effect to be told from rounding
/// (stats/indices.h).
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
  /// [R x P] index at a tenth of the study's sizes over that at these sizes, less 1 (kinds/sensitivity/linearity.h);
  /// NaN where that is not known.
  std::vector<double> index_change;
  /// [2 x R] Kendall's tau with the ranking by points of the metric at kPointsRadii
  /// (kinds/sensitivity/points_radius.h). Empty where the mechanism has no such metric.
  std::vector<double> radius_tau;
  std::vector<double> background;              ///< [R x M] all varied errors zero; NaN where that was not solved
  std::vector<SolveCounts> solves;             ///< [P x M] of the samples; the background's solves are not among them
  std::vector<Failure> failures;               ///< the first, in the order of factors, poses, samples
  std::optional<SeparationResult> separation;  ///< where the model separates its errors
  std::optional<FidelityResult> fidelity;      ///< where the study compares two fidelities
  /// Where the study has adaptive samples.
  std::optional<ConvergenceResult> convergence;
  /// The global indices after fewer samples, where it has a fixed number of them, with intervals: each is what a study
  /// with exactly so many samples at each pose (engine/run/evaluate_unit.h) would find, bit by bit. The
  /// last is the result's.
  std::optional<EstimateCourse> history;

  /// Over all cells.
  SolveCounts total() const { return total_of(solves); }
};

/// What a sensitivity result says, read back. Its failures and its convergence are those of StoredResult.
struct StoredSensitivity : SensitivityResult {
  std::vector<std::uint64_t> factor_limb;                          ///< [P]
  std::vector<std::optional<ReferenceError>> tolerance_reference;  ///< [R] none where no error has an effect
  std::vector<double> mean_square_bound;                           ///< [R] Response::mean_square_bound
  std::string separation_measure;                                  ///< what length `separation` speaks of
  std::vector<std::string> published_class;  ///< [P] the literature's class of each error, where that is separated
  std::vector<std::string> fidelities;       ///< the two that `fidelity` compares
};

/// Precondition: a sensitivity result.
inline const StoredSensitivity& sensitivity_of(const StoredResult& result) {
  return found_of<StoredSensitivity>(result);
}

}  // namespace poesy
