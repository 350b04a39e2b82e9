#pragma once

#include <span>

#include "engine/report/html/page.h"
#include "engine/report/table.h"
#include "engine/result/result_file.h"

namespace poesy {

/// Adds to a report the sections of a calibration that have figures: the residuals at the places where they were
/// measured, the correlations of the estimates, and the remaining displacement at the poses of the study. tables: the
/// result's tables.
void add_calibration_figures(const StoredResult& result, std::span<const Table> tables, Page& page);

}  // namespace poesy
