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

namespace poesy::axis {

using Size = Axis<"size">;      ///< Sizes of the errors.
using Source = Axis<"source">;  ///< Sources of errors.
using Subset = Axis<"subset">;  ///< Subsets of the sources, whose errors act together.

}  // namespace poesy::axis

namespace poesy::coupling {

/// A source of errors: a named list of errors whose joint effect the study computes.
struct ErrorSource {
  std::string name;  ///< name in tables; '+' joins it to the names of other sources
  /// Errors that the study lists for the source; the ErrorPattern may exclude some of them.
  std::vector<FactorIndex> factors;
};

/// A rule that states which errors of a source are not zero, and which of these have the same sign.
struct ErrorPattern {
  /// Which limbs, or which components of vectors, have errors.
  enum class Choice {
    all,         ///< all limbs or components, with the same sign
    some,        ///< only the named limbs or components, with the same sign
    independent  ///< all limbs or components, each with its own sign
  };

  Choice limbs = Choice::all;       ///< which limbs have errors, and with which signs
  std::size_t limb = 0;             ///< the limb for `some`, counted from 1
  Choice components = Choice::all;  ///< which components of an error vector are not zero, and with which signs
  std::vector<std::string> axes;    ///< the components for `some`: "x", "y", "z"; scalar errors are always included
};

/// What a study computes for errors whose signs are unknown.
enum class UnknownSigns {
  search,  ///< the worst case by search (coupling/corners.h), and the first-order sum
  sum      ///< only the first-order sum, which needs no additional solves
};

std::string_view name(UnknownSigns signs);  ///< The word for this choice in study files.

/// The options of a coupling study.
struct Options {
  std::vector<double> linear;        ///< [sizes] sizes of errors that are lengths, m; empty if no error is a length
  std::vector<double> angular;       ///< [sizes] sizes of errors that are angles, rad; empty if no error is an angle
  ErrorPattern pattern;              ///< which errors of each source are not zero, and which have the same sign
  std::vector<ErrorSource> sources;  ///< the sources; an error is in one source only
  UnknownSigns worst_case = UnknownSigns::search;  ///< whether the study searches for worst cases

  /// The sizes of errors of this dimension, a length or an angle.
  const std::vector<double>& sizes_of(Dimension dimension) const {
    return dimension == Dimension::length ? linear : angular;
  }
  /// The number of sizes.
  std::size_t sizes() const { return linear.empty() ? angular.size() : linear.size(); }
};

/// The kind of study that computes the effects of error sources of fixed size, alone and together.
extern const StudyKind kStudy;

/// Errors that always have the same sign, in the order of the model.
using ErrorBlock = std::vector<FactorIndex>;

/// The blocks into which a pattern divides the errors of a source, ordered by limb, frame, dimension and axis. A source
/// is one block, unless limbs or components are independent. Independent limbs give a block for each limb. Independent
/// components give a block for each component of a vector and for each scalar; such a block has the errors of all
/// limbs. If both are independent, each error is a block. Empty if the pattern excludes all errors.
std::vector<ErrorBlock> error_blocks(const ErrorSource& source, const ErrorPattern& pattern,
                                     const ModelDescription& model);

/// All non-empty subsets of n sources, ordered by the number of sources, then by the sources: 0, 1, 2, 01, 02, 12, 012.
std::vector<std::vector<std::size_t>> source_subsets(std::size_t sources);

/// The sets of errors that are solved at each size. First come the subsets of sources, then the blocks of those sources
/// that have more than one block. No set is solved twice.
struct CouplingRows {
  /// [subsets] Sources of each subset; row k has the errors of subset k.
  std::vector<std::vector<std::size_t>> subsets;
  /// [sources] Indices of the rows that have a single block of the source, one row for each block.
  std::vector<std::vector<std::size_t>> block_rows;
  std::vector<ErrorBlock> errors;  ///< [rows] errors of each row
};

/// The rows of a study. Precondition: no error is in two sources.
CouplingRows coupling_rows(const Options& study, const ModelDescription& model);

/// The errors of all sources that the pattern does not exclude, in the order of the model.
std::vector<FactorIndex> coupling_factors(const Options& study, const ModelDescription& model);

/// The table of errors that is solved at every pose. Its rows are all rows of CouplingRows at the first size, then all
/// at the second size, and so on. The errors of a row have their sizes, with positive sign; all others are 0. The
/// columns are coupling_factors().
ErrorTable coupling_table(const Options& study, const ModelDescription& model);

/// The effects of error sources alone and together, SI. coupling_result() defines each number. A number is NaN if it
/// depends on a solve that does not count in statistics (counts()).
struct Result {
  /// A number for each response, size, subset of the sources and pose.
  using Curves = Array<double, axis::Response, axis::Size, axis::Subset, axis::Pose>;
  /// A number for each response, size and subset, such as the largest magnitude of one of the Curves over the poses.
  template <class T>
  using Summary = Array<T, axis::Response, axis::Size, axis::Subset>;

