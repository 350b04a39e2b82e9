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

/// A set of errors whose effect is judged together.
struct ErrorSource {
  std::string name;                  ///< name in tables, joined to other names by '+'
  std::vector<FactorIndex> factors;  ///< as the study names them; the pattern may leave out some of them
};

/// Which errors of a source have its size, and which of these vary together.
struct ErrorPattern {
  /// Which limbs or components have errors.
  enum class Choice {
    all,         ///< all, together
    some,        ///< those that are named, together
    independent  ///< all, each on its own
  };

  Choice limbs = Choice::all;       ///< which limbs' errors have the size
  std::size_t limb = 0;             ///< for `some`: the limb, counted from 1
  Choice components = Choice::all;  ///< which components of an error have the size
  std::vector<std::string> axes;    ///< for `some`: "x", "y", "z"; scalars are always included
};

/// What a study computes for errors of unknown sign.
enum class UnknownSigns {
  search,  ///< the worst case (coupling/corners.h) and the first-order sum
  sum      ///< only the first-order sum, which takes no further solves
};

std::string_view name(UnknownSigns signs);  ///< The word in a study file.

/// The options of a coupling study.
struct CouplingStudy {
  std::vector<double> linear;                      ///< [Z] lengths of the runs, m; empty if no error is a length
  std::vector<double> angular;                     ///< [Z] angles of the runs, rad; empty if no error is an angle
  ErrorPattern pattern;                            ///< the pattern of every source
  std::vector<ErrorSource> sources;                ///< the sources; no factor is in two of them
  UnknownSigns worst_case = UnknownSigns::search;  ///< whether worst cases are searched

  /// The sizes of errors of this dimension, a length or an angle.
  const std::vector<double>& sizes_of(Dimension dimension) const {
    return dimension == Dimension::length ? linear : angular;
  }
  /// The number of sizes, Z.
  std::size_t sizes() const { return linear.empty() ? angular.size() : linear.size(); }
};

/// The kind of study that computes the effects of error sources of fixed size, alone and together.
extern const StudyKind kCouplingStudy;

/// Errors that have one size together while all others are zero; in the order of the model.
using ErrorBlock = std::vector<FactorIndex>;

/// The blocks into which a pattern divides the errors of a source, by limb, then by frame, dimension and axis. There is
/// one block, unless limbs or components are independent. Then there is one for each limb, one for each component of
/// each vector and each scalar, or, where both are independent, one for each error. Empty if the pattern leaves no
/// errors.
std::vector<ErrorBlock> error_blocks(const ErrorSource& source, const ErrorPattern& pattern,
                                     const ModelDescription& model);

/// All non-empty subsets of n sources, by the number of sources, then in the order of the sources: 0, 1, 2, 01, 02, 12,
/// 012.
std::vector<std::vector<std::size_t>> source_subsets(std::size_t sources);

/// The sets of errors that are solved at each size: the subsets, then the blocks of the sources that have more than
/// one. No set is there twice.
struct CouplingRows {
  std::vector<std::vector<std::size_t>> subsets;     ///< [K] the sources in each; row k is subset k
  std::vector<std::vector<std::size_t>> block_rows;  ///< [sources] the rows of each source's blocks
  std::vector<ErrorBlock> errors;                    ///< [N] the errors of each row
};

/// The rows of a study. Precondition: no factor is in two sources.
CouplingRows coupling_rows(const CouplingStudy& study, const ModelDescription& model);

/// The errors of all sources that the pattern leaves, in the order of the model.
std::vector<FactorIndex> coupling_factors(const CouplingStudy& study, const ModelDescription& model);

/// The table of errors that is solved at every pose: row z * N + n has the errors of row n at size z, all positive; the
/// columns are coupling_factors().
ErrorTable coupling_table(const CouplingStudy& study, const ModelDescription& model);

namespace axis {
using Size = Axis<"size">;      ///< Sizes of the errors.
using Source = Axis<"source">;  ///< Sources of errors.
using Subset = Axis<"subset">;  ///< Sets of sources that act together.
}  // namespace axis

/// The effects of error sources alone and together, SI; coupling_result() defines each number. NaN where a number
/// depends on a solve that does not count.
struct CouplingResult {
  /// A number for each response, size, subset of the sources and pose.
  using Curves = Array<double, axis::Response, axis::Size, axis::Subset, axis::Pose>;
  /// A number that summarises a curve over the poses.
  template <class T>
  using Summary = Array<T, axis::Response, axis::Size, axis::Subset>;

  std::vector<std::string> size_names;  ///< "0.1 mm"
  std::vector<std::string> sources;     ///< names of the sources
  std::vector<std::string> subsets;     ///< names of the subsets: "FS+T"
  Array<double, axis::Size> linear;     ///< size of lengths, m; NaN if no error is a length
  Array<double, axis::Size> angular;    ///< size of angles, rad; NaN if no error is an angle

