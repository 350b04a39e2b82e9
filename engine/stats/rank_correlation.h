#pragma once

#include <span>

namespace poesy {

/// Spearman's rank correlation of x and y [N], from -1 to 1: how well y follows x upwards or downwards, in whatever
/// curve. Equal values share their mean rank. Pairs with a NaN are left out. NaN where fewer than three pairs are left,
/// or all x or all y are equal.
double rank_correlation(std::span<const double> x, std::span<const double> y);

}  // namespace poesy
