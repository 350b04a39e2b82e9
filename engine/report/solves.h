#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "engine/result/result_file.h"

/// How the solves of any result ended, and when a reader is warned of solves that did not converge.
namespace poesy {

/// The share of samples without a solution above which statistics of the others mislead (D8).
inline constexpr double kManyNotConverged = 0.01;

/// The share of samples without a solution above which a reader is warned. It is the share that the study allows
/// (solver.max_not_converged), or 0.1 % if that is 1, which means no limit.
constexpr double unremarkable_failure_share(double allowed) {
  constexpr double kDefault = 0.001;
  return allowed < 1.0 ? allowed : kDefault;
}

/// The share part / all; NaN if all is 0.
constexpr double share_of(std::uint64_t part, std::uint64_t all) {
  return static_cast<double>(part) / static_cast<double>(all);
}

/// Whether a reader is warned of the solves that did not converge: more than unremarkable_failure_share().
bool many_not_converged(const StoredResult& result, std::uint64_t failed, std::uint64_t solves);

/// Advice for machines that cannot be assembled, as a clause.
inline constexpr std::string_view kAssemblyAdvice =
    "more iterations do not help: keep a larger clearance to singular poses, or tighten the errors";

/// Whether most of the samples that were not solved have no solution.
bool mostly_impossible(const SolveCounts& solves);

/// The reason why samples were not solved, after their number: "did not converge", or "found no solution, 3 of them
/// because the machine cannot be assembled" (without a number if it is all of them).
std::string why_unsolved(const SolveCounts& solves);

/// The numbers of samples that were not solved: "12 not converged, 3 cannot be assembled"; the second only if there are
/// any.
std::string unsolved_in_short(const SolveCounts& solves);

/// The solves of a second fidelity with the same draws.
struct SecondFidelity {
  std::string first;                ///< name of the first fidelity
  std::string second;               ///< name of the second fidelity
  std::uint64_t not_converged = 0;  ///< its solves that did not converge
  std::uint64_t total = 0;          ///< all its solves
  std::size_t not_linear = 0;       ///< errors that are not linear
  std::size_t errors = 0;           ///< all errors
};

/// How solves ended, by row and pose. Rows are errors, cases or sizes; one row if they are not distinguished.
struct SolveTally {
  std::string_view row_word;                            ///< the word for a row: "error"; empty if there is one row
  std::vector<std::string> names;                       ///< names of the rows
  std::size_t poses = 0;                                ///< M; 1 if the result does not distinguish poses
  std::vector<SolveCounts> cells;                       ///< [rows x M]
  std::optional<SecondFidelity> second = std::nullopt;  ///< set if the result compares two fidelities

  SolveCounts total() const;                   ///< All solves; with two fidelities, those of the first.
  std::vector<double> shares() const;          ///< [rows x M] shares that did not converge; NaN without solves.
  std::vector<double> shares_by_row() const;   ///< [rows] shares that did not converge; NaN without solves.
  std::vector<double> shares_by_pose() const;  ///< [M] shares that did not converge; NaN without solves.
};

/// The share of solves that did not converge; NaN without solves.
inline double share_not_converged(const SolveCounts& solves) {
  return share_of(solves.not_converged(), solves.total());
}

/// The name of the first of two fidelities, " at fidelity \"full\""; empty if the result does not compare two.
std::string at_first_fidelity(const SolveTally& tally);

/// The number of solves that did not converge, why numbers cannot be trusted if these are more than kManyNotConverged,
/// and the rows and poses with the largest shares.
std::string unsolved_text(const StoredResult& result, const SolveTally& tally);

/// The number of solves that did not converge, of both fidelities if there are two. For a sampled result also the
/// address of the first failure, and the command that replays it. path: of the result. Wrapped at `width` by
/// prose_of(), except the command.
std::string failures_text(const StoredResult& result, const SolveTally& tally, const std::string& path,
                          std::size_t width);

}  // namespace poesy
