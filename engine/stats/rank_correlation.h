#pragma once

#include <span>

namespace poesy {

/// Spearman's rank correlation of x and y (lists of equal length), from -1 to 1: how closely y follows an increasing or
/// a decreasing function of x. Equal values share their mean rank. Pairs with a NaN are left out. NaN if fewer than
/// three pairs remain, or if all x or all y are equal.
double rank_correlation(std::span<const double> x, std::span<const double> y);

/// Kendall's tau (tau-b) of x and y (lists of equal length), from -1 to 1: how much more often x and y agree than
/// disagree on which of two items is larger. A pair whose x or y is equal to nine digits (a tie) neither agrees nor
/// disagrees. The divisor is the geometric mean of the numbers of pairs without a tie in x and in y. Items with a NaN
/// are left out. NaN if fewer than two remain, or if all x or all y are equal.
double kendall_tau(std::span<const double> x, std::span<const double> y);

}  // namespace poesy
