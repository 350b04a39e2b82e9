#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "engine/base/array.h"
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

namespace axis {
using RadiusMultiple = Axis<"radius_multiple">;  ///< Multiples of the points' radius.
}  // namespace axis

/// Which part of each error's effect the actuators can take away, to first order. Effects are those of model/model.h,
/// in m per SI unit of the error. NaN where an error has no effect.
struct SeparationResult {
  /// A number of each error at each pose.
  using Cells = Array<double, axis::Factor, axis::Pose>;

  std::string measure;                         ///< what length the effects are
  Cells drive;                                 ///< part that enters through the actuated directions
  Cells constraint;                            ///< part that enters through the constrained directions
  Cells effect;                                ///< both together
  Cells residual;                              ///< what the best correction of the actuators leaves
  Cells removable_local;                       ///< 1 - residual / effect
  Array<double, axis::Factor> drive_share;     ///< D / (D + C), root mean squares over the poses
  Array<double, axis::Factor> removable;       ///< 1 - residual / effect, both as root mean squares over the poses
  double removable_together = 0.0;             ///< the same for all errors at their standard deviations, independent
  Array<std::string, axis::Factor> published;  ///< the literature's class of each error; empty where it gives none
};

/// What a second fidelity of the model makes of the same draws, compared with the first; SI. See
/// kinds/sensitivity/fidelity.h.
struct FidelityResult {
  /// A number of each response and error.
  using Indices = Array<double, axis::Response, axis::Factor>;

  std::vector<std::string> fidelities;       ///< names of the first and the second
  double linearity = 0.01;                   ///< what the two measures below may be for a verdict of 1
  Indices global;                            ///< as of SensitivityResult, by the second fidelity
  Indices discrepancy;                       ///< global of the second - global of the first
  Indices relative_discrepancy;              ///< of the error's largest index
  Indices nonlinearity;                      ///< change of mean and spread, of the error's largest effect
  Array<std::uint8_t, axis::Factor> linear;  ///< verdict, 0 or 1
  Array<std::uint64_t, axis::Factor, axis::Pose> not_converged;  ///< samples that the second did not solve
};

/// What a sensitivity study found of its responses, the errors that it varies, and its poses; SI; NaN where undefined.
/// global is the published estimator; global_corrected is what tables and figures call the index, free of what sampling
/// adds to global (stats/indices.h), and NaN where the error is too small for its effect to be told from rounding
/// (stats/indices.h).
struct SensitivityResult {
  /// A number of each response and error, at each pose.
  template <class T>
  using Cells = Array<T, axis::Response, axis::Factor, axis::Pose>;
  /// What becomes of it over the poses.
  using Indices = FidelityResult::Indices;

  double conf_level = 0.95;  ///< of all intervals

  Cells<double> local;                     ///< Du et al. 2022, Eqs. 51-52
  Cells<double> local_ci_low;              ///< lower end of its interval
  Cells<double> local_ci_high;             ///< upper end of its interval
  Cells<std::uint64_t> count;              ///< samples behind local
  Cells<double> mean;                      ///< of the response over the samples
  Cells<double> std;                       ///< standard deviation, likewise
  Indices global;                          ///< Eqs. 53-54
  Indices global_ci_low;                   ///< lower end of its interval
  Indices global_ci_high;                  ///< upper end of its interval
  Indices global_corrected;                ///< without sampling noise, see above
  Indices global_corrected_ci_low;         ///< lower end of its interval
  Indices global_corrected_ci_high;        ///< upper end of its interval
  Array<double, axis::Response> rounding;  ///< standard deviation up to which an effect may be rounding
  /// Index at a tenth of the study's sizes over that at these sizes, less 1 (kinds/sensitivity/linearity.h); NaN where
  /// that is not known.
  Indices index_change;
  /// Kendall's tau with the ranking by points of the metric at kPointsRadii (kinds/sensitivity/points_radius.h). Empty
  /// where the mechanism has no such metric.
  Array<double, axis::RadiusMultiple, axis::Response> radius_tau;
  Array<double, axis::Response, axis::Pose> background;  ///< all varied errors zero; NaN where that was not solved
  Array<SolveCounts, axis::Factor, axis::Pose> solves;   ///< of the samples; those of the background are not counted
  Array<std::uint64_t, axis::Factor> limb;               ///< of each error, from 1
  /// The error from which tolerances of equal effect are counted; none where no error has an effect.
  Array<std::optional<ReferenceError>, axis::Response> reference;
  Array<double, axis::Response> mean_square_bound;  ///< Response::mean_square_bound
  std::optional<SeparationResult> separation;       ///< where the model separates its errors
  std::optional<FidelityResult> fidelity;           ///< where the study compares two fidelities
  /// The global indices after fewer samples, where the study has a fixed number of them, with intervals: each is what a
  /// study with exactly so many samples at each pose (engine/run/evaluate_unit.h) would find, bit by bit. The last is
  /// the result's.
  std::optional<EstimateCourse> history;

  // Of a run alone: what a file says of these is in StoredResult.
  std::vector<Failure> failures;                 ///< the first, in the order of factors, poses, samples
  std::optional<ConvergenceResult> convergence;  ///< where the study has adaptive samples

  std::size_t responses() const { return global.length<axis::Response>(); }  ///< Of the study.
  std::size_t factors() const { return global.length<axis::Factor>(); }      ///< Errors that vary.
  std::size_t poses() const { return local.length<axis::Pose>(); }           ///< Of the study.
  /// Over all cells.
  SolveCounts total() const { return total_of(solves.all()); }
};

/// Precondition: a sensitivity result.
inline const SensitivityResult& sensitivity_of(const StoredResult& result) {
  return found_of<SensitivityResult>(result);
}

}  // namespace poesy
