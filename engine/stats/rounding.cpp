#include "engine/stats/rounding.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace poesy {

double index_rounding(double response_rounding, double sigma) {
  return std::max(kIndexRounding, response_rounding / sigma);
}

double size_rounding(double linear, double angular) {
  return kIndexRounding * std::fmax(linear, angular);  // passes over NaN
}

bool has_effect(double index, double rounding) { return index >= rounding; }

bool is_too_small_to_tell(double index, double rounding) {
  return rounding > kIndexOfInterest && !has_effect(index, rounding);
}

double told_from_rounding(double index, double rounding) {
  if (std::isnan(index) || has_effect(index, rounding)) return index;
  return is_too_small_to_tell(index, rounding) ? std::numeric_limits<double>::quiet_NaN() : 0.0;
}

}  // namespace poesy
