#include "engine/stats/rank_correlation.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>
#include <vector>

#include "engine/base/contract.h"

namespace poesy {
namespace {

/// From 1; equal values share their mean rank.
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

/// Pearson's correlation of two lists of ranks, whose means are both (N + 1) / 2; NaN where one of them does not vary.
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

}  // namespace

double rank_correlation(std::span<const double> x, std::span<const double> y) {
  POESY_EXPECTS(x.size() == y.size());
  std::vector<double> known_x;
  std::vector<double> known_y;
  for (std::size_t n = 0; n < x.size(); ++n) {
    if (std::isnan(x[n]) || std::isnan(y[n])) continue;
    known_x.push_back(x[n]);
    known_y.push_back(y[n]);
  }
  if (known_x.size() < 3) return std::numeric_limits<double>::quiet_NaN();
  return correlation(mean_ranks(known_x), mean_ranks(known_y));
}

}  // namespace poesy
