#pragma once

#include <span>
#include <string>
#include <vector>

#include "engine/report/html/parts.h"

namespace poesy {

/// By what a kind of study puts its errors in order, and how bad its poses are, for the picture of the mechanism.
struct ErrorShares {
  std::string what = {};            ///< "share of the mean square of gap"; empty: there are no shares
  std::vector<double> values = {};  ///< [P] of the result's errors; NaN or below 0 counts as 0
  /// What of several errors is shared evenly among them because they are ranked together, "group" or "part"; empty:
  /// each error is ranked.
  std::string joined = {};
  std::string pose_what = {};         ///< what at_poses is: "the effect of all errors on gap"; empty: it is not known
  std::vector<double> at_poses = {};  ///< [M]
};

/// Of things that are ranked together, the share of each error, [P]: each thing's share divided evenly among its
/// members. members: names of errors with blanks between.
std::vector<double> divided_shares(const StoredResult& result, const std::vector<std::string>& members,
                                   std::span<const double> shares);

/// Adds the mechanism at home and at the poses that matter to a section, limbs and joints coloured by the shares of the
/// errors there, and tables that say where each error is. Adds nothing where the mechanism cannot be built again or has
/// no picture.
void add_robot(const ReportedResult& reported, const ErrorShares& shares, Page& page, Section& section);

}  // namespace poesy
