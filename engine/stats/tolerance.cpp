#include "engine/stats/tolerance.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>
#include <utility>

#include "engine/base/contract.h"
#include "engine/base/nan.h"
#include "engine/stats/moments.h"

namespace poesy {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();

double square(double x) { return x * x; }

double mean_of_squares(std::span<const double> values) {
  double sum = 0.0;
  for (const double value : values) sum += square(value);
  return sum / static_cast<double>(values.size());
}

/// 1 / mu_p for each index mu_p; infinite for an error without effect.
std::vector<double> inverse(std::span<const double> index) {
  std::vector<double> values;
  for (const double mu : index) values.push_back(std::isnan(mu) ? kNaN : has_effect(mu) ? 1.0 / mu : kInfinity);
  return values;
}

/// The median of the values that have this dimension. Precondition: there is at least one.
double median_of(std::span<const double> values, std::span<const Dimension> dimensions, Dimension dimension) {
  std::vector<double> chosen;
  for (std::size_t p = 0; p < values.size(); ++p) {
    if (dimensions[p] == dimension) chosen.push_back(values[p]);
  }
  std::ranges::sort(chosen);
  const std::size_t last = chosen.size() - 1;
  return std::midpoint(chosen[last / 2], chosen[last - last / 2]);
}

}  // namespace

std::optional<std::size_t> smallest_effect(std::span<const double> index, std::span<const double> sigma) {
  std::optional<std::size_t> smallest;
  for (std::size_t p = 0; p < index.size(); ++p) {
    if (!has_effect(index[p])) continue;
    if (!smallest || index[p] * sigma[p] < index[*smallest] * sigma[*smallest]) smallest = p;
  }
  return smallest;
}

std::vector<double> equal_effect_tolerances(std::span<const double> index, const ReferenceError& reference) {
  const double mu = index[reference.factor];
  if (!has_effect(mu)) return std::vector<double>(index.size(), kNaN);
  std::vector<double> tolerances = inverse(index);
  for (double& tolerance : tolerances) tolerance *= mu * reference.tolerance;
  tolerances[reference.factor] = reference.tolerance;  // exact, without rounding
  return tolerances;
}

double MeanSquare::growth(std::span<const double> tolerances) const {
  double sum = 0.0;
  for (std::size_t p = 0; p < effects.size(); ++p) {
    if (effects[p] != 0.0) sum += effects[p] * square(tolerances[p]);
  }
  return sum;
}

MeanSquare MeanSquare::holding(std::span<const std::size_t> errors, std::span<const double> sizes) const {
  MeanSquare others = *this;
  for (const std::size_t p : errors) {
    others.background += effects[p] * square(sizes[p]);
    others.effects[p] = 0.0;
  }
  return others;
}

MeanSquare mean_square(const ResponseStudy& study) {
  const std::size_t poses = study.background.size();
  MeanSquare response{mean_of_squares(study.background), {}};
  for (std::size_t p = 0; p < study.index.size(); ++p) {
    double growth = 0.0;
    for (std::size_t m = 0; m < poses; ++m) {
      growth += sample_mean_square(study.mean(p, m), study.std(p, m), static_cast<double>(study.count(p, m)));
    }
    growth = growth / static_cast<double>(poses) - response.background;
    const bool none = growth < 0.0 || study.index[p] < kIndexRounding;
    const double of_error = square(study.sigma[p]) + (study.error_mean.empty() ? 0.0 : square(study.error_mean[p]));
    const double effect = std::isnan(study.index[p]) ? kNaN : growth / of_error;
    response.effects.push_back(none ? 0.0 : effect);
  }
  return response;
}

std::vector<double> mean_square_shares(const MeanSquare& response, std::span<const double> sigma) {
  const double sum = response.growth(sigma);
  std::vector<double> shares;
  for (std::size_t p = 0; p < sigma.size(); ++p) shares.push_back(response.effects[p] * square(sigma[p]) / sum);
  return shares;
}

std::vector<double> tolerances_within(const MeanSquare& response, std::span<const double> proportions, double limit,
                                      std::span<const double> largest) {
  POESY_EXPECTS(!(square(limit) <= response.background));
  std::vector<double> tolerances(proportions.begin(), proportions.end());
  std::vector<double> shared = tolerances;  // proportions of the errors, 0 for those already at their largest tolerance
  double left = square(limit) - response.background;
  for (bool again = true; again;) {
    const double multiple = std::sqrt(left / response.growth(shared));
    again = false;
    for (std::size_t p = 0; p < tolerances.size(); ++p) {
      if (shared[p] == 0.0) continue;
      tolerances[p] = multiple * proportions[p];
      if (response.effects[p] == 0.0 || !(tolerances[p] > largest[p])) continue;
      tolerances[p] = largest[p];
      shared[p] = 0.0;
      left -= response.effects[p] * square(largest[p]);
      again = true;
    }
  }
  return tolerances;
}

Tolerances tolerances(const ResponseStudy& study, const std::optional<ReferenceError>& reference) {
  MeanSquare response = mean_square(study);
  std::vector<double> shares = mean_square_shares(response, study.sigma);
  return {reference,
          reference ? equal_effect_tolerances(study.index, *reference) : std::vector<double>(study.index.size(), kNaN),
          std::move(shares), std::move(response)};
}

std::vector<double> one_size_for_each(std::span<const double> sigma, std::span<const Dimension> dimension) {
  std::vector<double> sizes;
  for (std::size_t p = 0; p < sigma.size(); ++p) sizes.push_back(median_of(sigma, dimension, dimension[p]));
  return sizes;
}

LimitTolerances limit_tolerances(const ResponseStudy& study, const MeanSquare& response,
                                 std::span<const double> one_size, double limit, std::span<const double> largest) {
  const std::vector<double> unbounded(one_size.size(), kInfinity);
  LimitTolerances found{limit, tolerances_within(response, inverse(study.index), limit, largest),
                        tolerances_within(response, one_size, limit, unbounded)};
  for (std::size_t p = 0; p < found.equal_effect.size(); ++p) {
    if (std::isinf(found.equal_effect[p])) found.equal_effect[p] = found.equal_tolerance[p];
  }
  return found;
}

}  // namespace poesy
