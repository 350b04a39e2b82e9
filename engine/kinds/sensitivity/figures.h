#pragma once

#include <cstddef>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "engine/kinds/sensitivity/result.h"
#include "engine/report/report_kind.h"

/// What the page of a sensitivity result and that of two share.
namespace poesy {

/// How the solves ended, by error and pose.
SolveTally sensitivity_tally(const StoredResult& result);

/// What figures by pose show; on a trajectory curves show the same numbers as the map.
ShownCells sensitivity_cells(const StoredResult& result);

/// Indices in the units shown and the order of response_order, row-major: as effects, index x sigma, or as they are.
std::vector<double> in_shown_units(const StoredResult& result, const SensitivityResult::Indices& indices,
                                   bool as_effect);

/// Their units, "mm" or "mm/deg": for each response one, or one of each error.
std::vector<std::vector<std::string>> units_of_indices(const StoredResult& result, bool as_effect);

/// A number of each error at each pose.
using ErrorCells = Array<double, axis::Factor, axis::Pose>;

/// Local indices x sigma of one response, SI.
ErrorCells local_effects(const StoredResult& result, std::size_t response);

/// Bars with these quantities of each error.
Bars error_bars(const StoredResult& result, std::vector<BarQuantity> quantities);
/// Shares as one of them, in percent.
BarQuantity share_quantity(std::string label, const std::string& array, std::span<const double> values,
                           ArrayPool& pool);

/// A pose coordinate, or its magnitude, by which poses may be put in order.
struct PoseOrder {
  std::size_t coordinate;  ///< position among the pose coordinates
  bool magnitude;          ///< |coordinate|
  double correlation;      ///< rank correlation of what it explains with it, from -1 to 1
  /// "gamma" or "|gamma|".
  std::string name(const StoredResult& result) const;
};

/// Above this rank correlation, of either sign, a number is said to grow or fall with a coordinate.
inline constexpr double kClearCorrelation = 0.8;

/// The root sum square over the errors at each pose.
std::vector<double> root_sum_squares(const ErrorCells& cells);

/// The coordinate, or magnitude of one that has both signs, whose rank correlation with `values` of the poses is the
/// largest in magnitude; of equal ones the first coordinate, and the coordinate before its magnitude. None where no
/// correlation is known.
std::optional<PoseOrder> explaining_order(const StoredResult& result, std::span<const double> values);

/// How the columns of a heat map of these cells are ordered at first: the name of the order that explains
/// their root sum squares; empty, as they come, where there is none, and on a trajectory, whose poses have an order
/// already.
std::string first_order(const StoredResult& result, const ErrorCells& cells);

/// The indices, and all errors together; by the published estimator where one of both has no other.
Comparable comparable_sensitivity(const StoredResult& result, const StoredResult& other);

/// The sections of two results: their rankings, what differs, and where in the workspace.
void compare_sensitivity(const ReportedResult& a, const ReportedResult& b, const Comparison& compared, Page& page);

}  // namespace poesy
