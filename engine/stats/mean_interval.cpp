#include "engine/stats/mean_interval.h"

#include <boost/math/distributions/students_t.hpp>
#include <cmath>
#include <limits>

#include "engine/base/contract.h"

namespace poesy {

Interval mean_interval(const Moments& moments, double conf_level) {
  POESY_EXPECTS(conf_level > 0.0 && conf_level < 1.0);
  constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();
  if (moments.count() < 2) return {kNaN, kNaN};
  const auto n = static_cast<double>(moments.count());
  const boost::math::students_t student(n - 1.0);
  const double t = boost::math::quantile(boost::math::complement(student, 0.5 * (1.0 - conf_level)));
  const double half = t * moments.standard_deviation() / std::sqrt(n);
  return {moments.mean() - half, moments.mean() + half};
}

}  // namespace poesy
