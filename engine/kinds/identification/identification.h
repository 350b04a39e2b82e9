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
  std::string name;  ///< stands in tables
  double linear;     ///< m
  double angular;    ///< rad
};

/// What an identification study alone asks.
struct IdentificationOptions {
  std::vector<ErrorSize> groups;  ///< each gives verdicts of its own
  double pose_share = 0.95;       ///< of the poses that a verdict asks for
};

/// The kind of study that tells which errors deform the mechanism at all.
extern const StudyKind kIdentificationStudy;

/// Two errors of one frame that deform together and not alone.
struct Coupling {
  std::size_t group;              ///< position among the groups
  std::size_t first;              ///< position among the factors
  std::size_t second;             ///< position among the factors
  std::uint64_t deforming_poses;  ///< poses where both together deform, and neither alone
};

namespace axis {
using SizeGroup = Axis<"group">;  ///< Groups of sizes.
}  // namespace axis

/// Which errors deform the mechanism, tried at groups of sizes and at poses.
struct IdentificationResult {
  /// A number for each group and error.
  template <class T>
  using ByGroup = Array<T, axis::SizeGroup, axis::Factor>;

  std::vector<ErrorSize> sizes;      ///< of the errors, by group
  std::size_t poses = 0;             ///< that were tried
  double rounding = 0.0;             ///< deformations up to this cannot be told from zero
  std::uint64_t required_poses = 0;  ///< that a verdict asks for

  ByGroup<std::uint64_t> single_below;        ///< poses where the error alone gives no more than rounding
  ByGroup<double> single_max;                 ///< largest deformation over the solved poses; NaN where none
  ByGroup<std::uint64_t> not_solved;          ///< poses without a solution, single stage
  ByGroup<std::uint64_t> coupled_below;       ///< as single_below, for all errors tried together in its frame
  ByGroup<std::uint64_t> coupled_reduced;     ///< poses where leaving it out takes nine tenths away
  ByGroup<std::uint8_t> single_by_group;      ///< verdict of the single stage, 0 or 1
  ByGroup<std::uint8_t> coupled_by_group;     ///< verdict of both stages
  Array<std::uint8_t, axis::Factor> single;   ///< in any group
  Array<std::uint8_t, axis::Factor> coupled;  ///< in any group
  std::vector<Coupling> couplings;            ///< pairs that deform together only, by group and position
  SolveCounts solves;                         ///< of all solves of both stages

  std::size_t groups() const { return single_by_group.length<axis::SizeGroup>(); }  ///< Of sizes.
  std::size_t factors() const { return single.length<axis::Factor>(); }             ///< Errors that were tried.
};

/// Solves every row of a table of errors at every pose of the study. Empty when stopped.
using SolveTable = std::function<std::optional<EvaluationResult>(const ErrorTable&)>;

/// Which errors deform the mechanism at all (Du et al. 2022, Section 5.1), for each group of sizes:
///
/// Single stage: each error alone. It is harmless where the model's measure of deformation is no more than rounding at
/// pose_share of the poses, rounded to whole poses, one at least (657 of 692 at 0.95, as in the paper); else it
/// deforms. A pose that was not solved counts as deformed, for no deformation was shown there to be absent.
///
/// Coupled stage: for each frame of a limb, all of its errors that did not deform alone, together. Where that deforms,
/// two that deform as a pair are a coupling, and the verdict names its angular member, or both where they are of one
/// kind. An error takes part when setting it to zero takes away nine tenths of the deformation at pose_share of the
/// poses; where no pair deforms, all that take part are named.
///
/// Precondition: the model has a measure of deformation.
std::optional<IdentificationResult> identify(const Analysis& analysis, const ModelDescription& model,
                                             const SolveTable& solve);

/// Precondition: the result of an identification.
inline const IdentificationResult& identification_of(const StoredResult& result) {
  return found_of<IdentificationResult>(result);
}

}  // namespace poesy
