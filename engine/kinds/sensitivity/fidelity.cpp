#include "engine/kinds/sensitivity/fidelity.h"

#include <algorithm>
#include <cmath>

#include "engine/base/contract.h"
#include "engine/base/nan.h"
#include "engine/kinds/sensitivity/result.h"
#include "engine/stats/indices.h"

namespace poesy {
namespace {

/// A spread that solvers leave where there is none, SI; with errors of 1e-3, of kIndexRounding.
constexpr double kSpreadRounding = 1e-13;

/// Two results and what belongs to both.
struct BothFidelities {
  const SensitivityResult& first;
  const SensitivityResult& second;
  std::span<const Dimension> dimensions;
  std::span<const double> sigma;

  bool is_rounding(std::size_t factor, double index) const {
    return index < kIndexRounding || index * sigma[factor] < kSpreadRounding;
  }

  /// The error's largest index on a response of the same dimension; NaN when one is not known.
  double effect(const SensitivityResult& result, std::size_t response, std::size_t factor) const {
    double largest = 0.0;
    for (std::size_t r = 0; r < result.responses; ++r) {
      const double index = result.global[r * result.factors + factor];
      if (dimensions[r] != dimensions[response]) continue;
      if (std::isnan(index)) return kNaN;
      largest = std::max(largest, index);
    }
    return largest;
  }

  /// Of the mean, over what the background alone gives.
  static double growth(const SensitivityResult& result, std::size_t response, std::size_t pose, std::size_t cell) {
    return result.mean[cell] - result.background[response * result.poses + pose];
  }

  /// Root mean square over the poses of the change of mean and spread, over sigma.
  double change(std::size_t response, std::size_t factor) const {
    double sum = 0.0;
    for (std::size_t m = 0; m < first.poses; ++m) {
      const std::size_t cell = (response * first.factors + factor) * first.poses + m;
      const double of_mean = growth(first, response, m, cell) - growth(second, response, m, cell);
      const double of_std = first.std[cell] - second.std[cell];
      sum += of_mean * of_mean + of_std * of_std;
    }
    return std::sqrt(sum / static_cast<double>(first.poses)) / sigma[factor];
  }

  /// Whether as many samples of an error count in both, at every pose.
  bool same_samples(std::size_t factor) const {
    for (std::size_t r = 0; r < first.responses; ++r) {
      const auto begin = static_cast<std::ptrdiff_t>((r * first.factors + factor) * first.poses);
      const auto end = begin + static_cast<std::ptrdiff_t>(first.poses);
      if (!std::equal(first.count.begin() + begin, first.count.begin() + end, second.count.begin() + begin)) {
        return false;
      }
    }
    return true;
  }
};

/// What the ratios of one error and response are counted from: NaN where there is nothing, 0 where only the second
/// fidelity has anything.
double ratio_base(const BothFidelities& both, std::size_t response, std::size_t factor) {
  const double effect = both.effect(both.first, response, factor);
  if (!both.is_rounding(factor, effect)) return effect;
  return both.is_rounding(factor, both.effect(both.second, response, factor)) ? kNaN : 0.0;
}

}  // namespace

FidelityResult compare_fidelities(const SensitivityResult& first, const SensitivityResult& second,
                                  std::span<const Dimension> dimensions, std::span<const double> sigma,
                                  double linearity) {
  POESY_EXPECTS(first.global.size() == second.global.size() && first.mean.size() == second.mean.size());
  POESY_EXPECTS(dimensions.size() == first.responses && sigma.size() == first.factors);
  const BothFidelities both{first, second, dimensions, sigma};
  FidelityResult result;
  result.linearity = linearity;
  result.global = second.global;
  for (std::size_t p = 0; p < first.factors; ++p) result.linear.push_back(both.same_samples(p) ? 1 : 0);
  for (std::size_t r = 0; r < first.responses; ++r) {
    for (std::size_t p = 0; p < first.factors; ++p) {
      const std::size_t at = r * first.factors + p;
      const double base = ratio_base(both, r, p);
      result.discrepancy.push_back(second.global[at] - first.global[at]);
      result.relative_discrepancy.push_back(result.discrepancy.back() / base);
      result.nonlinearity.push_back(both.change(r, p) / base);
      const bool is_known = !std::isnan(result.discrepancy.back());
      const bool is_small =
          std::abs(result.relative_discrepancy.back()) <= linearity && result.nonlinearity.back() <= linearity;
      if (!is_known || (!std::isnan(base) && !is_small)) result.linear[p] = 0;
    }
  }
  for (const SolveCounts& counts : second.solves) result.not_converged.push_back(counts.not_converged());
  return result;
}

}  // namespace poesy
