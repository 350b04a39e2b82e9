#include "engine/stats/told_together.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <functional>
#include <limits>

#include "engine/base/contract.h"

namespace poesy {
namespace {

bool is_tested(const Estimate& estimate) {
  return !std::isnan(estimate.interval.low) && !std::isnan(estimate.interval.high);
}

/// The factor by which Student's quantile may grow before the interval of the estimate includes zero; see
/// told_together().
double reach(const Estimate& estimate, const Interval& bounds) {
  const auto [value, interval] = estimate;
  double below = value - interval.low;
  double above = interval.high - value;
  const double facing = value > 0.0 ? below : above;
  if (interval.low <= bounds.low) below = above;
  if (interval.high >= bounds.high) above = below;
  if (!(facing > 0.0)) return std::abs(value) > 0.0 ? std::numeric_limits<double>::infinity() : 0.0;
  const double in_proportion = std::abs(value) / facing;
  const double square = below * above - value * (above - below);
  return square > 0.0 ? std::min(in_proportion, std::abs(value) / std::sqrt(square)) : in_proportion;
}

}  // namespace

std::vector<bool> told_together(std::span<const Estimate> estimates, const Interval& bounds, double freedom,
                                std::span<const double> zero_sd, double conf_level) {
  POESY_EXPECTS(conf_level > 0.0 && conf_level < 1.0 && zero_sd.size() == estimates.size());
  std::vector<bool> told(estimates.size(), false);
  if (!(freedom >= 1.0)) return told;
  struct Test {
    std::size_t position;
    double reach;
  };
  std::vector<Test> tests;
  const double one = two_sided_student_quantile(freedom, conf_level);
  for (std::size_t p = 0; p < estimates.size(); ++p) {
    if (!is_tested(estimates[p])) continue;
    const double from_zero =
        zero_sd[p] > 0.0 ? std::abs(estimates[p].value) / (one * zero_sd[p]) : std::numeric_limits<double>::infinity();
    tests.push_back({p, std::min(reach(estimates[p], bounds), from_zero)});
  }
  std::ranges::stable_sort(tests, std::ranges::greater(), &Test::reach);
  for (std::size_t k = 0; k < tests.size(); ++k) {
    const auto others = static_cast<double>(tests.size() - k);
    if (tests[k].reach * one < two_sided_student_quantile(freedom, 1.0 - (1.0 - conf_level) / others)) break;
    told[tests[k].position] = true;
  }
  return told;
}

}  // namespace poesy
