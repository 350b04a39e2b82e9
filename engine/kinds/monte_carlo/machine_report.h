#pragma once

#include <span>
#include <string>
#include <vector>

#include "engine/report/html/parts.h"
#include "engine/report/tables.h"
#include "engine/result/result_file.h"

/// How tables and reports show what the bins of errors say, and what a Monte Carlo study of machines found in addition.
/// Precondition of what follows but for effects: monte_carlo_of(result).machines is there.
namespace poesy {

/// How far quantiles of some responses may be off: "quantiles to 0.12 % of std", of the worst response.
std::string quantile_error_text(std::span<const std::size_t> responses, std::span<const double> errors,
                                std::span<const double> deviations);

/// Of each machine its largest magnitude and its root mean square; at which poses machines are rejected.
std::vector<Table> machine_tables(const StoredResult& result);

/// First-order indices.
Table effect_table(const StoredResult& result);

/// The section on what each error does alone.
void add_effects_section(const StoredResult& result, std::span<const Table> tables, Page& page);

/// For dots in the workspace: the share of machines that each pose rejects, for each limit. Empty without limits.
std::vector<Field> reject_fields(const StoredResult& result, const PoseFigures& figures);

}  // namespace poesy
