#pragma once

#include <algorithm>
#include <concepts>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "engine/base/array.h"
#include "engine/base/nan.h"
#include "engine/report/tables.h"
#include "engine/result/fields.h"
#include "engine/result/result_file.h"
#include "engine/run/result.h"
#include "engine/stats/moments.h"
#include "engine/study/study.h"

namespace poesy::axis {

/// Errors, or groups of errors, among which variances are divided. In the file of a study that does not join errors,
/// the axis has the name "factor".
using ErrorGroup = Axis<"group">;
using OtherGroup = Axis<"other">;     ///< Second groups of pairs.
using SignedVector = Axis<"vector">;  ///< Vectors of components with a sign and one unit.

}  // namespace poesy::axis

namespace poesy::sobol {

/// How errors are joined into groups. The errors of a group vary together.
enum class GroupsBy {
  none,   ///< each error is a group
  limb,   ///< all errors of a limb
  frame,  ///< all errors of a frame of a limb
  name    ///< groups that the study lists
};

/// How the samples are placed in the space of the errors.
enum class Design {
  random,  ///< independent draws
  lhs,     ///< Latin hypercubes
  sobol    ///< scrambled Sobol' points
};

/// A group of errors that the study names by patterns: "delta_1_4_*".
struct NamedGroup {
  std::string name;                   ///< name of the group
  std::vector<std::string> patterns;  ///< patterns of error names; '*' matches any characters, '?' one
};

/// The largest number of groups for Shapley effects, which need a solve for each subset of the groups.
inline constexpr std::size_t kMostShapleyGroups = 8;

/// The options of a study of Sobol' indices.
struct Options {
  GroupsBy groups_by = GroupsBy::none;   ///< how errors are joined
  std::vector<NamedGroup> named_groups;  ///< groups that the study lists, for GroupsBy::name
  bool second_order = false;             ///< whether the second-order index of each pair of groups is computed
  bool shapley = false;                  ///< whether Shapley effects are computed
  Design design = Design::random;        ///< how samples are placed
  std::size_t replicates = 16;           ///< number of independent repetitions, for a design that is not random
};

std::string_view name(GroupsBy by);    ///< The word for this choice in study files.
std::string_view name(Design design);  ///< The word for this design in study files.

/// The kind of study `sobol`, which divides the variance of each response among the errors.
extern const StudyKind kStudy;

/// Shares that errors or groups have in the variance of some quantities, with confidence intervals. NaN for a quantity
/// that does not vary (stats/indices.h), and for a group whose errors are correlated with errors of other groups.
template <NamedAxis... Axes>
struct Shares {
  using Values = Array<double, Axes...>;     ///< A share for each position on the axes.
  using Lengths = typename Values::Lengths;  ///< Lengths of the axes.

  Shares() = default;
  /// Shares with axes of these lengths, all NaN.
  explicit Shares(const Lengths& lengths) : value(lengths, kNaN), ci_low(lengths, kNaN), ci_high(lengths, kNaN) {}

  /// Sets the share at these positions, and its interval.
  template <std::integral... Positions>
  void set(const Estimate& estimate, Positions... at) {
    value(at...) = estimate.value;
    ci_low(at...) = estimate.interval.low;
    ci_high(at...) = estimate.interval.high;
  }
  /// Sets the shares to NaN at these positions on the first axes.
  template <std::integral... Positions>
  void leave_out(Positions... at) {
    for (Values* values : {&value, &ci_low, &ci_high}) std::ranges::fill(values->row(at...), kNaN);
  }
  bool empty() const { return value.empty(); }  ///< Whether the study did not compute these shares.

  Values value;    ///< estimated shares
  Values ci_low;   ///< lower ends of the intervals
  Values ci_high;  ///< upper ends of the intervals
};

/// Sobol' indices of some quantities.
template <NamedAxis... Axes>
struct SobolIndices {
  double conf_level = 0.95;  ///< confidence level of the intervals
  Shares<Axes...> S1;        ///< first-order index; for a group of errors, the closed index
  Shares<Axes...> ST;        ///< total index
};

/// The result of a study of Sobol' indices. Each error is a group, unless the study joins errors.
struct Result {
  bool joined = false;                     ///< whether errors are joined into groups
  std::vector<std::string> group_names;    ///< names of the groups; a group of one error has the name of the error
  std::vector<std::string> group_members;  ///< names of each group's errors, separated by blanks
  std::vector<std::string> vectors;        ///< names of the signed vectors
  SobolIndices<axis::Response, axis::ErrorGroup, axis::Pose> at_poses;  ///< indices of each response at each pose
  /// Indices over all poses: the variance that a group causes, summed over the poses, divided by the sum of all
  /// variances.
  SobolIndices<axis::Response, axis::ErrorGroup> aggregated;
  /// Indices of vectors over all poses, from the traces of their covariances (Gamboa et al. 2014).
  SobolIndices<axis::SignedVector, axis::ErrorGroup> of_vectors;
  /// Number of samples from which `at_poses` is computed: those for which the solves of A, B and the mixture of the
  /// group (IndexPanel) count in statistics.
  Array<std::uint64_t, axis::Response, axis::ErrorGroup, axis::Pose> n;
  Array<double, axis::Response, axis::Pose> mean;  ///< mean of the response, SI
  /// Variance of the response, SI; the indices at a pose are shares of it.
  Array<double, axis::Response, axis::Pose> variance;
  Array<std::uint8_t, axis::Response> without_sign;  ///< 1 if no sample of the response was negative, otherwise 0
  /// Second-order indices of pairs of groups over all poses: the share of the variance that the two groups cause only
  /// together. Symmetric; NaN for a group with itself.
  Shares<axis::Response, axis::ErrorGroup, axis::OtherGroup> S2;
  Shares<axis::Response, axis::ErrorGroup> Sh;  ///< Shapley effects over all poses, which add up to 1
  std::vector<SolveCounts> solves;              ///< [poses] how the solves at each pose ended
  std::vector<Failure> failures;                ///< first failed samples, ordered by pose and sample
  /// Number of failed samples among the draws A (IndexPanel); 0 if `poesy replay` cannot repeat them.
  std::uint64_t failed_samples = 0;
  /// Indices after each round of adaptive samples; set if the study has adaptive samples.
  std::optional<ConvergenceResult> convergence = std::nullopt;

  Array<std::uint8_t, axis::Response> varies;             ///< 1 if the response varies, otherwise 0; empty if all vary
  Array<std::uint8_t, axis::SignedVector> vector_varies;  ///< 1 if the vector varies, otherwise 0; empty if all vary

  std::size_t groups() const { return group_names.size(); }  ///< The number of groups.
  SolveCounts total() const { return total_of(solves); }     ///< How the solves at all poses ended.
};

/// Bytes of the numbers of a result with axes of these lengths. The axis "group" has the groups, or the errors if they
/// are not joined; "other" has length 0 without second-order indices.
std::size_t sobol_bytes(const AxisLengths& lengths);

/// The Sobol' indices in a stored result. Precondition: the result is of kind `sobol`.
inline const Result& sobol_of(const StoredResult& result) { return found_of<Result>(result); }

/// Tables of first-order and total indices over all poses for each response that a summary shows, then tables of the
/// signed vectors and of the pairs of groups.
std::vector<Table> sobol_tables(const StoredResult& result, const TableOptions& options = {});

}  // namespace poesy::sobol
