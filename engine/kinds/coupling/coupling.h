#pragma once

#include <cstddef>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "engine/base/array.h"
#include "engine/model/model.h"
#include "engine/report/tables.h"
#include "engine/result/result_file.h"
#include "engine/run/evaluation.h"
#include "engine/run/result.h"
#include "engine/study/study.h"
#include "engine/study/table_file.h"

namespace poesy {

/// A group of errors that is judged as one.
struct ErrorSource {
  std::string name;                  ///< stands in tables, joined to others by '+'
  std::vector<FactorIndex> factors;  ///< as the study names them, whatever the pattern leaves of them
};

/// Which errors of a source have its size, and which of these move together.
struct ErrorPattern {
  /// How far a choice of limbs or components goes.
  enum class Choice {
    all,         ///< every one, together
    some,        ///< those that are named, together
    independent  ///< every one, each on its own
  };

  Choice limbs = Choice::all;       ///< which limbs' errors have the size
  std::size_t limb = 0;             ///< for some: it alone; counts from 1
  Choice components = Choice::all;  ///< which components of an error have it
  std::vector<std::string> axes;    ///< for some: "x", "y", "z"; scalars are kept besides
};

/// What a study finds where the signs of errors are not known.
enum class UnknownSigns {
  search,  ///< the worst case (coupling/corners.h), and the first-order sum
  sum      ///< the first-order sum alone, which takes no solve of its own
};

std::string_view name(UnknownSigns signs);  ///< As a study file has it.

/// What a coupling study asks for.
struct CouplingStudy {
  std::vector<double> linear;                      ///< [Z] m, sizes of the runs; empty where no error is a length
  std::vector<double> angular;                     ///< [Z] rad; empty where no error is an angle
  ErrorPattern pattern;                            ///< of every source
  std::vector<ErrorSource> sources;                ///< no factor in two of them
  UnknownSigns worst_case = UnknownSigns::search;  ///< whether worst cases are looked for

  /// Of errors of this dimension, a length or an angle.
  const std::vector<double>& sizes_of(Dimension dimension) const {
    return dimension == Dimension::length ? linear : angular;
  }
  /// Z.
  std::size_t sizes() const { return linear.empty() ? angular.size() : linear.size(); }
};

/// The kind of study of error sources of fixed size, one by one and together.
extern const StudyKind kCouplingStudy;

/// Errors that have one size at once, and the others zero; in the order of the model.
using ErrorBlock = std::vector<FactorIndex>;

/// What a pattern makes of a source: the blocks of its errors that move together, by limb, then by frame, dimension
/// and axis. One block, unless limbs or components are independent; then one for each limb, for each component of each
/// of its vectors and scalars, or, where both are, for each error. Empty where the pattern leaves none of its errors.
std::vector<ErrorBlock> error_blocks(const ErrorSource& source, const ErrorPattern& pattern,
                                     const ModelDescription& model);

/// All subsets of n sources but the empty one, by the number of sources, then in the order of the sources: 0, 1, 2, 01,
/// 02, 12, 012.
std::vector<std::vector<std::size_t>> source_subsets(std::size_t sources);

/// The sets of errors that are solved at each size, none of them twice: the subsets, then the blocks of the sources
/// that have more than one.
struct CouplingRows {
  std::vector<std::vector<std::size_t>> subsets;     ///< [K] the sources in each; row k is subset k
  std::vector<std::vector<std::size_t>> block_rows;  ///< [sources] the rows of each source's blocks
  std::vector<ErrorBlock> errors;                    ///< [N] the errors of each row
};

/// Precondition: no factor in two sources.
CouplingRows coupling_rows(const CouplingStudy& study, const ModelDescription& model);

/// The errors that the pattern leaves of all sources, in the order of the model.
std::vector<FactorIndex> coupling_factors(const CouplingStudy& study, const ModelDescription& model);

/// The table to be solved at every pose: row z * N + n has the errors of row n at size z, all positive; its columns are
/// coupling_factors.
ErrorTable coupling_table(const CouplingStudy& study, const ModelDescription& model);

namespace axis {
using Size = Axis<"size">;      ///< Sizes of the errors.
using Source = Axis<"source">;  ///< Sources of errors.
using Subset = Axis<"subset">;  ///< Sets of sources that act at once.
}  // namespace axis

/// What error sources do one by one and together, in SI units. NaN where a solve that a number rests on does not count.
/// What each number means: coupling_result.
struct CouplingResult {
  /// A number of each response, size of the errors and subset of the sources, at each pose.
  using Curves = Array<double, axis::Response, axis::Size, axis::Subset, axis::Pose>;
  /// What becomes of it over the poses.
  template <class T>
  using Summary = Array<T, axis::Response, axis::Size, axis::Subset>;

  std::vector<std::string> size_names;  ///< "0.1 mm"
  std::vector<std::string> sources;     ///< names
  std::vector<std::string> subsets;     ///< "FS+T"
  Array<double, axis::Size> linear;     ///< m; NaN where no error is a length
  Array<double, axis::Size> angular;    ///< rad; NaN where no error is an angle

  Curves effect;                                       ///< all errors of the subset at once
  Curves sum;                                          ///< of what each source does alone
  Curves interaction;                                  ///< effect - sum
  Curves first_order_sum;                              ///< of the magnitudes of what each block does alone
  Curves worst_case;                                   ///< NaN where no corner is solved
  Curves root_sum_square;                              ///< of what each block does alone
  Curves cancellation;                                 ///< from 0 to 1
  Array<double, axis::Response, axis::Size> rounding;  ///< up to this a response to errors of the size is rounding

