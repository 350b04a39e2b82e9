#pragma once

#include "engine/kinds/calibration/result.h"
#include "engine/report/table.h"

namespace poesy {

/// A table of the measured values that the fit explains least: where they were measured, the measured and the fitted
/// value, and the residual. The largest residual over its standard deviation comes first; outliers are marked.
Table residuals_table(const StoredResult& result);

}  // namespace poesy
