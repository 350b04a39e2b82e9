#pragma once

#include <span>

namespace poesy {

/// Spearman's rank correlation of x and y [N], from -1 to 1: how well y follows x upwards or downwards, in whatever
/// curve. Equal values share their mean rank. Pairs with a NaN are left out. NaN where fewer than three pairs are left,
/// or all x or all y are equal.
double rank_correlation(std::span<const double> x, std::span<const double> y);

/// Kendall's tau of x and y [N] (his tau-b), from -1 to 1: of two things, how much more often x and y agree on which is
/// the larger than they disagree. Pairs of equal values, which agree to nine digits, say nothing, and the divisor
/// leaves them out. Things with a NaN are left out. NaN where fewer than two are left, or all x or all y are equal.
double kendall_tau(std::span<const double> x, std::span<const double> y);

}  // namespace poesy
