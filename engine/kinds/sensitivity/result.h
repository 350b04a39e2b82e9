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

/// The error relative to which equal-effect tolerances are set, and its own tolerance.
struct ToleranceReference {
  FactorIndex factor;  ///< one of the errors that vary
  double tolerance;    ///< SI
};

/// The options of a sensitivity study.
struct SensitivityOptions {
  std::optional<ToleranceReference> reference;  ///< empty: the error of smallest effect is the reference
  double linearity = 0.01;                      ///< with two fidelities: the largest measure of a linear error
};

/// The kind of study that finds the effect of each error alone.
extern const StudyKind kSensitivityStudy;

namespace axis {
using RadiusMultiple = Axis<"radius_multiple">;  ///< Multiples of the points' radius.
}  // namespace axis

/// The part of each error's effect that the actuators can remove, to first order. Effects are those of model/model.h,
/// in m per SI unit of the error. NaN if an error has no effect.
struct SeparationResult {
  /// A number for each error and pose.
  using Cells = Array<double, axis::Factor, axis::Pose>;

  std::string measure;                      ///< name of the length that effects are
  Cells drive;                              ///< part that enters through the actuated directions
  Cells constraint;                         ///< part that enters through the constrained directions
  Cells effect;                             ///< both parts together
  Cells residual;                           ///< effect that remains after the best correction of the actuators
  Cells removable_local;                    ///< 1 - residual / effect
  Array<double, axis::Factor> drive_share;  ///< D / (D + C), root mean squares over the poses
  Array<double, axis::Factor> removable;    ///< 1 - residual / effect, both as root mean squares over the poses
  double removable_together =
      0.0;  ///< the same for all errors together, with their standard deviations and independent
  Array<std::string, axis::Factor> published;  ///< class of each error in the literature; empty if there is none
};

/// The result of a second fidelity of the model with the same draws, compared with the first; SI. See
/// kinds/sensitivity/fidelity.h.
struct FidelityResult {
  /// A number for each response and error.
  using Indices = Array<double, axis::Response, axis::Factor>;

  std::vector<std::string> fidelities;       ///< names of the first and the second
  double linearity = 0.01;                   ///< largest discrepancy and nonlinearity of a linear error
  Indices global;                            ///< SensitivityResult::global by the second fidelity
  Indices discrepancy;                       ///< global of the second - global of the first
  Indices relative_discrepancy;              ///< over the error's largest index
  Indices nonlinearity;                      ///< change of mean and spread over the error's largest effect
  Array<std::uint8_t, axis::Factor> linear;  ///< verdict, 0 or 1
  Array<std::uint64_t, axis::Factor, axis::Pose> not_converged;  ///< samples that the second fidelity did not solve
};

/// The result of a sensitivity study for its responses, varied errors and poses; SI; NaN where undefined. `global` is
/// the published estimator. `global_corrected` is what tables and figures call the index: it is free of the bias of
/// sampling noise, and NaN if the error is too small for its effect to be distinguished from rounding
/// (stats/indices.h).
struct SensitivityResult {
  /// A number for each response, error and pose.
  template <class T>
  using Cells = Array<T, axis::Response, axis::Factor, axis::Pose>;
  /// A number for each response and error, over the poses.
  using Indices = FidelityResult::Indices;

  double conf_level = 0.95;  ///< of all intervals

  Cells<double> local;                     ///< Du et al. 2022, Eqs. 51-52
  Cells<double> local_ci_low;              ///< lower end of its interval
  Cells<double> local_ci_high;             ///< upper end of its interval
  Cells<std::uint64_t> count;              ///< number of samples
  Cells<double> mean;                      ///< mean of the response over the samples
  Cells<double> std;                       ///< standard deviation of the response over the samples
  Indices global;                          ///< Eqs. 53-54
  Indices global_ci_low;                   ///< lower end of its interval
  Indices global_ci_high;                  ///< upper end of its interval
  Indices global_corrected;                ///< without sampling noise
  Indices global_corrected_ci_low;         ///< lower end of its interval
  Indices global_corrected_ci_high;        ///< upper end of its interval
  Array<double, axis::Response> rounding;  ///< largest standard deviation of the response that may be rounding
  /// The index at a tenth of the study's sizes over the index at these sizes, less 1 (kinds/sensitivity/linearity.h);
  /// NaN if not known.
  Indices index_change;
  /// Kendall's tau with the ranking for points of the metric at kPointsRadii (kinds/sensitivity/points_radius.h). Empty
  /// if the mechanism has no such metric.
  Array<double, axis::RadiusMultiple, axis::Response> radius_tau;
  Array<double, axis::Response, axis::Pose> background;  ///< response with all varied errors zero; NaN if not solved
  Array<SolveCounts, axis::Factor, axis::Pose> solves;   ///< solves of the samples, without those of the background
  Array<std::uint64_t, axis::Factor> limb;               ///< limb of each error, from 1
  /// The error relative to which tolerances of equal effect are set; none if no error has an effect.
  Array<std::optional<ReferenceError>, axis::Response> reference;
  Array<double, axis::Response> mean_square_bound;  ///< Response::mean_square_bound
  std::optional<SeparationResult> separation;       ///< set if the model separates its errors
  std::optional<FidelityResult> fidelity;           ///< set if the study compares two fidelities
  /// The global indices after fewer samples, with intervals, if the study has a fixed number of samples. Each is what a
  /// study with exactly that many samples at each pose (engine/run/evaluate_unit.h) would find, bit by bit. The last
  /// one is the result's.
  std::optional<EstimateCourse> history;

  // Set only by a run; when a file is read, StoredResult has these.
  std::vector<Failure> failures;                 ///< the first, in the order of factors, poses, samples
  std::optional<ConvergenceResult> convergence;  ///< set if the study has adaptive samples

  std::size_t responses() const { return global.length<axis::Response>(); }  ///< The number of responses.
  std::size_t factors() const { return global.length<axis::Factor>(); }      ///< The number of errors that vary.
  std::size_t poses() const { return local.length<axis::Pose>(); }           ///< The number of poses.
  /// The solves of all cells.
  SolveCounts total() const { return total_of(solves.all()); }
};

/// The sensitivity result in a stored result. Precondition: the result is of that kind.
inline const SensitivityResult& sensitivity_of(const StoredResult& result) {
  return found_of<SensitivityResult>(result);
}

}  // namespace poesy
