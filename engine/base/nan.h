#pragma once

#include <limits>

namespace poesy {

inline constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();  ///< Where there is no number.

}  // namespace poesy
