#pragma once

#include <span>
#include <string>
#include <vector>

#include "engine/report/html/parts.h"

namespace poesy {

/// Shares of the errors, and a measure of the poses, for the picture of the mechanism.
struct ErrorShares {
  std::string what = {};            ///< "share of the mean square of gap"; empty: there are no shares
  std::vector<double> values = {};  ///< [P] shares of the result's errors; NaN or below 0 counts as 0
  /// The word for errors that are ranked together, "group" or "part", whose share is divided evenly; empty: each error
  /// is ranked alone.
  std::string joined = {};
  std::string pose_what = {};  ///< description of at_poses: "the effect of all errors on gap"; empty: there is none
  std::vector<double> at_poses = {};  ///< [M]
};

/// [P] The share of each error if errors are ranked together: each share is divided evenly among its members. members:
/// names of errors, separated by blanks.
std::vector<double> divided_shares(const StoredResult& result, const std::vector<std::string>& members,
                                   std::span<const double> shares);

/// Adds pictures of the mechanism at home and at the most interesting poses to a section, with limbs and joints
/// coloured by the shares of their errors, and tables with the place of each error. Adds nothing if the mechanism
/// cannot be built again or has no picture.
void add_robot(const ReportedResult& reported, const ErrorShares& shares, Page& page, Section& section);

}  // namespace poesy
