#include "engine/stats/rank_correlation.h"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <utility>
#include <vector>

#include "engine/base/contract.h"
#include "engine/base/nan.h"

namespace poesy {
namespace {

/// The ranks of the values, from 1; equal values share their mean rank.
std::vector<double> mean_ranks(const std::vector<double>& values) {
  std::vector<std::size_t> order(values.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::ranges::sort(order, {}, [&](std::size_t n) { return values[n]; });
  std::vector<double> ranks(values.size());
  for (std::size_t first = 0; first < order.size();) {
    std::size_t end = first + 1;
    while (end < order.size() && values[order[end]] == values[order[first]]) ++end;
    for (std::size_t n = first; n < end; ++n) ranks[order[n]] = 0.5 * static_cast<double>(first + 1 + end);
    first = end;
  }
  return ranks;
}

/// Pearson's correlation of two lists of N ranks, whose means are both (N + 1) / 2; NaN if one of them does not vary.
double correlation(const std::vector<double>& x, const std::vector<double>& y) {
  const double mean = 0.5 * static_cast<double>(x.size() + 1);
  double xx = 0.0;
  double yy = 0.0;
  double xy = 0.0;
  for (std::size_t n = 0; n < x.size(); ++n) {
    xx += (x[n] - mean) * (x[n] - mean);
    yy += (y[n] - mean) * (y[n] - mean);
    xy += (x[n] - mean) * (y[n] - mean);
  }
  return xy / std::sqrt(xx * yy);
}

/// The values of x and y at the indices where both are known.
std::pair<std::vector<double>, std::vector<double>> known(std::span<const double> x, std::span<const double> y) {
  POESY_EXPECTS(x.size() == y.size());
  std::pair<std::vector<double>, std::vector<double>> both;
  for (std::size_t n = 0; n < x.size(); ++n) {
    if (std::isnan(x[n]) || std::isnan(y[n])) continue;
    both.first.push_back(x[n]);
    both.second.push_back(y[n]);
  }
  return both;
}

/// The sign of a - b, but 0 if they differ only by rounding, as effects of mirrored errors do.
int order(double a, double b) {
  constexpr double kEqual = 1e-9;
  if (std::abs(a - b) < kEqual * std::max(std::abs(a), std::abs(b))) return 0;
  return (a > b) - (a < b);
}

}  // namespace

double rank_correlation(std::span<const double> x, std::span<const double> y) {
  const auto [known_x, known_y] = known(x, y);
  return known_x.size() < 3 ? kNaN : correlation(mean_ranks(known_x), mean_ranks(known_y));
}

double kendall_tau(std::span<const double> x, std::span<const double> y) {
  const auto [known_x, known_y] = known(x, y);
  int agree = 0;
  int ordered_x = 0;
  int ordered_y = 0;
  for (std::size_t n = 0; n < known_x.size(); ++n) {
    for (std::size_t m = 0; m < n; ++m) {
      const int of_x = order(known_x[n], known_x[m]);
      const int of_y = order(known_y[n], known_y[m]);
      agree += of_x * of_y;
      ordered_x += of_x * of_x;
      ordered_y += of_y * of_y;
    }
  }
  return agree / std::sqrt(static_cast<double>(ordered_x) * static_cast<double>(ordered_y));
}

}  // namespace poesy
