#pragma once

#include <vector>

#include "engine/files/file_kind.h"
#include "engine/files/result_file.h"
#include "engine/kinds/monte_carlo/result.h"
#include "engine/report/report_kind.h"
#include "engine/report/tables.h"
#include "engine/run/result.h"

/// What a file keeps of a Monte Carlo study.
namespace poesy {

/// What a Monte Carlo study found, read back: its failures, convergence and verdicts are those of StoredResult.
/// Precondition: a Monte Carlo result.
inline const MonteCarloResult& monte_carlo_of(const StoredResult& result) { return found_of<MonteCarloResult>(result); }

/// Per response mean, spread, extremes and quantiles over the samples of all poses
/// together; then the mean of the poses' means, and the largest mean and highest quantile with the pose where it is.
std::vector<Table> monte_carlo_tables(const StoredResult& result, const TableOptions& options = {});

/// How files keep what such a study found, and how reports show it.
/// @{
extern const FileKind kMonteCarloFile;
extern const ReportKind kMonteCarloReport;
/// @}

}  // namespace poesy
