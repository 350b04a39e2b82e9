#pragma once

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

SolveTally tally_of(const StoredResult& result);

/// The section that tells what was not solved: how solves ended, which rows and poses have how many that did not
/// converge, and the listed failures with the commands that replay them.
void add_outcomes(const ReportedResult& result, Page& page);

}  // namespace poesy