  // Over the poses where all of these are known; where there is none, NaN and pose -1.
  Summary<std::uint64_t> count;                 ///< such poses
  Summary<double> effect_max;                   ///< largest |effect|
  Summary<std::int64_t> effect_max_pose;        ///< the first pose that has it
  Summary<double> interaction_max;              ///< largest |interaction|
  Summary<double> first_order_sum_max;          ///< largest first-order sum
  Summary<double> root_sum_square_max;          ///< largest root sum square
  Summary<double> opposed_share;                ///< share of the poses where sources oppose each other
  Summary<double> cancellation_max;             ///< largest cancellation
  Summary<std::int64_t> cancellation_max_pose;  ///< the first pose that has it

  // The search for worst cases. Maxima are over all poses: where there is none, NaN, pose -1, and signs 0.
  Array<std::uint64_t, axis::Size, axis::Subset, axis::Pose> corners;  ///< corners behind the worst cases
  Array<std::uint64_t, axis::Size, axis::Subset, axis::Pose>
      unsolved_corners;                       ///< of these, corners without a solution
  Summary<double> worst_case_max;             ///< largest worst case
  Summary<std::int64_t> worst_case_max_pose;  ///< the first pose that has it
  /// There: 1, -1, or 0 where an error is zero.
  Array<std::int64_t, axis::Response, axis::Size, axis::Subset, axis::Factor> worst_case_signs;
  Array<std::int64_t, axis::Size, axis::Subset> unsolved_pose;  ///< the first pose with a corner that is not solved
  Array<std::int64_t, axis::Size, axis::Subset, axis::Factor> unsolved_signs;  ///< such a corner, likewise
  Array<SolveCounts, axis::Size, axis::Pose> solves;  ///< of all sets of errors and all corners that were solved

  /// Poses of the study.
  std::size_t poses() const { return effect.length<axis::Pose>(); }
  /// Over all sizes and poses.
  SolveCounts total() const { return total_of(solves.all()); }
};

/// Whether worst cases were looked for. Results of version 0.2.0 have first-order sums alone, too.
inline bool has_worst_cases(const CouplingResult& found) { return !found.worst_case.empty(); }

/// What sources of errors do one by one and together (San et al. 2023, Sections 5.2.1 and 5.2.2), at each size and
/// pose, for each subset S of the sources. A response is the effect of the errors that it is solved with: it has to be
/// zero where all errors are.
///
///     effect           all errors of S at once: the curve of a single source, or the coupled one
///     sum              sum over the sources in S of the effect of each alone
///     interaction      effect - sum; 0 for a single source
///     first_order_sum  sum over the blocks of S of |effect of the block alone| (see error_blocks)
///     worst_case       the largest |response| that was found with either sign of each block (coupling/corners.h)
///     root_sum_square  root of the sum of the squares of these
///     cancellation     1 - |sum| / (sum over the sources of |effect of each|): 0 where no source opposes another or
///                      where no more than rounding is cancelled, 1 where they cancel
///
/// To first order, first_order_sum is the most that the blocks do together where their signs are not known, and
/// root_sum_square the root mean square if either sign of each is as likely. Neither first_order_sum nor worst_case is
/// a bound. Where a response is a norm, which has no sign, no source can be seen to oppose another: sum and
/// first_order_sum then are upper bounds to first order, interaction is never above zero but by second order, and
/// cancellation is 0.
///
/// Summaries are over the poses where all of this is known. Sources oppose each other (opposed_share) where |sum| is
/// below the largest |effect of a source in S| by more than rounding: together they do less than one of them.
///
/// evaluation: what run_evaluation found for the study's coupling_table. A solve that does not count (see counts())
/// makes NaN of everything that rests on it, and is counted in `solves`. rounding: as coupling_rounding gives it. What
/// the search for worst cases finds is left out: add_worst_cases fills it in.
CouplingResult coupling_result(EvaluationResult evaluation, const CouplingStudy& study, const ModelDescription& model,
                               NotConverged policy, Array<double, axis::Response, axis::Size> rounding);

/// Up to which each response to errors of each size is rounding (stats/indices.h).
Array<double, axis::Response, axis::Size> coupling_rounding(const CouplingStudy& study, const Model& model);

/// The names of the sources in each subset, joined: "FS", "T", "FS+T".
std::vector<std::string> subset_names(std::span<const ErrorSource> sources);

/// Positions of the responses that no source moves by more than rounding at any size and pose, though it is known of
/// one.
std::vector<std::size_t> responses_without_effect(const CouplingResult& found);

/// Precondition: a coupling result.
inline const CouplingResult& coupling_of(const StoredResult& result) { return found_of<CouplingResult>(result); }

/// For each size and each response that a summary shows: a table with a row for each subset of
/// the sources. Columns: the largest |effect| over the poses and the pose where it is, by number and coordinates, the
/// largest root sum square, first-order sum, worst case and |interaction|, and where sources oppose each other: at
/// which share of the poses, and the pose where they cancel most, with the cancellation there. What the words mean is
/// below the last one.
std::vector<Table> coupling_tables(const StoredResult& result, const TableOptions& options = {});

}  // namespace poesy
