#pragma once

#include <limits>

namespace poesy {

inline constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();  ///< NaN, which marks a missing number.

}  // namespace poesy
