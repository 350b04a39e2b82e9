#pragma once

#include <span>
#include <vector>

#include "engine/kinds/sobol/panel.h"
#include "engine/kinds/sobol/result.h"
#include "engine/study/plan.h"

/// Which quantities of a panel do not vary (stats/indices.h), so that they have no variance to be shared.
namespace poesy {

/// Up to which standard deviation each row of a panel is rounding. A component of a detail rounds as the responses of
/// its unit do.
std::vector<double> row_rounding(const IndexPanel& panel, const Plan& plan, const Model& model);

/// Of each quantity whether it varies over the poses together, 0 or 1: a vector does if one of its components does.
/// rounding: of each row.
std::vector<std::uint8_t> varying_quantities(const IndexPanel& panel, const PanelSums& sums,
                                             std::span<const double> rounding);

/// Makes NaN of all shares of what does not vary: at a pose, or over the poses. Says which responses and vectors do
/// not, where there are such. rounding: of each row.
void leave_out_constant(const IndexPanel& panel, const PanelSums& sums, std::span<const double> rounding,
                        SobolResult& found);

}  // namespace poesy
