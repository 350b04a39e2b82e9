#pragma once

#include <optional>
#include <span>
#include <string>
#include <vector>

#include "engine/model/sketch.h"
#include "engine/report/html/parts.h"

namespace poesy {

/// Shares of the errors, which colour the picture of the mechanism, and a measure by which its poses are chosen.
struct ErrorShares {
  std::string what = {};  ///< words for the shares: "share of the mean square of gap"; empty: there are no shares
  std::vector<double> values = {};  ///< [P] share of each of the result's errors; NaN or below 0 counts as 0
  /// The word for errors that are ranked together, "group" or "part", which divide their share evenly; empty: each
  /// error is ranked alone.
  std::string joined = {};
  /// Words for at_poses: "the effect of all errors on gap"; empty: there are no such values.
  std::string pose_what = {};
  std::vector<double> at_poses = {};  ///< [M] measure by which poses for the picture are chosen
};

/// [P] The share of each error if errors are ranked in groups: the share of a group is divided evenly among its
/// members. members: for each group the names of its errors, separated by blanks. shares: the shares of the groups.
std::vector<double> divided_shares(const StoredResult& result, const std::vector<std::string>& members,
                                   std::span<const double> shares);

/// Returns true if pictures can be made: the model is known and has as many pose coordinates as the result. That is
/// checked because a result file may state any number of coordinates.
bool has_pictures(const ReportedResult& reported);

/// The sketch of the mechanism at a pose. None if the model has no picture, or if it cannot reach the pose: a result
/// file may name such a pose.
std::optional<Sketch> sketch_at(const Model& model, std::span<const double> pose);

/// The title of a picture: "Pose 4 (z -195 mm): why".
std::string pose_title(const StoredResult& result, std::size_t pose, const std::string& why);

/// The legend of the colours as HTML. what: words for what the colours show; least, largest: labels of the two ends.
std::string colour_legend(const std::string& what, const std::string& least, const std::string& largest);

/// Adds pictures of the mechanism at home and at its most interesting poses to a section, and tables with the place of
/// each error. The shares of their errors colour limbs and joints. Adds nothing if the mechanism cannot be built again
/// or has no picture.
void add_robot(const ReportedResult& reported, const ErrorShares& shares, Page& page, Section& section);

}  // namespace poesy
