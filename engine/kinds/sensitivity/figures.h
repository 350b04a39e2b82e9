#pragma once

#include <cstddef>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "engine/kinds/sensitivity/result.h"
#include "engine/report/report_kind.h"

/// Figures that the page of one sensitivity result and that of two share.
namespace poesy {

/// How the solves ended, by error and pose.
SolveTally sensitivity_tally(const StoredResult& result);

/// What figures by pose show; curves along a trajectory show the same numbers as the map.
ShownCells sensitivity_cells(const StoredResult& result);

/// Indices in the units shown and the order of response_order(), row-major: as effects (index x sigma) or as indices.
std::vector<double> in_shown_units(const StoredResult& result, const SensitivityResult::Indices& indices,
                                   bool as_effect);

/// Their units, "mm" or "mm/deg": for each response one unit, or one for each error.
std::vector<std::vector<std::string>> units_of_indices(const StoredResult& result, bool as_effect);

/// A number of each error at each pose.
using ErrorCells = Array<double, axis::Factor, axis::Pose>;

/// Local indices x sigma of one response, SI.
ErrorCells local_effects(const StoredResult& result, std::size_t response);

/// Bars with these quantities of each error.
Bars error_bars(const StoredResult& result, std::vector<BarQuantity> quantities);
/// Shares in percent as a quantity of bars.
BarQuantity share_quantity(std::string label, const std::string& array, std::span<const double> values,
                           ArrayPool& pool);

/// A pose coordinate, or its magnitude, that orders poses.
struct PoseOrder {
  std::size_t coordinate;  ///< position among the pose coordinates
  bool magnitude;          ///< |coordinate|
  double correlation;      ///< rank correlation with the values it explains, from -1 to 1
  /// "gamma" or "|gamma|".
  std::string name(const StoredResult& result) const;
};

/// The magnitude of the rank correlation above which a number is said to grow or fall with a coordinate.
inline constexpr double kClearCorrelation = 0.8;

/// The root sum of squares over the errors at each pose.
std::vector<double> root_sum_squares(const ErrorCells& cells);

/// The coordinate, or its magnitude if it has both signs, whose rank correlation with `values` at the poses is largest
/// in magnitude. Of equal ones it is the first coordinate, and the coordinate rather than its magnitude. None if no
/// correlation is known.
std::optional<PoseOrder> explaining_order(const StoredResult& result, std::span<const double> values);

/// The name of the order in which a heat map of these cells first shows its columns: the one that explains their root
/// sums of squares. Empty if there is none, and on a trajectory, whose poses already have an order.
std::string first_order(const StoredResult& result, const ErrorCells& cells);

/// Compares the indices, and all errors together; by the published estimator if one of the results has no other.
Comparable comparable_sensitivity(const StoredResult& result, const StoredResult& other);

/// The root mean square of the response over samples and poses, predicted from each error alone.
std::vector<Merit> sensitivity_merits(const StoredResult& result, std::string_view response);

/// Adds the sections of two results: their rankings, what differs, and where in the workspace.
void compare_sensitivity(const ReportedResult& a, const ReportedResult& b, const Comparison& compared, Page& page);

}  // namespace poesy
