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

namespace poesy {

namespace axis {
/// What variances are divided among. In a file whose errors are not joined, the axis has the name "factor".
using ErrorGroup = Axis<"group">;
using OtherGroup = Axis<"other">;     ///< The second group of a pair.
using SignedVector = Axis<"vector">;  ///< Vectors with a sign, whose components have one unit.
}  // namespace axis

/// How errors are joined into groups, whose members vary together.
enum class GroupsBy {
  none,   ///< each error is a group of its own
  limb,   ///< the errors of a limb
  frame,  ///< the errors of one frame of a limb
  name    ///< groups that the study lists
};

/// How samples fill the space of the errors.
enum class Design {
  random,  ///< independent draws
  lhs,     ///< Latin hypercubes
  sobol    ///< scrambled Sobol' points
};

/// Errors that the study names as a group, by patterns: "delta_1_4_*".
struct NamedGroup {
  std::string name;                   ///< name for people
  std::vector<std::string> patterns;  ///< '*' matches any characters, '?' one
};

/// The largest number of groups for Shapley effects, which take a solve for each subset of the groups.
inline constexpr std::size_t kMostShapleyGroups = 8;

/// The options of a study of Sobol' indices.
struct SobolOptions {
  GroupsBy groups_by = GroupsBy::none;   ///< how errors are joined
  std::vector<NamedGroup> named_groups;  ///< for GroupsBy::name
  bool second_order = false;             ///< whether the index of each pair of groups is wanted
  bool shapley = false;                  ///< whether Shapley effects are wanted
  Design design = Design::random;        ///< how samples are drawn
  std::size_t replicates = 16;           ///< independent repetitions of a design that is not random
};

std::string_view name(GroupsBy by);    ///< The word in a study file.
std::string_view name(Design design);  ///< The word in a study file.

/// The kind of study that divides the variance of each response among the errors.
extern const StudyKind kSobolStudy;

/// Shares of the variance of some quantities, with the ends of their intervals. NaN if a quantity does not vary
/// (stats/indices.h), and for a group whose errors are correlated with errors of other groups.
template <NamedAxis... Axes>
struct Shares {
  using Values = Array<double, Axes...>;     ///< A share for each quantity and group, or for each pose of these.
  using Lengths = typename Values::Lengths;  ///< Lengths of the axes.

  Shares() = default;
  /// Shares with axes of these lengths, all NaN.
  explicit Shares(const Lengths& lengths) : value(lengths, kNaN), ci_low(lengths, kNaN), ci_high(lengths, kNaN) {}

  /// Sets the share at these positions.
  template <std::integral... Positions>
  void set(const Estimate& estimate, Positions... at) {
    value(at...) = estimate.value;
    ci_low(at...) = estimate.interval.low;
    ci_high(at...) = estimate.interval.high;
  }
  /// Sets the shares at these positions on the first axes to NaN.
  template <std::integral... Positions>
  void leave_out(Positions... at) {
    for (Values* values : {&value, &ci_low, &ci_high}) std::ranges::fill(values->row(at...), kNaN);
  }
  bool empty() const { return value.empty(); }  ///< Whether the study does not have these shares.

  Values value;    ///< estimates
  Values ci_low;   ///< lower ends
  Values ci_high;  ///< upper ends
};

/// Sobol' indices of some quantities.
template <NamedAxis... Axes>
struct SobolIndices {
  double conf_level = 0.95;  ///< level of the intervals
  Shares<Axes...> S1;        ///< first-order index; for several errors the closed index
  Shares<Axes...> ST;        ///< total index
};

/// The result of a study of Sobol' indices. Each error is a group of its own unless the study joins errors.
struct SobolResult {
  bool joined = false;                     ///< whether errors are joined into groups
  std::vector<std::string> group_names;    ///< names of the groups; a single error has its own name
  std::vector<std::string> group_members;  ///< names of each group's errors, separated by blanks
  std::vector<std::string> vectors;        ///< names of the signed vectors
  SobolIndices<axis::Response, axis::ErrorGroup, axis::Pose> at_poses;  ///< indices of each response at each pose
  /// Indices over all poses: sums of each part of the variance over the poses, over the sum of the variances.
  SobolIndices<axis::Response, axis::ErrorGroup> aggregated;
  /// Indices of vectors over all poses, by the traces of their covariances (Gamboa et al. 2014).
  SobolIndices<axis::SignedVector, axis::ErrorGroup> of_vectors;
  Array<std::uint64_t, axis::Response, axis::ErrorGroup, axis::Pose> n;  ///< pairs of samples for at_poses
  Array<double, axis::Response, axis::Pose> mean;                        ///< mean of the response
  Array<double, axis::Response, axis::Pose> variance;  ///< variance of the response, which its indices divide
  Array<std::uint8_t, axis::Response> without_sign;    ///< whether no sample was negative, 0 or 1
  /// Second-order indices over all poses, without the indices of the members; symmetric. NaN for a group with itself.
  Shares<axis::Response, axis::ErrorGroup, axis::OtherGroup> S2;
  Shares<axis::Response, axis::ErrorGroup> Sh;  ///< Shapley effects over all poses, which add up to 1
  std::vector<SolveCounts> solves;              ///< [M]
  std::vector<Failure> failures;                ///< the first failures, in the order of poses and samples
  std::uint64_t failed_samples = 0;             ///< number of failed samples that have an address
  std::optional<ConvergenceResult> convergence = std::nullopt;  ///< set if the study has adaptive samples

  Array<std::uint8_t, axis::Response> varies;             ///< whether each response varies, 0 or 1; empty if all do
  Array<std::uint8_t, axis::SignedVector> vector_varies;  ///< whether each vector varies, 0 or 1; empty if all do

  std::size_t groups() const { return group_names.size(); }  ///< The number of groups.
  SolveCounts total() const { return total_of(solves); }     ///< The solves at all poses.
};

/// Bytes of the numbers of a result with axes of these lengths. "group" is the axis that divides variances; "other" has
/// length 0 without second-order indices.
std::size_t sobol_bytes(const AxisLengths& lengths);

/// The Sobol' indices in a stored result. Precondition: the result is of that kind.
inline const SobolResult& sobol_of(const StoredResult& result) { return found_of<SobolResult>(result); }

/// Tables of first-order and total indices over the workspace for each response of the headline, then of the signed
/// vectors, then of the pairs of groups.
std::vector<Table> sobol_tables(const StoredResult& result, const TableOptions& options = {});

}  // namespace poesy
