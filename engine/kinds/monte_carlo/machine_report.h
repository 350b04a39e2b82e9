#pragma once

#include <span>
#include <string>
#include <vector>

#include "engine/report/html/parts.h"
#include "engine/report/tables.h"
#include "engine/result/result_file.h"

/// Tables and report of main effects, and of what a Monte Carlo study with draws per machine finds in addition.
/// Precondition of all functions except those on effects: monte_carlo_of(result).machines is set.
namespace poesy {

/// The largest error of quantiles of some responses: "quantiles to 0.12 % of std".
std::string quantile_error_text(std::span<const std::size_t> responses, std::span<const double> errors,
                                std::span<const double> deviations);

/// Tables of the machines' largest magnitudes and root mean squares, and of the poses at which machines are rejected.
std::vector<Table> machine_tables(const StoredResult& result);

/// The table of first-order indices.
Table effect_table(const StoredResult& result);

/// Adds the section on the effect of each error alone.
void add_effects_section(const StoredResult& result, std::span<const Table> tables, Page& page);

/// The share of machines that each pose rejects, for each limit, to colour the workspace. Empty without limits.
std::vector<Field> reject_fields(const StoredResult& result, const PoseFigures& figures);

}  // namespace poesy
