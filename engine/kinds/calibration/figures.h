#pragma once

#include <span>

#include "engine/report/html/page.h"
#include "engine/report/table.h"
#include "engine/result/result_file.h"

namespace poesy::calibration {

/// Adds the sections with figures to the report of a calibration: the residuals at the measured poses, the correlations
/// of the estimates, and the remaining displacement at the poses of the study. tables: the result's tables.
void add_calibration_figures(const StoredResult& result, std::span<const Table> tables, Page& page);

}  // namespace poesy::calibration
