#pragma once

#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "engine/result/result_file.h"
#include "engine/run/evaluation.h"
#include "engine/run/result.h"
#include "engine/study/study.h"

namespace poesy {

/// The sizes at which identification sets errors.
struct ErrorSize {
  std::string name;  ///< name in tables
  double linear;     ///< size of lengths, m
  double angular;    ///< size of angles, rad
};

/// The options of an identification study.
struct IdentificationOptions {
  std::vector<ErrorSize> groups;  ///< sizes; each has its own verdicts
  double pose_share = 0.95;       ///< share of the poses at which a verdict must hold
};

/// The kind of study that identifies which errors deform the mechanism at all.
extern const StudyKind kIdentificationStudy;

/// Two errors of one frame that deform together but not alone.
struct Coupling {
  std::size_t group;              ///< position among the groups
  std::size_t first;              ///< position among the factors
  std::size_t second;             ///< position among the factors
  std::uint64_t deforming_poses;  ///< poses where both together deform, but neither alone
};

namespace axis {
using SizeGroup = Axis<"group">;  ///< Groups of sizes.
}  // namespace axis

/// Which errors deform the mechanism, at groups of sizes and at poses.
struct IdentificationResult {
  /// A number for each group and error.
  template <class T>
  using ByGroup = Array<T, axis::SizeGroup, axis::Factor>;

  std::vector<ErrorSize> sizes;      ///< [groups] sizes of the errors
  std::size_t poses = 0;             ///< number of poses that were tried
  double rounding = 0.0;             ///< deformations up to this cannot be told from zero
  std::uint64_t required_poses = 0;  ///< number of poses at which a verdict must hold

  ByGroup<std::uint64_t> single_below;  ///< poses where the error alone deforms by no more than rounding
  ByGroup<double> single_max;           ///< largest deformation over the solved poses; NaN if none is solved
  ByGroup<std::uint64_t> not_solved;    ///< poses without a solution in the single stage
  ByGroup<std::uint64_t>
      coupled_below;  ///< the same as single_below for all errors of its frame that are tried together
  ByGroup<std::uint64_t>
      coupled_reduced;  ///< poses where setting the error to zero removes nine tenths of the deformation
  ByGroup<std::uint8_t> single_by_group;      ///< verdict of the single stage, 0 or 1
  ByGroup<std::uint8_t> coupled_by_group;     ///< verdict of both stages
  Array<std::uint8_t, axis::Factor> single;   ///< verdict of the single stage in any group
  Array<std::uint8_t, axis::Factor> coupled;  ///< verdict of both stages in any group
  std::vector<Coupling> couplings;            ///< pairs that deform only together, by group and position
  SolveCounts solves;                         ///< of all solves of both stages

  std::size_t groups() const { return single_by_group.length<axis::SizeGroup>(); }  ///< The number of groups.
  std::size_t factors() const { return single.length<axis::Factor>(); }             ///< The number of errors.
};

/// Solves every row of a table of errors at every pose of the study. Empty when stopped.
using SolveTable = std::function<std::optional<EvaluationResult>(const ErrorTable&)>;

/// Identifies the errors that deform the mechanism (Du et al. 2022, Section 5.1), for each group of sizes.
///
/// Single stage: each error is tried alone. It is harmless if the model's measure of deformation is no more than
/// rounding at pose_share of the poses, rounded to whole poses, at least one (657 of 692 at 0.95, as in the paper).
/// Otherwise it deforms. A pose that was not solved counts as deformed, because it did not show the absence of
/// deformation.
///
/// Coupled stage: for each frame of a limb, all of its errors that do not deform alone are tried together. If they
/// deform, two that deform as a pair are a coupling, and the verdict names its angular member, or both if they have the
/// same dimension. An error takes part if setting it to zero removes nine tenths of the deformation at pose_share of
/// the poses; if no pair deforms, all errors that take part are named.
///
/// Precondition: the model has a measure of deformation.
std::optional<IdentificationResult> identify(const Analysis& analysis, const ModelDescription& model,
                                             const SolveTable& solve);

/// The identification in a stored result. Precondition: the result is an identification.
inline const IdentificationResult& identification_of(const StoredResult& result) {
  return found_of<IdentificationResult>(result);
}

}  // namespace poesy
