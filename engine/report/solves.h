#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "engine/result/result_file.h"

/// How the solves of a result ended, and when a reader is warned of solves that did not converge.
namespace poesy {

/// The share of samples without a solution above which statistics over the solved samples mislead
/// (engine/docs/decisions/0008-which-samples-count.md).
inline constexpr double kManyNotConverged = 0.01;

/// The share of samples without a solution above which a reader is warned: `allowed`, the share that the study allows
/// (solver.max_not_converged), or 0.1 % if `allowed` is 1, which means that there is no limit.
constexpr double unremarkable_failure_share(double allowed) {
  constexpr double kDefault = 0.001;
  return allowed < 1.0 ? allowed : kDefault;
}

/// The quotient part / all; NaN if both are 0.
constexpr double share_of(std::uint64_t part, std::uint64_t all) {
  return static_cast<double>(part) / static_cast<double>(all);
}

/// Returns true if the share of solves that did not converge is above unremarkable_failure_share(), so that a reader is
/// warned. failed: number of solves that did not converge. solves: number of all solves.
bool many_not_converged(const StoredResult& result, std::uint64_t failed, std::uint64_t solves);

/// Advice if machines cannot be assembled, as a clause.
inline constexpr std::string_view kAssemblyAdvice =
    "more iterations do not help: keep a larger clearance to singular poses, or tighten the errors";

/// Returns true if more than half of the unsolved samples are machines that cannot be assembled.
bool mostly_impossible(const SolveCounts& solves);

/// The reason why samples were not solved, as words that follow the number of these samples: "did not converge", or
/// "found no solution, 3 of them because the machine cannot be assembled". "3 of them" is left out if this is the
/// reason for all of them.
std::string why_unsolved(const SolveCounts& solves);

/// The numbers of unsolved samples by reason: "12 not converged, 3 cannot be assembled". The second number is left out
/// if it is 0.
std::string unsolved_in_short(const SolveCounts& solves);

/// The solves at the second fidelity of a study that compares two fidelities. They have the same draws as the solves at
/// the first fidelity.
struct SecondFidelity {
  std::string first;                ///< name of the first fidelity
  std::string second;               ///< name of the second fidelity
  std::uint64_t not_converged = 0;  ///< solves of the second fidelity that did not converge
  std::uint64_t total = 0;          ///< all solves of the second fidelity
  std::size_t not_linear = 0;       ///< errors whose effect on a response is not linear
  std::size_t errors = 0;           ///< number of all errors
};

/// A number of samples as text: "2 000 solves", or "2 000 samples" if the responses of some samples were computed from
/// certified series instead of solves (engine/run/series_model.h). by_series: number of these samples.
std::string counted_samples(std::uint64_t count, std::uint64_t by_series);

/// Counts of how solves ended, by row and pose. A row is an error, a case, a size of the errors, or a design of a
/// sweep. If the result distinguishes none of these, there is only one row.
struct SolveTally {
  std::string_view row_word;                            ///< the word for a row: "error"; empty if there is only one row
  std::vector<std::string> names;                       ///< names of the rows
  std::size_t poses = 0;                                ///< number of poses; 1 if the result does not distinguish poses
  std::vector<SolveCounts> cells;                       ///< [rows x poses] counts for each row and pose
  std::optional<SecondFidelity> second = std::nullopt;  ///< set if the result compares two fidelities

  SolveCounts total() const;                   ///< The counts over all rows and poses, at the first fidelity.
  std::size_t cells_by_series() const;         ///< The number of `cells` with samples from certified series.
  std::vector<double> shares() const;          ///< [rows x poses] share_not_converged() of each cell.
  std::vector<double> shares_by_row() const;   ///< [rows] share_not_converged() over all poses.
  std::vector<double> shares_by_pose() const;  ///< [poses] share_not_converged() over all rows.
};

/// The share of solves that did not converge; NaN without solves.
inline double share_not_converged(const SolveCounts& solves) {
  return share_of(solves.not_converged(), solves.total());
}

/// Words that name the first of two fidelities: " at fidelity \"full\"". Empty if the result compares no fidelities.
std::string at_first_fidelity(const SolveTally& tally);

/// Sentences on the solves that did not converge: their number, why statistics cannot be trusted if their share is
/// above kManyNotConverged, and the rows and poses with the largest shares.
std::string unsolved_text(const StoredResult& result, const SolveTally& tally);

/// Lines on the number of solves that did not converge, for both fidelities if the result compares two. For a result
/// that lists failures, also the error, pose and sample of the first failure, and the command that replays it. path:
/// path of the result. All lines but the command are wrapped at `width` by prose_of(). Empty if the result does not
/// count how its solves ended.
std::string failures_text(const StoredResult& result, const SolveTally& tally, const std::string& path,
                          std::size_t width);

}  // namespace poesy
