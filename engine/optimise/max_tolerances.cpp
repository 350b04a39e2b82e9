#include "engine/optimise/max_tolerances.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "engine/base/contract.h"

namespace poesy {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();

/// The tolerance factor x proportion of a part, clamped to its range.
double tolerance_at(double factor, double proportion, const ToleranceRange& range) {
  if (proportion == kInfinity) return range.hi;
  return std::clamp(factor * proportion, range.lo, range.hi);
}

std::vector<double> tolerances_at(double factor, std::span<const double> proportions,
                                  std::span<const ToleranceRange> ranges) {
  std::vector<double> tolerance;
  for (std::size_t i = 0; i < ranges.size(); ++i) tolerance.push_back(tolerance_at(factor, proportions[i], ranges[i]));
  return tolerance;
}

/// The combined effect of these tolerances [parts] (SI) on limit l. A part without effect adds nothing, even if its
/// tolerance is infinite.
double need_of(const ToleranceLimits& limits, std::size_t l, std::span<const double> tolerance) {
  double sum = 0.0;
  for (std::size_t i = 0; i < tolerance.size(); ++i) {
    if (limits.row(l)[i] != 0.0) sum += limits.row(l)[i] * size_of(tolerance[i], limits.stacking);
  }
  return sum;
}

/// The limit that the tolerances [parts] (SI) exceed by the largest factor; none if they keep all limits.
std::optional<Infeasible> find_infeasible(const ToleranceLimits& limits, std::span<const double> tolerance) {
  std::optional<Infeasible> worst;
  for (std::size_t l = 0; l < limits.count(); ++l) {
    const double need = need_of(limits, l, tolerance);
    if (need <= limits.room[l] && limits.room[l] > 0.0) continue;
    const auto share = [](double n, double room) { return room > 0.0 ? n / room : kInfinity; };
    if (!worst || share(need, limits.room[l]) > share(worst->need, worst->room)) worst = {l, need, limits.room[l]};
  }
  return worst;
}

/// Zero, and the common factors at which the tolerance of some part reaches or leaves a bound, ascending.
std::vector<double> corners(std::span<const double> proportions, std::span<const ToleranceRange> ranges) {
  std::vector<double> factors{0.0};
  for (std::size_t i = 0; i < ranges.size(); ++i) {
    for (const double bound : {ranges[i].lo, ranges[i].hi}) {
      if (bound > 0.0 && bound < kInfinity && proportions[i] < kInfinity) factors.push_back(bound / proportions[i]);
    }
  }
  std::ranges::sort(factors);
  return factors;
}

/// The common factor at which limit l is used up, if the same parts are at a bound as at the factor `inside`.
double factor_of(const ToleranceLimits& limits, std::size_t l, double inside, std::span<const double> proportions,
                 std::span<const ToleranceRange> ranges) {
  double held = 0.0;  // sum of effect x size over the parts at a bound
  // The sum of effect x size over the other parts, at the factor 1. At another factor, this sum is multiplied by
  // size_of(factor).
  double grows = 0.0;
  for (std::size_t i = 0; i < ranges.size(); ++i) {
    const double effect = limits.row(l)[i];
    if (effect == 0.0) continue;
    const double tolerance = inside * proportions[i];
    if (tolerance > ranges[i].lo && tolerance < ranges[i].hi) {
      grows += effect * size_of(proportions[i], limits.stacking);
    } else {
      held += effect * size_of(tolerance_at(inside, proportions[i], ranges[i]), limits.stacking);
    }
  }
  if (grows == 0.0) return kInfinity;
  const double rounding = 1.0 - (static_cast<double>(ranges.size()) + 16.0) * std::numeric_limits<double>::epsilon();
  return tolerance_of(std::fmax(0.0, limits.room[l] * rounding - held) / grows, limits.stacking);
}

}  // namespace

std::vector<double> equal_effect_proportions(const ToleranceLimits& limits) {
  std::vector<double> largest(limits.parts, 0.0);
  for (std::size_t l = 0; l < limits.count(); ++l) {
    for (std::size_t i = 0; i < limits.parts; ++i)
      largest[i] = std::fmax(largest[i], limits.row(l)[i] / limits.room[l]);
  }
  for (double& effect : largest) effect = 1.0 / tolerance_of(effect, limits.stacking);
  return largest;
}

std::variant<MaxTolerances, Infeasible> maximise_tolerances(const ToleranceLimits& limits,
                                                            std::span<const double> proportions,
                                                            std::span<const ToleranceRange> ranges) {
  POESY_EXPECTS(proportions.size() == limits.parts && ranges.size() == limits.parts);
  const auto keeps = [&](double factor) {
    return !find_infeasible(limits, tolerances_at(factor, proportions, ranges));
  };
  if (const auto worst = find_infeasible(limits, tolerances_at(0.0, proportions, ranges))) return *worst;
  // Between two neighbouring corners (factors at which a part reaches or leaves a bound), the same parts are at a
  // bound.
  const std::vector<double> factors = corners(proportions, ranges);
  const auto next = std::ranges::partition_point(factors, keeps);
  const double from = *std::prev(next);
  const double to = next == factors.end() ? kInfinity : *next;
  const double inside = to == kInfinity ? 2.0 * from + 1.0 : 0.5 * (from + to);
  MaxTolerances found{{}, to, std::nullopt};
  for (std::size_t l = 0; l < limits.count(); ++l) {
    const double factor = std::fmax(from, factor_of(limits, l, inside, proportions, ranges));
    if (factor < found.factor || !found.limit) found = {{}, std::fmin(factor, to), l};
  }
  if (found.factor == kInfinity) found.limit.reset();
  if (!keeps(found.factor)) found.factor = from;  // rounding: two corners may be almost equal
  found.tolerance = tolerances_at(found.factor, proportions, ranges);
  return found;
}

}  // namespace poesy