  std::vector<std::string> size_names;  ///< names of the sizes: "0.1 mm"
  std::vector<std::string> sources;     ///< names of the sources
  std::vector<std::string> subsets;     ///< names of the subsets: "FS+T"
  Array<double, axis::Size> linear;     ///< size of errors that are lengths, m; NaN if no error is a length
  Array<double, axis::Size> angular;    ///< size of errors that are angles, rad; NaN if no error is an angle

  Curves effect;           ///< response to all errors of the subset at once
  Curves sum;              ///< sum of the responses to each source alone
  Curves interaction;      ///< effect - sum
  Curves first_order_sum;  ///< sum of |response to each block alone|
  Curves worst_case;       ///< largest |response| over the tried corners; NaN if no corner is solved
  Curves root_sum_square;  ///< root of the sum of squares of the responses to each block alone
  Curves cancellation;     ///< cancellation between sources, from 0 to 1, without unit
  Array<double, axis::Response, axis::Size> rounding;  ///< responses up to this magnitude are only rounding

  // Summaries over the poses at which all numbers above are known. If there is no such pose, values are NaN and poses
  // -1.
  Summary<std::uint64_t> count;                 ///< number of poses at which all numbers are known
  Summary<double> effect_max;                   ///< largest |effect|
  Summary<std::int64_t> effect_max_pose;        ///< first pose with the largest |effect|
  Summary<double> interaction_max;              ///< largest |interaction|
  Summary<double> first_order_sum_max;          ///< largest first-order sum
  Summary<double> root_sum_square_max;          ///< largest root sum square
  Summary<double> opposed_share;                ///< share of the poses where sources oppose each other
  Summary<double> cancellation_max;             ///< largest cancellation
  Summary<std::int64_t> cancellation_max_pose;  ///< first pose with the largest cancellation

  // Results of the search for worst cases. Maxima are over all poses. If no corner is solved, values are NaN, poses -1
  // and signs 0.
  Array<std::uint64_t, axis::Size, axis::Subset, axis::Pose> corners;  ///< number of corners that were tried
  /// Number of tried corners without a solution.
  Array<std::uint64_t, axis::Size, axis::Subset, axis::Pose> unsolved_corners;
  Summary<double> worst_case_max;             ///< largest worst case
  Summary<std::int64_t> worst_case_max_pose;  ///< first pose with the largest worst case
  /// The sign of each error at the corner of the largest worst case: 1, -1, or 0 if the error is zero.
  Array<std::int64_t, axis::Response, axis::Size, axis::Subset, axis::Factor> worst_case_signs;
  /// First pose with a corner that is not solved; -1 if there is none.
  Array<std::int64_t, axis::Size, axis::Subset> unsolved_pose;
  /// The sign of each error at the first corner that is not solved: 1, -1, or 0 if the error is zero. 0 if all corners
  /// are solved.
  Array<std::int64_t, axis::Size, axis::Subset, axis::Factor> unsolved_signs;
  Array<SolveCounts, axis::Size, axis::Pose> solves;  ///< how the solves of all sets of errors and all corners ended

