#pragma once

#include <span>
#include <string>
#include <vector>

#include "engine/report/html/parts.h"
#include "engine/report/tables.h"
#include "engine/result/result_file.h"

/// Tables and report sections of main effects, and of the additional results of a Monte Carlo study with draws per
/// machine. Precondition of all functions with a result, except effect_table() and add_effects_section():
/// monte_carlo_of(result).machines is set.
namespace poesy::monte_carlo {

/// A text on the accuracy of the quantiles of some responses: "quantiles to 0.12 % of std". errors, deviations: [all
/// responses] largest error of a quantile, and standard deviation.
std::string quantile_error_text(std::span<const std::size_t> responses, std::span<const double> errors,
                                std::span<const double> deviations);

/// Tables of the machines' largest magnitudes and root mean squares, and of the poses at which machines are rejected.
std::vector<Table> machine_tables(const StoredResult& result);

/// A table of the yields with and without calibration. Precondition: the machines are calibrated, and there are limits.
Table calibration_table(const StoredResult& result);

/// The table of first-order indices.
Table effect_table(const StoredResult& result);

/// Adds to the page the section on the first-order indices and main effects of the errors.
void add_effects_section(const StoredResult& result, std::span<const Table> tables, Page& page);

/// Layers of the workspace map: for each limit, the share of machines that are rejected at each pose. Empty without
/// limits.
std::vector<Field> reject_fields(const StoredResult& result, const PoseFigures& figures);

}  // namespace poesy::monte_carlo
