#pragma once

#include <span>
#include <vector>

#include "engine/kinds/sobol/panel.h"
#include "engine/kinds/sobol/result.h"
#include "engine/study/plan.h"

/// Finds the quantities of a panel (IndexPanel) that do not vary (stats/indices.h) and so have no variance to divide.
namespace poesy::sobol {

/// [rows] For each row of the panel, the largest standard deviation (SI) that rounding alone may cause. A row
/// (axis::PanelRow) is a response, or a component of an additional output of the model (Detail in model/model.h). A
/// component gets the largest value of the responses with its dimension, or the smallest value of all responses if none
/// has this dimension.
std::vector<double> row_rounding(const IndexPanel& panel, const Plan& plan, const Model& model);

/// [quantities] Whether each quantity varies over all poses together, 1 or 0. A vector varies if one of its components
/// does. rounding: see row_rounding().
std::vector<std::uint8_t> varying_quantities(const IndexPanel& panel, const PanelSums& sums,
                                             std::span<const double> rounding);

/// Sets shares of variances that are only rounding to NaN: the shares at each pose where a response does not vary, and
/// the shares over all poses of a response or vector that varies at no pose. Records which responses and vectors vary,
/// unless all do. rounding: see row_rounding().
void leave_out_constant(const IndexPanel& panel, const PanelSums& sums, std::span<const double> rounding,
                        Result& found);

}  // namespace poesy::sobol
