#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "engine/report/tables.h"
#include "engine/result/result_file.h"
#include "engine/run/result.h"
#include "engine/study/study.h"

namespace poesy {

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

/// Indices of some quantities to P groups, with their intervals: shares of a variance, NaN where a quantity does not
/// vary (stats/indices.h), and for a group with errors that are correlated with errors of other groups.
struct SobolIndices {
  double conf_level = 0.95;        ///< of the intervals
  std::vector<double> S1;          ///< first-order index; of several errors their closed index
  std::vector<double> S1_ci_low;   ///< lower ends
  std::vector<double> S1_ci_high;  ///< upper ends
  std::vector<double> ST;          ///< total index
  std::vector<double> ST_ci_low;   ///< lower ends
  std::vector<double> ST_ci_high;  ///< upper ends
};

/// What a study of Sobol' indices found: R responses and V signed vectors, P groups of errors, M poses. A group is an
/// error of its own unless the study joins errors.
struct SobolResult {
  std::size_t responses = 0;               ///< R
  std::size_t poses = 0;                   ///< M
  bool joined = false;                     ///< whether errors are joined to groups
  std::vector<std::string> group_names;    ///< [P] of an error of its own that error's
  std::vector<std::string> group_members;  ///< [P] names of a group's errors, with blanks between
  std::vector<std::string> vectors;        ///< [V] names
  SobolIndices at_poses;                   ///< [R x P x M]
  SobolIndices aggregated;                 ///< [R x P] sums of the parts over the poses, over the sum of the variances
  SobolIndices of_vectors;                 ///< [V x P] likewise, of the traces (Gamboa et al. 2014)
  std::vector<std::uint64_t> n;            ///< [R x P x M] pairs of samples behind at_poses
  std::vector<double> mean;                ///< [R x M] of the response
  std::vector<double> variance;            ///< [R x M] of the response, that its indices share
  std::vector<std::uint8_t> without_sign;  ///< [R] whether no sample was below zero: 0 or 1
  std::vector<double> S2;                  ///< [R x P x P] aggregated, of a pair without its members' own; or empty
  std::vector<double> S2_ci_low;           ///< [R x P x P] lower ends; NaN where no pair is
  std::vector<double> S2_ci_high;          ///< [R x P x P] upper ends
  std::vector<double> Sh;                  ///< [R x P] aggregated Shapley effects, which add up to 1; or empty
  std::vector<double> Sh_ci_low;           ///< [R x P] lower ends
  std::vector<double> Sh_ci_high;          ///< [R x P] upper ends
  std::vector<SolveCounts> solves;         ///< [M]
  std::vector<Failure> failures;           ///< the first, in the order of poses and samples
  std::uint64_t failed_samples = 0;        ///< how many there are of them; other solves have no addresses
  std::optional<ConvergenceResult> convergence = std::nullopt;  ///< where the study has adaptive samples

  // Whether a quantity varies, 0 or 1; empty where all do.
  std::vector<std::uint8_t> varies;         ///< [R]
  std::vector<std::uint8_t> vector_varies;  ///< [V]

  std::size_t groups() const { return group_names.size(); }  ///< P
  SolveCounts total() const { return total_of(solves); }     ///< over all poses
};

/// What a study of Sobol' indices found, read back. Precondition: a result of that kind.
inline const SobolResult& sobol_of(const StoredResult& result) { return found_of<SobolResult>(result); }

/// Of each response of the headline its errors with first-order and total index over the workspace, then the signed
/// vectors, then the pairs of groups.
std::vector<Table> sobol_tables(const StoredResult& result, const TableOptions& options = {});

}  // namespace poesy
