#pragma once

#include <limits>

namespace poesy {

/// Where there is no number.
inline constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();

}  // namespace poesy
