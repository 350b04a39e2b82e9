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
/// What variances are shared among. The axis has another name in a file whose errors are not joined: "factor".
using ErrorGroup = Axis<"group">;
using OtherGroup = Axis<"other">;     ///< The second group of a pair.
using SignedVector = Axis<"vector">;  ///< Vectors with a sign, whose components have one unit.
}  // namespace axis

/// By what errors are joined to groups, whose members vary at once.
enum class GroupsBy {
  none,   ///< each error is a group of its own
  limb,   ///< the errors of a limb
  frame,  ///< the errors of one frame of a limb
  name    ///< as the study lists them
};

/// How samples fill the space of the errors.
enum class Design {
  random,  ///< independent draws
  lhs,     ///< Latin hypercubes
  sobol    ///< scrambled Sobol' points
};

/// Errors that the study names as a group, by patterns: "delta_1_4_*".
struct NamedGroup {
  std::string name;                   ///< for people
  std::vector<std::string> patterns;  ///< '*' stands for any letters, '?' for one
};

/// Shapley effects take a solve for each subset of the groups, so there are at most so many.
inline constexpr std::size_t kMostShapleyGroups = 8;

/// What a study of Sobol' indices alone asks.
struct SobolOptions {
  GroupsBy groups_by = GroupsBy::none;   ///< how errors are joined
  std::vector<NamedGroup> named_groups;  ///< for GroupsBy::name
  bool second_order = false;             ///< whether the index of each pair of groups is asked for
  bool shapley = false;                  ///< whether Shapley effects are asked for
  Design design = Design::random;        ///< how samples are drawn
  std::size_t replicates = 16;           ///< independent repetitions of a design that is not random
};

std::string_view name(GroupsBy by);    ///< As a study file has it.
std::string_view name(Design design);  ///< As a study file has it.

/// The kind of study that divides the variance of each response among the errors.
extern const StudyKind kSobolStudy;

/// Shares of the variance of some quantities, with the ends of their intervals: NaN where a quantity does not vary
/// (stats/indices.h), and for a group with errors that are correlated with errors of other groups.
template <NamedAxis... Axes>
struct Shares {
  using Values = Array<double, Axes...>;     ///< One for each quantity and group, or for each pose of these.
  using Lengths = typename Values::Lengths;  ///< Of the axes.

  Shares() = default;
  /// Of these lengths, all NaN.
  explicit Shares(const Lengths& lengths) : value(lengths, kNaN), ci_low(lengths, kNaN), ci_high(lengths, kNaN) {}

  /// Sets the one at these positions.
  template <std::integral... Positions>
  void set(const Estimate& estimate, Positions... at) {
    value(at...) = estimate.value;
    ci_low(at...) = estimate.interval.low;
    ci_high(at...) = estimate.interval.high;
  }
  /// Makes those at these positions on the first axes NaN.
  template <std::integral... Positions>
  void leave_out(Positions... at) {
    for (Values* values : {&value, &ci_low, &ci_high}) std::ranges::fill(values->row(at...), kNaN);
  }
  bool empty() const { return value.empty(); }  ///< Whether the study was not asked for them.

  Values value;    ///< estimates
  Values ci_low;   ///< lower ends
  Values ci_high;  ///< upper ends
};

/// Sobol' indices of some quantities.
template <NamedAxis... Axes>
struct SobolIndices {
  double conf_level = 0.95;  ///< of the intervals
  Shares<Axes...> S1;        ///< first-order index; of several errors their closed index
  Shares<Axes...> ST;        ///< total index
};

/// What a study of Sobol' indices found. A group is an error of its own unless the study joins errors.
struct SobolResult {
  bool joined = false;                     ///< whether errors are joined to groups
  std::vector<std::string> group_names;    ///< of an error of its own that error's
  std::vector<std::string> group_members;  ///< names of a group's errors, with blanks between
  std::vector<std::string> vectors;        ///< names of the vectors with a sign
  SobolIndices<axis::Response, axis::ErrorGroup, axis::Pose> at_poses;  ///< of each response at each pose
  /// Sums of the parts over the poses, over the sum of the variances.
  SobolIndices<axis::Response, axis::ErrorGroup> aggregated;
  /// Likewise, of the traces (Gamboa et al. 2014).
  SobolIndices<axis::SignedVector, axis::ErrorGroup> of_vectors;
  Array<std::uint64_t, axis::Response, axis::ErrorGroup, axis::Pose> n;  ///< pairs of samples behind at_poses
  Array<double, axis::Response, axis::Pose> mean;                        ///< of the response
  Array<double, axis::Response, axis::Pose> variance;                    ///< of the response, that its indices share
  Array<std::uint8_t, axis::Response> without_sign;                      ///< whether no sample was below zero: 0 or 1
  /// Aggregated, of a pair without its members' own, which is as well that of the pair in the other order. NaN where no
  /// pair is.
  Shares<axis::Response, axis::ErrorGroup, axis::OtherGroup> S2;
  Shares<axis::Response, axis::ErrorGroup> Sh;                  ///< aggregated Shapley effects, which add up to 1
  std::vector<SolveCounts> solves;                              ///< of each pose
  std::vector<Failure> failures;                                ///< the first, in the order of poses and samples
  std::uint64_t failed_samples = 0;                             ///< how many there are; other solves have no addresses
  std::optional<ConvergenceResult> convergence = std::nullopt;  ///< where the study has adaptive samples

  Array<std::uint8_t, axis::Response> varies;             ///< whether it varies, 0 or 1; empty where all do
  Array<std::uint8_t, axis::SignedVector> vector_varies;  ///< likewise

  std::size_t groups() const { return group_names.size(); }  ///< Number of groups.
  SolveCounts total() const { return total_of(solves); }     ///< Over all poses.
};

/// Bytes of the numbers of a result whose axes have these lengths; "group" is the axis of what variances are shared
/// among, and "other" has none where no pairs are asked for.
std::size_t sobol_bytes(const AxisLengths& lengths);

/// What a study of Sobol' indices found, read back. Precondition: a result of that kind.
inline const SobolResult& sobol_of(const StoredResult& result) { return found_of<SobolResult>(result); }

/// Of each response of the headline its errors with first-order and total index over the workspace, then the signed
/// vectors, then the pairs of groups.
std::vector<Table> sobol_tables(const StoredResult& result, const TableOptions& options = {});

}  // namespace poesy
