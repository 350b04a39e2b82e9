#pragma once

#include "engine/report/html/page.h"
#include "engine/report/html/report.h"

/// The sections of each kind of result: what was found, where, and how sure it is. Each takes the tables that belong to
/// it and adds its figures to the page.
namespace poesy {

/// What a result of this kind found.
/// @{
void add_sensitivity(const StoredResult& result, Page& page);
void add_monte_carlo(const StoredResult& result, Page& page);
void add_identification(const StoredResult& result, Page& page);
void add_coupling(const StoredResult& result, Page& page);
/// @}
/// Cases, or rows of errors that somebody else sampled.
void add_evaluation(const StoredResult& result, Page& page);

/// "How tight must each be", "What calibration can remove" and "Is first order enough", of a sensitivity result that
/// says so. tables: those of the result; these sections take theirs out.
void add_tolerances(const StoredResult& result, Page& page);
/// What a sensitivity result says besides, where it does; its tables are taken out of those given.
/// @{
void add_separation(const StoredResult& result, std::vector<Table>& tables, Page& page);
void add_fidelity(const StoredResult& result, std::vector<Table>& tables, Page& page);
/// @}

/// What became of the study's limits, where it states any; its table is taken out of those given.
void add_limits(std::vector<Table>& tables, Page& page);

/// How the indices or means of a sampled result settled with the number of samples.
void add_certainty(const StoredResult& result, std::vector<Table>& tables, Page& page);

}  // namespace poesy
