#pragma once

#include <cstdint>
#include <optional>
#include <span>

#include "engine/kinds/monte_carlo/machine_table.h"
#include "engine/kinds/monte_carlo/result.h"
#include "engine/stats/linear_fit.h"

namespace poesy::monte_carlo {

/// Sets the numbers of the yield that follow from the linear map from the errors to the limited vectors
/// (LimitedVector). fit: the map, fitted to the first machines of the study; none if it could not be fitted. The
/// numbers are
/// - the shares of all errors in the scatter of each limited response, its linear share and its offset; NaN without a
/// fit;
/// - the gradient and the change of the yield by errors with a PolynomialScore (uniform, triangular and measured
/// errors). These replace the present numbers if the map judges only few machines wrongly.
/// rejected: [first machines] 1 if rejected, otherwise 0; the function draws the errors of these machines again. If it
/// is empty, gradient and change stay as they are.
void set_first_order(const MachineTable& table, const std::optional<LinearFit>& fit,
                     std::span<const std::uint8_t> rejected, double conf_level, YieldResult& yield);

}  // namespace poesy::monte_carlo
