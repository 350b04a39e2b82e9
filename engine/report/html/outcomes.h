#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "engine/report/html/page.h"
#include "engine/report/html/report.h"
#include "engine/run/result.h"

namespace poesy {

/// How the solves of a result of any kind ended, as far as it says where: in rows (errors, cases, sizes; one where
/// there is nothing to tell apart) and at poses.
struct SolveTally {
  std::string_view row_word;       ///< what a row is: "error"
  std::vector<std::string> names;  ///< of the rows
  std::size_t poses = 0;           ///< M; 1 where it does not say at which poses
  std::vector<SolveCounts> cells;  ///< [rows x M]

  /// Of the solves, NaN where there is none.
  std::vector<double> shares() const;          ///< [rows x M]
  std::vector<double> shares_by_row() const;   ///< [rows]
  std::vector<double> shares_by_pose() const;  ///< [M]
};

/// Of all solves of the result.
SolveTally tally_of(const StoredResult& result);

/// How solves at the second of two fidelities ended (run/fidelity.h).
struct SecondFidelity {
  std::uint64_t not_converged = 0;  ///< of its solves
  std::uint64_t total = 0;          ///< its solves: the same draws as the first's
};

/// None where the result does not compare two.
std::optional<SecondFidelity> second_fidelity(const StoredResult& result);

/// " at fidelity \"full\"", the first of two; empty where the result does not compare two.
std::string at_first_fidelity(const StoredResult& result);

/// " The largest shares: ..." of solves that did not converge, of the rows and of the poses; empty where there is
/// nothing to tell apart.
std::string worst_text(const StoredResult& result, const SolveTally& outcomes);

/// Why numbers cannot be trusted where more than kManyNotConverged of the solves did not converge; empty below.
std::string doubt_text(double share);

/// The section that tells what was not solved: how solves ended, which rows and poses have how many that did not
/// converge, and the listed failures with the commands that replay them.
void add_outcomes(const ReportedResult& result, Page& page);

}  // namespace poesy
