#pragma once

#include <span>
#include <vector>

#include "engine/kinds/sobol/panel.h"
#include "engine/kinds/sobol/result.h"
#include "engine/study/plan.h"

/// Finds the quantities of a panel that do not vary (stats/indices.h) and so have no variance to divide.
namespace poesy {

/// [rows] The standard deviation up to which each row of a panel is rounding. A component of a detail has the rounding
/// of the responses of its unit.
std::vector<double> row_rounding(const IndexPanel& panel, const Plan& plan, const Model& model);

/// Whether each quantity varies over all poses together, 0 or 1. A vector varies if one of its components does.
/// rounding: see row_rounding().
std::vector<std::uint8_t> varying_quantities(const IndexPanel& panel, const PanelSums& sums,
                                             std::span<const double> rounding);

/// Sets all shares of quantities that do not vary to NaN, at a pose or over the poses. Records which responses and
/// vectors do not vary, if there are some. rounding: see row_rounding().
void leave_out_constant(const IndexPanel& panel, const PanelSums& sums, std::span<const double> rounding,
                        SobolResult& found);

}  // namespace poesy