  Curves effect;           ///< all errors of the subset at once
  Curves sum;              ///< sum of the effects of each source alone
  Curves interaction;      ///< effect - sum
  Curves first_order_sum;  ///< sum of |effect of each block alone|
  Curves worst_case;       ///< NaN where no corner is solved
  Curves root_sum_square;  ///< root of the sum of squares of the effects of each block alone
  Curves cancellation;     ///< from 0 to 1
  Array<double, axis::Response, axis::Size>
      rounding;  ///< a response to errors of this size that is no larger is rounding

  // Over the poses where all of these numbers are known; NaN and pose -1 if there is none.
  Summary<std::uint64_t> count;                 ///< number of these poses
  Summary<double> effect_max;                   ///< largest |effect|
  Summary<std::int64_t> effect_max_pose;        ///< the first pose of that value
  Summary<double> interaction_max;              ///< largest |interaction|
  Summary<double> first_order_sum_max;          ///< largest first-order sum
  Summary<double> root_sum_square_max;          ///< largest root sum square
  Summary<double> opposed_share;                ///< share of the poses where sources oppose each other
  Summary<double> cancellation_max;             ///< largest cancellation
  Summary<std::int64_t> cancellation_max_pose;  ///< the first pose of that value

  // The search for worst cases. Maxima are over all poses; NaN, pose -1 and signs 0 if there is none.
  Array<std::uint64_t, axis::Size, axis::Subset, axis::Pose> corners;  ///< corners that were tried for the worst cases
  Array<std::uint64_t, axis::Size, axis::Subset, axis::Pose>
      unsolved_corners;                       ///< corners among them without a solution
  Summary<double> worst_case_max;             ///< largest worst case
  Summary<std::int64_t> worst_case_max_pose;  ///< the first pose of that value
  /// The sign of each error there: 1, -1, or 0 where an error is zero.
  Array<std::int64_t, axis::Response, axis::Size, axis::Subset, axis::Factor> worst_case_signs;
  Array<std::int64_t, axis::Size, axis::Subset>
      unsolved_pose;  ///< the first pose with a corner that is not solved; -1 if there is none
  Array<std::int64_t, axis::Size, axis::Subset, axis::Factor>
      unsolved_signs;                                 ///< the sign of each error at such a corner; 0 if there is none
  Array<SolveCounts, axis::Size, axis::Pose> solves;  ///< solves of all sets of errors and all corners

  /// The number of poses of the study.
  std::size_t poses() const { return effect.length<axis::Pose>(); }
  /// The solves at all sizes and poses.
  SolveCounts total() const { return total_of(solves.all()); }
};

/// Whether worst cases were searched. Results of version 0.2.0 have only first-order sums too.
inline bool has_worst_cases(const CouplingResult& found) { return !found.worst_case.empty(); }

/// The effects of error sources alone and together (San et al. 2023, Sections 5.2.1 and 5.2.2), at each size and pose,
/// for each subset S of the sources. A response serves as the effect of the errors it is solved with, so it must be
/// zero if all errors are zero.
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
/// To first order, first_order_sum is the largest effect of the blocks together if their signs are not known, and
/// root_sum_square is the root mean square if both signs of each are equally likely. Neither first_order_sum nor
/// worst_case is a bound. If a response is a norm, which has no sign, sources cannot be seen to oppose each other: to
/// first order sum and first_order_sum are then upper bounds and interaction is at most zero, and cancellation is 0.
///
/// Summaries are over the poses where all of these are known. Sources oppose each other (opposed_share) where |sum| is
/// below the largest |effect of a source in S| by more than rounding: together they have less effect than one of them.
///
/// evaluation: what run_evaluation() found for the study's coupling_table(). A solve that does not count (see counts())
/// makes NaN of everything that depends on it, and is counted in `solves`. rounding: see coupling_rounding(). Worst
/// cases are left empty; add_worst_cases() fills them in.
CouplingResult coupling_result(EvaluationResult evaluation, const CouplingStudy& study, const ModelDescription& model,
                               NotConverged policy, Array<double, axis::Response, axis::Size> rounding);

/// For each response and size, the magnitude up to which a response to errors of that size is rounding
/// (stats/indices.h).
Array<double, axis::Response, axis::Size> coupling_rounding(const CouplingStudy& study, const Model& model);

/// The names of the sources in each subset, joined: "FS", "T", "FS+T".
std::vector<std::string> subset_names(std::span<const ErrorSource> sources);

/// Positions of the responses on which the sources have no more effect than rounding, at all sizes and poses where
/// effects are known. An effect of at least one source must be known.
std::vector<std::size_t> responses_without_effect(const CouplingResult& found);

/// The coupling result in a stored result. Precondition: the result is of that kind.
inline const CouplingResult& coupling_of(const StoredResult& result) { return found_of<CouplingResult>(result); }

/// For each size and each response that a summary shows: a table with a row for each subset of
/// the sources. Columns: the largest |effect| over the poses and the pose where it is, by number and coordinates, the
/// largest root sum square, first-order sum, worst case and |interaction|, and where sources oppose each other: at
/// which share of the poses, and the pose where they cancel most, with the cancellation there. What the words mean is
/// below the last one.
std::vector<Table> coupling_tables(const StoredResult& result, const TableOptions& options = {});

}  // namespace poesy
