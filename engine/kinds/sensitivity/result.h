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

namespace poesy::axis {

/// Multiples of the distance of each point of the platform's metric from the middle of all points.
using RadiusMultiple = Axis<"radius_multiple">;

}  // namespace poesy::axis

namespace poesy::sensitivity {

/// The error relative to which tolerances of equal effect are set, and the tolerance that it gets.
struct ToleranceReference {
  FactorIndex factor;  ///< the error, which varies in the study
  double tolerance;    ///< its tolerance, SI
};

/// The options of a sensitivity study.
struct Options {
  std::optional<ToleranceReference> reference;  ///< reference error; none: the error with the smallest effect
  /// An error counts as linear if its nonlinearity and relative discrepancy (FidelityResult) are at most this number;
  /// used only if a study compares two fidelities.
  double linearity = 0.01;
};

/// The kind of study that computes the effect of each error alone, `sensitivity`.
extern const StudyKind kStudy;

/// How much of each error's effect the actuators can remove, to first order. Effects are those of Separation
/// (model/model.h), in m per SI unit of the error. Shares are NaN if an error has no effect.
struct SeparationResult {
  /// A number for each error and pose.
  using Cells = Array<double, axis::Factor, axis::Pose>;

  std::string measure;    ///< description of the displacement by which effects are measured
  Cells drive;            ///< part of the effect along the directions that the actuators drive
  Cells constraint;       ///< part of the effect along the directions that the limbs constrain
  Cells effect;           ///< effect of both parts together
  Cells residual;         ///< effect that remains after the best correction by the actuators
  Cells removable_local;  ///< 1 - residual / effect
  /// D / (D + C), where D is the root mean square of `drive` over the poses, and C that of `constraint`.
  Array<double, axis::Factor> drive_share;
  Array<double, axis::Factor> removable;  ///< 1 - residual / effect, each as a root mean square over the poses
  /// 1 - residual / effect for all errors together, if they are independent and have the study's standard deviations.
  double removable_together = 0.0;
  /// Class of each error in the literature; empty if the literature gives none.
  Array<std::string, axis::Factor> published;
};

/// The result at a second fidelity of the model, from the same draws, and its comparison with the first; SI. See
/// kinds/sensitivity/fidelity.h.
struct FidelityResult {
  /// A number for each response and error.
  using Indices = Array<double, axis::Response, axis::Factor>;

  std::vector<std::string> fidelities;       ///< names of the two fidelities, the first one first
  double linearity = 0.01;                   ///< largest nonlinearity and |relative_discrepancy| of a linear error
  Indices global;                            ///< Result::global at the second fidelity
  Indices discrepancy;                       ///< global at the second fidelity minus global at the first
  Indices relative_discrepancy;              ///< discrepancy divided by the error's effect
  Indices nonlinearity;                      ///< root mean square change of mean and spread between the fidelities,
                                             ///< divided by the error's effect
  Array<std::uint8_t, axis::Factor> linear;  ///< 1 if the error is linear, otherwise 0
  /// Number of samples that the second fidelity did not solve.
  Array<std::uint64_t, axis::Factor, axis::Pose> not_converged;
};

/// The result of a sensitivity study; SI; NaN where undefined. `global` is the published estimator of the global index.
/// `global_corrected` is the index that tables and figures show: it has no bias from sampling noise. It is NaN if the
/// error is too small for its effect to be distinguished from rounding (stats/indices.h).
struct Result {
  /// A number for each response, error and pose.
  template <class T>
  using Cells = Array<T, axis::Response, axis::Factor, axis::Pose>;
  /// A number for each response and error, over the poses.
  using Indices = FidelityResult::Indices;

  double conf_level = 0.95;  ///< confidence level of all intervals

  Cells<double> local;                     ///< local index: Du et al. 2022, Eqs. 51-52
  Cells<double> local_ci_low;              ///< lower ends of the intervals of `local`
  Cells<double> local_ci_high;             ///< upper ends of the intervals of `local`
  Cells<std::uint64_t> count;              ///< number of samples that count in statistics
  Cells<double> mean;                      ///< mean of the response over the samples
  Cells<double> std;                       ///< standard deviation of the response over the samples
  Indices global;                          ///< global index as published: Du et al. 2022, Eqs. 53-54
  Indices global_ci_low;                   ///< lower ends of the intervals of `global`
  Indices global_ci_high;                  ///< upper ends of the intervals of `global`
  Indices global_corrected;                ///< global index without the bias from sampling noise
  Indices global_corrected_ci_low;         ///< lower ends of the intervals of `global_corrected`
  Indices global_corrected_ci_high;        ///< upper ends of the intervals of `global_corrected`
  Array<double, axis::Response> rounding;  ///< largest standard deviation of the response that counts as rounding
  /// Index at a tenth of the study's sizes, divided by the index at these sizes, minus 1
  /// (kinds/sensitivity/linearity.h). NaN if not known.
  Indices index_change;
  /// Kendall's tau between the rankings with the metric's points at kPointsRadii and with the study's points
  /// (kinds/sensitivity/points_radius.h). Empty if the mechanism has no such metric.
  Array<double, axis::RadiusMultiple, axis::Response> radius_tau;
  Array<double, axis::Response, axis::Pose> background;  ///< response with all varied errors at zero; NaN if not solved
  Array<SolveCounts, axis::Factor, axis::Pose> solves;   ///< how the solves of the samples ended, without those of the
                                                         ///< background
  Array<std::uint64_t, axis::Factor> limb;               ///< limb of each error, counted from 1
  /// The error relative to which tolerances of equal effect are set; none if no error has an effect.
  Array<std::optional<ReferenceError>, axis::Response> reference;
  Array<double, axis::Response> mean_square_bound;  ///< upper bound on the mean square of all errors together, divided
                                                    ///< by the sum of the mean squares of each error alone
  std::optional<SeparationResult> separation;       ///< set if the model separates its errors
  std::optional<FidelityResult> fidelity;           ///< set if the study compares two fidelities
  /// The global indices and their intervals with fewer samples, for a study with a fixed number of samples. Each entry
  /// has the same bits as the result of a study with exactly this number of samples at each pose
  /// (engine/run/evaluate_unit.h). The last entry is the result itself.
  std::optional<EstimateCourse> history;

  // The following members are set by a run only. A result that was read from a file has them in StoredResult.
  std::vector<Failure> failures;  ///< first failed samples, ordered by error, pose and sample
  /// Indices after each round of adaptive samples; set if the study has adaptive samples.
  std::optional<ConvergenceResult> convergence;

  std::size_t responses() const { return global.length<axis::Response>(); }  ///< The number of responses.
  std::size_t factors() const { return global.length<axis::Factor>(); }      ///< The number of errors that vary.
  std::size_t poses() const { return local.length<axis::Pose>(); }           ///< The number of poses.
  /// How the solves of all errors at all poses ended.
  SolveCounts total() const { return total_of(solves.all()); }
};

/// The sensitivity result in a stored result. Precondition: the result is of kind `sensitivity`.
inline const Result& sensitivity_of(const StoredResult& result) { return found_of<Result>(result); }

}  // namespace poesy::sensitivity
