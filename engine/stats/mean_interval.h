#pragma once

#include "engine/stats/interval.h"
#include "engine/stats/moments.h"

namespace poesy {

/// Student's interval for a mean: mean +- t(n - 1) s / sqrt(n). NaN at both ends below two samples.
/// Precondition: 0 < conf_level < 1.
Interval mean_interval(const Moments& moments, double conf_level);

}  // namespace poesy
