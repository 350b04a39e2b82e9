#include "engine/random/smoothed_values.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <numeric>
#include <utility>

#include "engine/base/contract.h"

namespace poesy {
namespace {

/// The distance of each value from its k-th nearest other value. sorted: ascending.
std::vector<double> distances(std::span<const double> sorted, std::size_t k) {
  std::vector<double> found;
  std::size_t low = 0;  // sorted[low .. low + k] are the value and the k values nearest to it
  for (const double value : sorted) {
    while (low + k + 1 < sorted.size() && sorted[low + k + 1] - value < value - sorted[low]) ++low;
    found.push_back(std::max(value - sorted[low], sorted[low + k] - value));
  }
  return found;
}

/// distances() for k = ceil(sqrt(n)) of n values, or for the next larger k for which not all distances are 0.
std::vector<double> neighbour_distances(std::span<const double> sorted) {
  auto k = static_cast<std::size_t>(std::ceil(std::sqrt(static_cast<double>(sorted.size()))));
  for (k = std::min(k, sorted.size() - 1);; ++k) {
    std::vector<double> found = distances(sorted, k);
    if (std::ranges::any_of(found, [](double distance) { return distance > 0.0; })) return found;
  }
}

/// The sum of (value - c)^2 over the values.
double squares_about(std::span<const double> values, double c) {
  double sum = 0.0;
  for (const double value : values) sum += (value - c) * (value - c);
  return sum;
}

double mean_about(std::span<const double> values, double c) {
  double sum = 0.0;
  for (const double value : values) sum += value - c;
  return c + sum / static_cast<double>(values.size());
}

/// The range over which one value is smoothed.
struct Spread {
  double low;
  double high;
};

}  // namespace

SmoothedValues::SmoothedValues(std::vector<double> values) : values_(std::move(values)), half_widths_(values_.size()) {
  const std::size_t n = values_.size();
  POESY_EXPECTS(n > 1);
  std::vector<std::size_t> order(n);
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::ranges::stable_sort(order, {}, [&](std::size_t k) { return values_[k]; });
  std::vector<double> sorted;
  for (const std::size_t k : order) sorted.push_back(values_[k]);
  // The mean is computed twice, so that it is exact enough for values far from zero.
  mean_ = mean_about(sorted, mean_about(sorted, 0.0));
  const double variance = squares_about(sorted, mean_) / static_cast<double>(n - 1);
  const std::vector<double> distance = neighbour_distances(sorted);
  // The scale for which the mean of (scale x distance)^2 / 3, the variances of the uniforms, is variance / n.
  const double scale = std::numbers::sqrt3 * std::sqrt(variance / squares_about(distance, 0.0));
  for (std::size_t k = 0; k < n; ++k) half_widths_[order[k]] = scale * distance[k];
  add_pieces();
}

void SmoothedValues::add_pieces() {
  std::vector<Spread> spreads;
  std::vector<double> ends;
  for (std::size_t k = 0; k < values_.size(); ++k) {
    spreads.push_back({values_[k] - half_widths_[k], values_[k] + half_widths_[k]});
    ends.insert(ends.end(), {spreads.back().low, spreads.back().high});
  }
  std::ranges::sort(spreads, {}, [](const Spread& spread) { return std::pair(spread.low, spread.high); });
  std::ranges::sort(ends);
  ends.erase(std::unique(ends.begin(), ends.end()), ends.end());
  double below = 0.0;  // number of values below the knot; a value counts by the share of its range that is below
  const auto add_knot = [&](double x) {
    knots_.push_back(x);
    shares_.push_back(below);
  };
  std::vector<Spread> over;  // ranges that contain the piece between ends[e] and ends[e + 1]
  auto next = spreads.begin();
  for (std::size_t e = 0; e < ends.size(); ++e) {
    add_knot(ends[e]);
    std::erase_if(over, [&](const Spread& spread) { return spread.high <= ends[e]; });
    const double before = below;
    for (; next != spreads.end() && next->low == ends[e]; ++next) {
      if (next->high > next->low)
        over.push_back(*next);
      else
        below += 1.0;
    }
    if (below > before) add_knot(ends[e]);
    if (e + 1 == ends.size()) break;
    for (const Spread& spread : over) below += (ends[e + 1] - ends[e]) / (spread.high - spread.low);
  }
  double squares = 0.0;
  for (double& share : shares_) share /= below;
  for (std::size_t k = 1; k < knots_.size(); ++k) {
    const double a = knots_[k - 1] - mean_;
    const double b = knots_[k] - mean_;
    squares += (shares_[k] - shares_[k - 1]) * (a * a + a * b + b * b) / 3.0;
  }
  deviation_ = std::sqrt(squares);
}

double SmoothedValues::quantile(double u) const {
  POESY_EXPECTS(u > 0.0 && u < 1.0);
  const auto above = static_cast<std::size_t>(std::ranges::upper_bound(shares_, u) - shares_.begin());
  const double part = (u - shares_[above - 1]) / (shares_[above] - shares_[above - 1]);
  return std::min(knots_[above - 1] + part * (knots_[above] - knots_[above - 1]), knots_[above]);
}

double SmoothedValues::share(double x) const {
  const auto [first, last] = std::equal_range(knots_.begin(), knots_.end(), x);
  const auto at = static_cast<std::size_t>(first - knots_.begin());
  const auto above = static_cast<std::size_t>(last - knots_.begin());
  if (at < above) return 0.5 * (shares_[at] + shares_[above - 1]);
  if (above == 0 || above == knots_.size()) return above == 0 ? 0.0 : 1.0;
  const double part = (x - knots_[above - 1]) / (knots_[above] - knots_[above - 1]);
  return shares_[above - 1] + part * (shares_[above] - shares_[above - 1]);
}

}  // namespace poesy
