#include "engine/stats/mean_square_shares.h"

#include <algorithm>
#include <cmath>

#include "engine/base/contract.h"
#include "engine/base/nan.h"

namespace poesy {
namespace {

/// The factor by which the least-squares variance of a slope is multiplied; mean_square_shares() gives the reason.
constexpr double kSquaredRest = 5.0;

/// Sums over the components of a vector, which are rows of a fit.
struct FactorSums {
  double square = 0.0;  ///< sum of the squared slopes of one error
  double noise = 0.0;   ///< sum of the variances of these slopes
};

FactorSums sums_of(const LinearFit& fit, std::span<const std::size_t> rows, std::size_t error) {
  FactorSums sums;
  for (const std::size_t k : rows) {
    const std::size_t at = k * fit.errors + error;
    sums.square += fit.slope[at] * fit.slope[at];
    sums.noise += fit.slope_variance[at];
  }
  return sums;
}

/// The part of the scatter that belongs to two correlated errors together.
double together(const LinearFit& fit, std::span<const std::size_t> rows, std::size_t p, std::size_t q) {
  double sum = 0.0;
  for (const std::size_t k : rows) sum += fit.slope[k * fit.errors + p] * fit.slope[k * fit.errors + q];
  return 2.0 * sum * fit.products[p * fit.errors + q];
}

double square_of(double value) { return value * value; }

/// The sum of the squared means of the rows, minus the bias from the noise of the means.
double squared_means(const LinearFit& fit, std::span<const std::size_t> rows) {
  double sum = 0.0;
  for (const std::size_t k : rows) sum += square_of(fit.offset[k]) - fit.rest[k] / static_cast<double>(fit.machines);
  return std::max(0.0, sum);
}

}  // namespace

MeanSquareShares mean_square_shares(const LinearFit& fit, std::span<const std::size_t> rows, std::size_t poses,
                                    std::span<const ErrorEffect> errors, double conf_level) {
  POESY_EXPECTS(errors.size() == fit.errors && poses > 0);
  const double z = two_sided_normal_quantile(conf_level);
  const auto unknown = Estimate{kNaN, {kNaN, kNaN}};
  const MeanSquareShares none{std::vector<Estimate>(fit.errors, unknown), kNaN, kNaN, kNaN};
  MeanSquareShares found = none;
  double linear = 0.0;
  double rest = 0.0;
  bool varies = false;
  const bool correlated = std::ranges::any_of(errors, [](const ErrorEffect& error) { return error.block != 0; });
  for (const std::size_t k : rows) rest += fit.rest[k];
  for (std::size_t p = 0; p < fit.errors; ++p) {
    const FactorSums sums = sums_of(fit, rows, p);
    const ErrorEffect& error = errors[p];
    const double own = std::max(0.0, sums.square - sums.noise);
    linear += own;
    if (error.block != 0) {
      for (std::size_t q = 0; q < p; ++q) {
        if (errors[q].block == error.block) linear += together(fit, rows, p, q);
      }
    }
    const bool has_effect = sums.square > static_cast<double>(poses) * square_of(error.rounding);
    varies = varies || has_effect;
    const double noise = z * std::sqrt(kSquaredRest * sums.noise);
    const double size = std::sqrt(sums.square);
    found.each[p] = {own, {square_of(std::max(0.0, size - noise)), square_of(size + noise)}};
    if (!has_effect) found.each[p] = {0.0, {0.0, 0.0}};
    if (error.block != 0) found.each[p] = unknown;
  }
  const double all = linear + rest;
  if (!varies || !(all > 0.0)) return none;
  for (Estimate& one : found.each) {
    const Interval interval{one.interval.low / all, std::min(one.interval.high / all, 1.0)};
    one = {one.value / all, correlated ? unknown.interval : interval};
  }
  found.linear = linear / all;
  const double means = squared_means(fit, rows);
  found.offset = std::sqrt(means / static_cast<double>(poses));
  found.offset_share = means / (means + all);
  return found;
}

}  // namespace poesy
