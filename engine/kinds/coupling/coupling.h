#pragma once

#include <span>
#include <string>
#include <vector>

#include "engine/kinds/coupling/rows.h"
#include "engine/run/evaluation.h"
#include "engine/run/result.h"
#include "engine/study/study.h"

namespace poesy {

/// What error sources do one by one and together: R responses, Z sizes, K subsets of the sources, M poses; SI. NaN
/// where a solve that a number rests on does not count. What each number means: coupling_result.
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
  SolveCounts total() const { return total_of(solves); }
};

/// What sources of errors do one by one and together (San et al. 2023, Sections 5.2.1 and 5.2.2), at each size and
/// pose, for each subset S of the sources. A response is the effect of the errors that it is solved with: it has to be
/// zero where all errors are.
///
///     effect           all errors of S at once: the curve of a single source, or the coupled one
///     sum              sum over the sources in S of the effect of each alone
///     interaction      effect - sum; 0 for a single source
///     worst_case       sum over the blocks of S of |effect of the block alone| (see error_blocks)
///     root_sum_square  root of the sum of the squares of these
///     cancellation     1 - |sum| / (sum over the sources of |effect of each|): 0 where no source opposes another or
///                      where no more than rounding is cancelled, 1 where they cancel
///
/// To first order, worst_case is the most that the blocks do together where their signs are not known, and
/// root_sum_square the root mean square if either sign of each is as likely. Where a response is a norm, which has no
/// sign, no source can be seen to oppose another: sum and worst_case then are upper bounds on what the sources do
/// together, interaction is never above zero but by second order, and cancellation is 0.
///
/// Summaries are over the poses where all of this is known. Sources oppose each other (opposed_share) where |sum| is
/// below the largest |effect of a source in S| by more than rounding: together they do less than one of them.
/// Rounding is size_rounding (stats/indices.h) of the size of the errors.
///
/// evaluation: what run_evaluation found for the study's coupling_table. A solve that does not count (see counts())
/// makes NaN of everything that rests on it, and is counted in `solves`.
CouplingResult coupling_result(const EvaluationResult& evaluation, const CouplingStudy& study,
                               const ModelDescription& model, NotConverged policy);

/// The names of the sources in each subset, joined: "FS", "T", "FS+T".
std::vector<std::string> subset_names(std::span<const ErrorSource> sources);

}  // namespace poesy
