#pragma once

#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "engine/result/result_file.h"
#include "engine/run/evaluation.h"
#include "engine/run/result.h"
#include "engine/study/study.h"

namespace poesy::axis {

using SizeGroup = Axis<"group">;  ///< Pairs of sizes (ErrorSize) at which errors are tried.

}  // namespace poesy::axis

namespace poesy::identification {

/// A pair of sizes at which errors are tried: one for lengths, one for angles.
struct ErrorSize {
  std::string name;  ///< name in tables
  double linear;     ///< size of errors that are lengths, m
  double angular;    ///< size of errors that are angles, rad
};

/// The options of an identification study.
struct Options {
  /// [groups] Sizes at which errors are tried. For each group the study finds which errors deform the mechanism.
  std::vector<ErrorSize> groups;
  double pose_share = 0.95;  ///< an error counts as deforming unless it deforms nothing at this share of the poses
};

/// The kind of study that identifies which errors deform the mechanism at all.
extern const StudyKind kStudy;

/// Two errors of one frame that deform the mechanism only together.
struct Coupling {
  std::size_t group;              ///< index in Options::groups
  std::size_t first;              ///< index of the first error among the study's factors
  std::size_t second;             ///< index of the second error among the study's factors
  std::uint64_t deforming_poses;  ///< number of poses at which both together deform the mechanism
};

/// Which errors deform the mechanism, for each group (a pair of sizes) and over the poses.
struct Result {
  /// A number for each group and error.
  template <class T>
  using ByGroup = Array<T, axis::SizeGroup, axis::Factor>;

  std::vector<ErrorSize> sizes;      ///< [groups] sizes of the errors
  std::size_t poses = 0;             ///< number of poses that were tried
  double rounding = 0.0;             ///< deformations up to this magnitude are rounding, SI
  std::uint64_t required_poses = 0;  ///< number of poses at which a verdict must hold

  /// Number of poses at which the deformation by the error alone is at most rounding.
  ByGroup<std::uint64_t> single_below;
  /// Largest deformation, SI, by the error alone over the solved poses; NaN if none is solved.
  ByGroup<double> single_max;
  ByGroup<std::uint64_t> not_solved;  ///< number of poses without a solution for the error alone
  /// Number of poses at which the errors tried together in the coupled stage (those of this error's frame that do not
  /// deform the mechanism alone) cause no deformation beyond rounding; 0 if they were not tried.
  ByGroup<std::uint64_t> coupled_below;
  /// Number of poses at which the deformation by the errors of `coupled_below` together falls to a tenth or less if
  /// this error is set to zero.
  ByGroup<std::uint64_t> coupled_reduced;
  /// 1 if the error alone deforms the mechanism, otherwise 0.
  ByGroup<std::uint8_t> single_by_group;
  /// 1 if the error deforms the mechanism, alone or together with other errors of its frame; otherwise 0.
  ByGroup<std::uint8_t> coupled_by_group;
  /// 1 if `single_by_group` is 1 for some pair of sizes, otherwise 0.
  Array<std::uint8_t, axis::Factor> single;
  /// 1 if `coupled_by_group` is 1 for some pair of sizes, otherwise 0.
  Array<std::uint8_t, axis::Factor> coupled;
  /// Pairs of errors that deform the mechanism only together, ordered by group and position.
  std::vector<Coupling> couplings;
  SolveCounts solves;  ///< how the solves of both stages ended

  std::size_t groups() const { return single_by_group.length<axis::SizeGroup>(); }  ///< The number of groups.
  std::size_t factors() const { return single.length<axis::Factor>(); }             ///< The number of errors.
};

/// A function that solves every row of a table of errors at every pose of the study. Returns nothing if the run was
/// stopped.
using SolveTable = std::function<std::optional<EvaluationResult>(const ErrorTable&)>;

/// Identifies which errors deform the mechanism (Du et al. 2022, Section 5.1), for each pair of sizes (group).
///
/// Single stage: each error is tried while all others are zero. The error does not deform the mechanism if the model's
/// measure of deformation is at most rounding at enough poses: `pose_share` of them, rounded to whole poses, at least
/// one (657 of 692 at 0.95, as in the paper). A pose that was not solved counts as deformed, because it does not show
/// that there is no deformation.
///
/// Coupled stage: for each frame of a limb, all errors that do not deform the mechanism alone are tried together. If
/// they deform it, all pairs of them are tried. A pair that deforms it is a coupling. In a coupling, the angular error
/// is recorded as deforming the mechanism (`coupled_by_group`), or both errors if they have the same dimension. If no
/// pair deforms the mechanism, all errors that take part are recorded. An error takes part if setting it to zero
/// removes nine tenths of the deformation at `pose_share` of the poses.
///
/// Precondition: the model has a measure of deformation.
std::optional<Result> identify(const Analysis& analysis, const ModelDescription& model, const SolveTable& solve);

/// The identification in a stored result. Precondition: the result is of kind `identification`.
inline const Result& identification_of(const StoredResult& result) { return found_of<Result>(result); }

}  // namespace poesy::identification
