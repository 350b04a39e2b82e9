#pragma once

#include <cstdint>
#include <span>

#include "engine/stats/interval.h"
#include "engine/stats/moments.h"

namespace poesy {

/// Student's interval for a mean: mean +- t(n - 1) s / sqrt(n). NaN at both ends below two samples.
/// Precondition: 0 < conf_level < 1.
Interval mean_interval(const Moments& moments, double conf_level);

/// Samples of M groups by their numbers, means and sample standard deviations, [M] each.
struct Groups {
  std::span<const std::uint64_t> count;  ///< [groups] samples
  std::span<const double> mean;          ///< [groups] their mean
  std::span<const double> std;           ///< [groups] their sample standard deviation
};

/// The mean of all samples of all groups together, with its interval when the groups are fixed and only what is in them
/// was drawn (stratified sampling; Cochran 1977, Sampling Techniques, Eqs. 5.7 and 5.16): a variance of
/// sum of n_m s_m^2 / N^2, and Student's quantile with Satterthwaite's degrees of freedom. For one group that of
/// mean_interval. Groups without a sample do not count; one of a single sample gives NaN at both ends.
/// Precondition: 0 < conf_level < 1.
Estimate stratified_mean(const Groups& groups, double conf_level);

}  // namespace poesy
