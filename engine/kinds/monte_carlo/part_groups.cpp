#include "engine/kinds/monte_carlo/part_groups.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <numeric>
#include <utility>

#include "engine/random/normal_copula.h"
#include "engine/random/normal_quantile.h"
#include "engine/stats/rank_correlation.h"

namespace poesy::monte_carlo {
namespace {

double density(double z) { return std::exp(-0.5 * z * z) / std::sqrt(2.0 * std::numbers::pi); }

/// For each x[i]: the sum of y[j] over all j with x[j] > x[i], plus half of the sum over all j with x[j] == x[i].
std::vector<double> sums_above(std::span<const double> x, std::span<const double> y) {
  std::vector<std::size_t> order(x.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::ranges::stable_sort(order, std::ranges::greater(), [&](std::size_t i) { return x[i]; });
  std::vector<double> sums(x.size());
  double above = 0.0;
  for (auto first = order.begin(); first != order.end();) {
    const auto last = std::find_if(first, order.end(), [&](std::size_t i) { return x[i] != x[*first]; });
    double equal = 0.0;
    for (auto i = first; i != last; ++i) equal += y[*i];
    for (auto i = first; i != last; ++i) sums[*i] = above + 0.5 * equal;
    above += equal;
    first = last;
  }
  return sums;
}

/// The grade of each x: the share of all x that are below it, plus half of the share that equals it, minus 1/2.
std::vector<double> grades(std::span<const double> x) {
  const auto n = static_cast<double>(x.size());
  std::vector<double> found = sums_above(x, std::vector<double>(x.size(), 1.0));
  for (double& one : found) one = 0.5 - one / n;
  return found;
}

double mean_product(std::span<const double> a, std::span<const double> b) {
  return std::inner_product(a.begin(), a.end(), b.begin(), 0.0) / static_cast<double>(a.size());
}

/// The derivatives d rho / dw_i of Spearman's rho = E[a b] / sqrt(E[a^2] E[b^2]) with respect to the weight of part i,
/// where a and b are the grades of x and y. Each derivative has a term from the product a b of the part itself, and
/// terms from the effect of its weight on the grades of all parts.
std::vector<double> rank_moves(std::span<const double> x, std::span<const double> y) {
  const auto n = static_cast<double>(x.size());
  const std::vector<double> a = grades(x);
  const std::vector<double> b = grades(y);
  const std::vector<double> above_x = sums_above(x, b);
  const std::vector<double> above_y = sums_above(y, a);
  const double product = mean_product(a, b);
  const double scale = std::sqrt(mean_product(a, a) * mean_product(b, b));
  std::vector<double> moves;
  for (std::size_t i = 0; i < a.size(); ++i) {
    moves.push_back((a[i] * b[i] + above_x[i] / n + above_y[i] / n - 3.0 * product) / scale);
  }
  return moves;
}

/// The correlation of two normal scores whose rank correlation (Spearman) is `rank`, and its derivative with respect to
/// `rank`.
double score_correlation(double rank) { return 2.0 * std::sin(std::numbers::pi / 6.0 * rank); }
double score_slope(double rank) { return std::numbers::pi / 3.0 * std::cos(std::numbers::pi / 6.0 * rank); }

/// [pairs x parts] The derivatives of the correlations of normal scores with respect to the weights of the parts. Empty
/// if the correlations are not those of the measured values.
std::vector<double> correlation_moves(std::span<const SmoothedValues> parts, std::span<const double> correlation) {
  constexpr double kSame = 1e-9;
  std::vector<double> moves;
  for (std::size_t i = 0; i < parts.size(); ++i) {
    for (std::size_t j = 0; j < i; ++j) {
      const double rank = rank_correlation(parts[i].values(), parts[j].values());
      if (!(std::abs(score_correlation(rank) - correlation[i * parts.size() + j]) <= kSame)) return {};
      for (const double move : rank_moves(parts[i].values(), parts[j].values())) {
        moves.push_back(score_slope(rank) * move);
      }
    }
  }
  return moves;
}

/// The inverse of a symmetric positive definite matrix [size x size].
std::vector<double> inverse_of(std::span<const double> matrix, std::size_t size) {
  const std::vector<double> triangle = lower_triangle(matrix);
  std::vector<double> inverse(matrix.size(), 0.0);
  for (std::size_t column = 0; column < size; ++column) {
    const std::span x = std::span(inverse).subspan(column * size, size);
    x[column] = 1.0;
    for (std::size_t i = 0; i < size; ++i) {
      for (std::size_t j = 0; j < i; ++j) x[i] -= triangle[i * size + j] * x[j];
      x[i] /= triangle[i * size + i];
    }
    for (std::size_t i = size; i-- > 0;) {
      for (std::size_t j = i + 1; j < size; ++j) x[i] -= triangle[j * size + i] * x[j];
      x[i] /= triangle[i * size + i];
    }
  }
  return inverse;
}

/// The smoothed value of one part: uniform between `low` and `high`.
struct Range {
  double low;
  double high;

  bool single() const { return low == high; }
  bool holds(double x) const { return low <= x && x <= high; }
  /// The probability that the smoothed value is below x, plus half of the probability that it equals x.
  double share(double x) const {
    if (single()) return x == low ? 0.5 : static_cast<double>(x > low);
    return std::clamp((x - low) / (high - low), 0.0, 1.0);
  }
};

Range range_of(const SmoothedValues& parts, std::size_t i) {
  return {parts.values()[i] - parts.half_widths()[i], parts.values()[i] + parts.half_widths()[i]};
}

/// Adds to `influence` [parts] the derivative of ln f with respect to the weight of each part, where f is the density
/// of one error at the value x. It is g_i / f - 1, where g_i is the density of the smoothed value of part i at x.
void add_density(const SmoothedValues& parts, double x, std::span<double> influence) {
  const std::size_t n = influence.size();
  bool single = false;  // whether x equals a value that is not smoothed, whose density outweighs all others
  for (std::size_t i = 0; i < n; ++i) single = single || (range_of(parts, i).single() && range_of(parts, i).low == x);
  const auto own = [&](std::size_t i) {
    const Range range = range_of(parts, i);
    if (!range.holds(x) || range.single() != single) return 0.0;
    return single ? 1.0 : 1.0 / (range.high - range.low);
  };
  double sum = 0.0;
  for (std::size_t i = 0; i < n; ++i) sum += own(i);
  if (!(sum > 0.0)) return;
  for (std::size_t i = 0; i < n; ++i) influence[i] += static_cast<double>(n) * own(i) / sum - 1.0;
}

/// Adds to `influence` [parts] the terms of d ln f / dw_i that add_density() leaves out, where f is the joint density
/// of the correlated errors x [errors] and w_i the weight of part i. These terms come from the normal scores of the
/// errors, which depend on the share of the parts below x, and from the correlations of the scores.
void add_scores(const PartGroup& group, std::span<const double> x, std::span<double> influence) {
  const std::size_t size = group.errors.size();
  const std::size_t n = group.size();
  constexpr double kLeastShare = 1e-12;
  std::vector<double> share(size);
  std::vector<double> z(size);
  std::vector<double> y(size, 0.0);
  for (std::size_t p = 0; p < size; ++p) {
    share[p] = group.parts[p].share(x[p]);
    z[p] = normal_quantile(1.0, std::clamp(share[p], kLeastShare, 1.0 - kLeastShare));
  }
  for (std::size_t p = 0; p < size; ++p) {
    for (std::size_t q = 0; q < size; ++q) y[p] += group.inverse[p * size + q] * z[q];
  }
  for (std::size_t p = 0; p < size; ++p) {
    const double slope = (z[p] - y[p]) / density(z[p]);
    for (std::size_t i = 0; i < n; ++i) influence[i] += slope * (range_of(group.parts[p], i).share(x[p]) - share[p]);
  }
  if (group.moves.empty()) return;
  std::size_t pair = 0;
  for (std::size_t p = 0; p < size; ++p) {
    for (std::size_t q = 0; q < p; ++q, ++pair) {
      const double slope = y[p] * y[q] - group.inverse[p * size + q];
      for (std::size_t i = 0; i < n; ++i) influence[i] += slope * group.moves[pair * n + i];
    }
  }
}

/// Whether all errors of a block were measured on the same number of parts.
bool measured_together(const Plan& plan, std::span<const std::size_t> errors) {
  const auto& first = plan.distributions()[errors.front()].parts();
  return first && std::ranges::all_of(errors, [&](std::size_t p) {
           const auto& parts = plan.distributions()[p].parts();
           return parts && parts->values().size() == first->values().size();
         });
}

}  // namespace

PartGroup part_group(std::vector<std::size_t> errors, std::vector<SmoothedValues> parts,
                     std::span<const double> correlation) {
  const std::size_t size = errors.size();
  PartGroup group{std::move(errors), std::move(parts), {}};
  if (size == 1) return group;
  group.inverse = inverse_of(correlation, size);
  group.moves = correlation_moves(group.parts, correlation);
  return group;
}

PartGroups part_groups(const Plan& plan) {
  PartGroups groups;
  const auto is_measured = [&](std::size_t p) { return plan.distributions()[p].parts().has_value(); };
  groups.known = std::ranges::none_of(plan.per_pose(), is_measured);
  if (!groups.known) return groups;
  for (std::size_t p = 0; p < plan.factors().size(); ++p) {
    if (is_measured(p) && !plan.is_correlated(p)) {
      groups.each.push_back(part_group({p}, {*plan.distributions()[p].parts()}, {}));
    }
  }
  for (const CorrelatedSlots& block : plan.correlated()) {
    if (std::ranges::none_of(block.slots, is_measured)) continue;
    groups.known = groups.known && measured_together(plan, block.slots);
    if (!groups.known) continue;
    std::vector<SmoothedValues> parts;
    for (const std::size_t p : block.slots) parts.push_back(*plan.distributions()[p].parts());
    groups.each.push_back(part_group(block.slots, std::move(parts), block.copula.correlation()));
  }
  return groups;
}

void add_influence(const PartGroup& group, std::span<const double> x, std::span<double> influence) {
  for (std::size_t p = 0; p < x.size(); ++p) add_density(group.parts[p], x[p], influence);
  if (x.size() > 1) add_scores(group, x, influence);
}

}  // namespace poesy::monte_carlo
