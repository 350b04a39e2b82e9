#pragma once

#include <span>
#include <vector>

#include "engine/kinds/sobol/panel.h"
#include "engine/kinds/sobol/result.h"
#include "engine/study/plan.h"

/// Finds the quantities of a panel (IndexPanel) that do not vary (stats/indices.h), so that they have no variance to
/// divide.
namespace poesy {

/// [rows] The standard deviation up to which each row of the panel varies only by rounding. A row (axis::PanelRow) is a
/// response, or a component of an additional output of the model (Detail in model/model.h). For such a component, this
/// is the largest of these standard deviations among the responses with the same unit; the smallest of all if no
/// response has this unit.
std::vector<double> row_rounding(const IndexPanel& panel, const Plan& plan, const Model& model);

/// [quantities] Whether each quantity varies over all poses together, 1 or 0. A vector varies if one of its components
/// does. rounding: see row_rounding().
std::vector<std::uint8_t> varying_quantities(const IndexPanel& panel, const PanelSums& sums,
                                             std::span<const double> rounding);

/// Sets all shares of quantities that do not vary to NaN: at each pose where they do not vary, and over the poses if
/// they vary at none. If some responses or vectors do not vary, records which. rounding: see row_rounding().
void leave_out_constant(const IndexPanel& panel, const PanelSums& sums, std::span<const double> rounding,
                        SobolResult& found);

}  // namespace poesy
