#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "engine/result/result_file.h"

/// How the solves of a result of any kind ended, and when a reader is warned of those that did not converge.
namespace poesy {

/// Share of samples without a solution above which statistics of the others mislead (D8).
inline constexpr double kManyNotConverged = 0.01;

/// Share of samples without a solution above which a reader is warned of them: the share that the study allows
/// (solver.max_not_converged), or 0.1 % where it sets no limit, which is 1.
constexpr double unremarkable_failure_share(double allowed) {
  constexpr double kDefault = 0.001;
  return allowed < 1.0 ? allowed : kDefault;
}

/// NaN for none of none.
constexpr double share_of(std::uint64_t part, std::uint64_t all) {
  return static_cast<double>(part) / static_cast<double>(all);
}

/// Whether so many solves of a result did not converge that a reader is warned: more than unremarkable_failure_share.
bool many_not_converged(const StoredResult& result, std::uint64_t failed, std::uint64_t solves);

/// What a designer can do about machines that cannot be assembled: a clause.
inline constexpr std::string_view kAssemblyAdvice =
    "more iterations do not help: keep a larger clearance to singular poses, or tighten the errors";

/// Whether most of the samples that are not solved have no solution.
bool mostly_impossible(const SolveCounts& solves);

/// Why samples are not solved, after their number: "did not converge", or "found no solution, 3 of them because the
/// machine cannot be assembled", without a number where it is all of them.
std::string why_unsolved(const SolveCounts& solves);

/// "12 not converged, 3 cannot be assembled"; the second only where there are any.
std::string unsolved_in_short(const SolveCounts& solves);

/// What the second of two fidelities made of the same draws as the first.
struct SecondFidelity {
  std::string first;                ///< the name of the first
  std::string second;               ///< its own name
  std::uint64_t not_converged = 0;  ///< of its solves
  std::uint64_t total = 0;          ///< its solves
  std::size_t not_linear = 0;       ///< errors that are not
  std::size_t errors = 0;           ///< all errors
};

/// How solves ended in rows (errors, cases, sizes; one row where there is nothing to tell apart) and at poses.
struct SolveTally {
  std::string_view row_word;                            ///< what a row is: "error"; empty where there is one row
  std::vector<std::string> names;                       ///< of the rows
  std::size_t poses = 0;                                ///< M; 1 where the result does not say at which poses
  std::vector<SolveCounts> cells;                       ///< [rows x M]
  std::optional<SecondFidelity> second = std::nullopt;  ///< where the result compares two fidelities

  SolveCounts total() const;                   ///< All solves, those of the first fidelity where there are two.
  std::vector<double> shares() const;          ///< [rows x M] that did not converge; NaN where there is no solve
  std::vector<double> shares_by_row() const;   ///< [rows] likewise
  std::vector<double> shares_by_pose() const;  ///< [M] likewise
};

/// The share of solves that did not converge; NaN where there is none.
inline double share_not_converged(const SolveCounts& solves) {
  return share_of(solves.not_converged(), solves.total());
}

/// " at fidelity \"full\"", the first of two; empty where the result does not compare two.
std::string at_first_fidelity(const SolveTally& tally);

/// How many solves did not converge, why numbers cannot be trusted where they are more than kManyNotConverged, and the
/// rows and poses with the largest shares.
std::string unsolved_text(const StoredResult& result, const SolveTally& tally);

/// How many solves did not converge, at both fidelities where there are two; of a sampled result also the first one's
/// address, and how to replay it. path: of the result. Broken at `width` as by prose_of, but for the command to replay
/// it.
std::string failures_text(const StoredResult& result, const SolveTally& tally, const std::string& path,
                          std::size_t width);

}  // namespace poesy
