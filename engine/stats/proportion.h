#pragma once

#include <cstdint>

#include "engine/stats/moments.h"

/// Proportions of trials, such as the share of good machines, with the limits of Clopper and Pearson (1934, Biometrika
/// 26, 404-413). These limits are exact: for any true proportion, their coverage is at least the level.
namespace poesy {

/// The share k / n of k successes in n trials, with its two-sided interval. On either side, at most (1 - conf_level) /
/// 2 of all intervals miss the true share. Without trials the share is NaN, and the interval is [0, 1]. Preconditions:
/// k <= n, 0 < conf_level < 1.
Estimate proportion(std::uint64_t k, std::uint64_t n, double conf_level);

/// The one-sided lower limit of the true share; 0 if k = 0. Preconditions as for proportion().
double proportion_at_least(std::uint64_t k, std::uint64_t n, double confidence);

/// The one-sided upper limit of the true share; 1 if k = n. Preconditions as for proportion().
double proportion_at_most(std::uint64_t k, std::uint64_t n, double confidence);

/// The least number of trials without a failure that shows, with this confidence, that at least this share of all
/// trials succeeds: the smallest n with share^n <= 1 - confidence, 1109 for 99.73 % at 95 %. Preconditions: 0 < share <
/// 1, 0 < confidence < 1.
std::uint64_t trials_without_failure(double share, double confidence);

/// The change of the share of successes between two series of the same n trials, with its interval. gained: number of
/// trials that succeed only in the second series; lost: number of trials that succeed only in the first series. The
/// interval is that of Agresti and Min (2005, Statistics in Medicine 24, 729-740): Wald's, after half a trial is added
/// to each of the four outcomes. The interval is narrower than for independent series if most trials have the same
/// outcome in both. Without trials the change is NaN, and the interval is [-1, 1]. Preconditions: gained + lost <= n, 0
/// < conf_level < 1.
Estimate paired_change(std::uint64_t gained, std::uint64_t lost, std::uint64_t n, double conf_level);

}  // namespace poesy
