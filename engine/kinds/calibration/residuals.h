#pragma once

#include "engine/kinds/calibration/result.h"
#include "engine/report/table.h"

namespace poesy::calibration {

/// A table of the measured values that the fit explains least, with the pose, the measured value, the fitted value and
/// the residual. Values are ordered by the residual over its standard deviation, or by the residual if the noise is 0,
/// largest first. Outliers are marked.
Table residuals_table(const StoredResult& result);

}  // namespace poesy::calibration
