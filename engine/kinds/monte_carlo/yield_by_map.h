#pragma once

#include <cstdint>
#include <optional>
#include <span>

#include "engine/kinds/monte_carlo/machine_table.h"
#include "engine/kinds/monte_carlo/result.h"
#include "engine/stats/linear_fit.h"

namespace poesy {

/// Sets what the linear map of the limited vectors says about the yield. The map is fitted to the study's first
/// machines (fit; it may be none):
/// - the shares of the mean square of each limited response, for all errors; NaN without a fit;
/// - the gradient and the change by errors whose score is a polynomial, by MappedGradient instead of the present
/// numbers, if the map judges few machines wrongly. rejected: [first machines] 1 or 0; their errors are drawn again.
void set_first_order(const MachineTable& table, const std::optional<LinearFit>& fit,
                     std::span<const std::uint8_t> rejected, double conf_level, YieldResult& yield);

}  // namespace poesy
