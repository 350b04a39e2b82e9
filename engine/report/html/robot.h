#pragma once

#include <optional>
#include <span>
#include <string>
#include <vector>

#include "engine/model/sketch.h"
#include "engine/report/html/parts.h"

namespace poesy {

/// Shares of the errors, which colour the picture of the mechanism, and a quantity that decides at which poses the
/// picture shows the mechanism.
struct ErrorShares {
  std::string what = {};  ///< words for the shares: "share of the mean square of gap"; empty: there are no shares
  std::vector<double> values = {};  ///< [errors of the result] share of each error; NaN or below 0 counts as 0
  /// The word for errors that are ranked together, "group" or "part". The share of such a group is divided equally
  /// among its errors. Empty: each error is ranked alone.
  std::string joined = {};
  /// Words for the quantity `at_poses`: "the effect of all errors on gap"; empty: there are no such values.
  std::string pose_what = {};
  std::vector<double> at_poses = {};  ///< [poses of the result] quantity by which poses are chosen
};

/// The share of each of the result's errors if errors are ranked in groups: the share of a group is divided equally
/// among its errors. members: for each group the names of its errors, separated by blanks. shares: the shares of the
/// groups.
std::vector<double> divided_shares(const StoredResult& result, const std::vector<std::string>& members,
                                   std::span<const double> shares);

/// Returns true if pictures can be made: the model is known, and it has as many pose coordinates as the result. A
/// damaged result file may have any number of coordinates.
bool has_pictures(const ReportedResult& reported);

/// The sketch of the mechanism at a pose; an empty pose means home. None if the model has no picture, or if the
/// mechanism cannot reach the pose, which may happen because a result file may have any poses.
std::optional<Sketch> sketch_at(const Model& model, std::span<const double> pose);

/// The title of a picture: "Pose 4 (z -195 mm): WHY".
std::string pose_title(const StoredResult& result, std::size_t pose, const std::string& why);

/// The legend of the colours as HTML. what: words for the quantity that the colours show. least, largest: labels of the
/// two ends.
std::string colour_legend(const std::string& what, const std::string& least, const std::string& largest);

/// Adds to a section pictures of the mechanism at home and at extreme poses (largest or smallest effect or coordinate,
/// largest condition number), and tables with the place of each error. Limbs and joints are coloured by the shares of
/// their errors. Nothing is added if the mechanism cannot be built again or has no picture.
void add_robot(const ReportedResult& reported, const ErrorShares& shares, Page& page, Section& section);

}  // namespace poesy
