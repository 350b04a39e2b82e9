#include "engine/stats/mean_interval.h"

#include <boost/math/distributions/students_t.hpp>
#include <cmath>

#include "engine/base/contract.h"
#include "engine/base/nan.h"

namespace poesy {
namespace {

/// What a standard error is multiplied by on either side.
double student_quantile(double freedom, double conf_level) {
  POESY_EXPECTS(conf_level > 0.0 && conf_level < 1.0);
  const boost::math::students_t student(freedom);
  return boost::math::quantile(boost::math::complement(student, 0.5 * (1.0 - conf_level)));
}

}  // namespace

Interval mean_interval(const Moments& moments, double conf_level) {
  if (moments.count() < 2) return {kNaN, kNaN};
  const auto n = static_cast<double>(moments.count());
  const double half = student_quantile(n - 1.0, conf_level) * moments.standard_deviation() / std::sqrt(n);
  return {moments.mean() - half, moments.mean() + half};
}

Estimate stratified_mean(const Groups& groups, double conf_level) {
  double total = 0.0;
  double sum = 0.0;
  double squares = 0.0;   // sum of n s^2
  double quartics = 0.0;  // sum of (n s^2)^2 / (n - 1)
  for (std::size_t m = 0; m < groups.count.size(); ++m) {
    if (groups.count[m] == 0) continue;
    const auto n = static_cast<double>(groups.count[m]);
    const double within = n * groups.std[m] * groups.std[m];
    total += n;
    sum += n * groups.mean[m];
    squares += within;
    quartics += within * within / (n - 1.0);
  }
  if (total == 0.0) return {kNaN, {kNaN, kNaN}};
  const double mean = sum / total;
  if (squares == 0.0) return {mean, {mean, mean}};
  if (!std::isfinite(quartics)) return {mean, {kNaN, kNaN}};
  const double half = student_quantile(squares * squares / quartics, conf_level) * std::sqrt(squares) / total;
  return {mean, {mean - half, mean + half}};
}

}  // namespace poesy
