#pragma once

#include <cstddef>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "engine/kinds/sensitivity/result.h"
#include "engine/report/report_kind.h"

/// Figures for the page of one sensitivity result and for the page that compares two results.
namespace poesy::sensitivity {

/// How the solves ended, for each error and pose.
SolveTally sensitivity_tally(const StoredResult& result);

/// The responses and poses that the figures show. Each pose has one number per error and response, or two on a
/// trajectory: one in the heat map, and the same number again in a curve.
ShownCells sensitivity_cells(const StoredResult& result);

/// [responses x errors] Indices in display units, either as effects (index x sigma) or as they are, with the responses
/// in the order of response_order().
std::vector<double> in_shown_units(const StoredResult& result, const Result::Indices& indices, bool as_effect);

/// The display units of indices: for each response, one unit if indices are shown as effects ("mm"), otherwise a unit
/// for each error ("mm/deg").
std::vector<std::vector<std::string>> units_of_indices(const StoredResult& result, bool as_effect);

/// A number for each error at each pose.
using ErrorCells = Array<double, axis::Factor, axis::Pose>;

/// [errors x poses] The effects of all errors on one response at each pose: local index x sigma, SI, with rounding
/// removed (without_rounding()).
ErrorCells local_effects(const StoredResult& result, std::size_t response);

/// Bars that show these quantities for each error.
Bars error_bars(const StoredResult& result, std::vector<BarQuantity> quantities);
/// A quantity for bars that shows shares in percent. values: [errors] shares, where 1 is 100 %.
BarQuantity share_quantity(std::string label, const std::string& array, std::span<const double> values,
                           ArrayPool& pool);

/// A pose coordinate, or its magnitude, by which poses can be ordered.
struct PoseOrder {
  std::size_t coordinate;  ///< position among the pose coordinates
  bool magnitude;          ///< whether the order is by |coordinate|
  double correlation;      ///< rank correlation of the coordinate with some values at the poses, from -1 to 1
  /// The name of the order: "gamma" or "|gamma|".
  std::string name(const StoredResult& result) const;
};

/// Values are said to grow or fall with a coordinate if their rank correlation with it has a larger magnitude than
/// this.
inline constexpr double kClearCorrelation = 0.8;

/// [poses] The root sum of squares of the numbers of all errors at each pose.
std::vector<double> root_sum_squares(const ErrorCells& cells);

/// The order of the poses whose rank correlation with `values` [poses] is largest in magnitude: by a coordinate, or by
/// the magnitude of a coordinate that has both signs. If several correlations are equal, the first coordinate is taken,
/// and a coordinate rather than its magnitude. None if no correlation is known.
std::optional<PoseOrder> explaining_order(const StoredResult& result, std::span<const double> values);

/// The name of the order in which a heat map of these cells first shows its poses: the order that correlates best with
/// the root sum of squares over the errors. Empty if no correlation is known, or on a trajectory, whose poses are
/// ordered by time.
std::string first_order(const StoredResult& result, const ErrorCells& cells);

/// The quantities in which two sensitivity results are compared: effects, indices, and the root mean square of all
/// errors together.
Comparable comparable_sensitivity(const StoredResult& result, const StoredResult& other);

/// The figure of merit by which two results are compared: the root mean square of the response over samples and poses,
/// predicted from the effects of single errors.
std::vector<Merit> sensitivity_merits(const StoredResult& result, std::string_view response);

/// Adds to the page the sections that compare two results: rankings, differences, and where in the workspace they
/// differ.
void compare_sensitivity(const ReportedResult& a, const ReportedResult& b, const Comparison& compared, Page& page);

}  // namespace poesy::sensitivity