  /// The number of poses of the study.
  std::size_t poses() const { return effect.length<axis::Pose>(); }
  /// How the solves ended, summed over sizes and poses.
  SolveCounts total() const { return total_of(solves.all()); }
};

/// Whether the study searched for worst cases. Studies with UnknownSigns::sum, and results of version 0.2.0, have only
/// first-order sums.
inline bool has_worst_cases(const Result& found) { return !found.worst_case.empty(); }

/// Computes the effects of error sources alone and together (San et al. 2023, Sections 5.2.1 and 5.2.2), at each size
/// and pose, for each subset S of the sources. The effect of errors is the response itself, so a response must be zero
/// if all errors are zero.
///
///     effect           the response to all errors of S at once
///     sum              sum over the sources in S of the effect of each alone
///     interaction      effect - sum; 0 for a single source
///     first_order_sum  sum over the blocks of S of |effect of the block alone| (see error_blocks)
///     worst_case       the largest |response| that was found with either sign of each block (coupling/corners.h)
///     root_sum_square  root of the sum over the blocks of S of (effect of the block alone)^2
///     cancellation     1 - |sum| / (sum over the sources in S of |effect of each alone|): 0 if no source opposes
///                      another or if no more than rounding is cancelled, 1 if the sources cancel completely
///
/// To first order, first_order_sum is the largest effect of the blocks if their signs are unknown, and root_sum_square
/// is the root mean square effect if the signs of the blocks are independent and equally likely. Neither
/// first_order_sum nor worst_case is a bound. A norm has no sign, so it cannot show that sources oppose each other. For
/// a norm, to first order, sum and first_order_sum are upper bounds, interaction is at most zero, and cancellation is
/// 0.
///
/// Summaries are over the poses at which all these numbers are known. Sources oppose each other (opposed_share) at a
/// pose if together they have less effect than one of them alone: |sum| is below the largest |effect of a source in S|
/// by more than rounding.
///
/// evaluation: result of run_evaluation() for coupling_table() of the study. A solve that does not count (see counts())
/// makes every number that depends on it NaN, and is counted in `solves`. rounding: see coupling_rounding(). The arrays
/// of worst cases are empty until add_worst_cases() sets them.
Result coupling_result(EvaluationResult evaluation, const Options& study, const ModelDescription& model,
                       NotConverged policy, Array<double, axis::Response, axis::Size> rounding);

/// [responses x sizes] For each response and size, the magnitude up to which a response to errors of this size is
/// rounding (stats/indices.h).
Array<double, axis::Response, axis::Size> coupling_rounding(const Options& study, const Model& model);

/// The names of the sources in each subset, joined: "FS", "T", "FS+T".
std::vector<std::string> subset_names(std::span<const ErrorSource> sources);

/// Indices of the responses on which no subset of the sources has an effect larger than rounding, at any size and at
/// any pose with known effects. Precondition: the effect of some source is known.
std::vector<std::size_t> responses_without_effect(const Result& found);

/// The coupling result in a stored result. Precondition: the result is of kind `coupling`.
inline const Result& coupling_of(const StoredResult& result) { return found_of<Result>(result); }

/// A table for each size and each response that a summary shows, with a row for each subset of the sources. Its columns
/// are: the largest |effect| over the poses, with its pose; the largest root sum square, first-order sum, worst case
/// and |interaction|; the share of the poses at which sources oppose each other; and the largest cancellation, with its
/// pose. Notes below the last table explain the words.
std::vector<Table> coupling_tables(const StoredResult& result, const TableOptions& options = {});

}  // namespace poesy::coupling
