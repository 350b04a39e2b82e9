#pragma once

#include <span>

#include "engine/base/archive.h"
#include "engine/stats/moments.h"

namespace poesy {

/// Sensitivity index at one pose: sigma(response) / sigma(error) (Du et al. 2022, Eqs. 51-52), the
/// response's sample standard deviation over the error's standard deviation as set.
/// Interval: Bonett 2006, Comput. Stat. Data Anal. 50, 775-782, on the logarithm of the variance, with the
/// plain sample kurtosis. Zero spread gives the interval [0, 0]; fewer than five samples give NaN at both ends.
Estimate local_index(const Moments& response, double error_sigma, double conf_level);

/// One pose's contribution to a global index.
struct LocalIndex {
  double value;           ///< Eqs. 51-52
  double standard_error;  ///< of value, from sampling

  void state(Archive& archive) { archive.real(value, standard_error); }  ///< Both.
};

/// The standard error that belongs to local_index: of its logarithm by Bonett 2006, times the index. NaN below five
/// samples; 0 for zero spread.
LocalIndex local_index_with_error(const Moments& response, double error_sigma);

/// Mean over the poses plus sample standard deviation over the poses (Du et al. 2022, Eqs. 53-54), without an interval:
/// the value of global_index. NaN without a pose.
double published_index(std::span<const LocalIndex> poses);

/// Global index: mean over the poses plus sample standard deviation over the poses (Du et al. 2022,
/// Eqs. 53-54); NaN when a pose has no index, the mean alone for a single pose.
/// The interval is for the value that infinitely many samples would give at the same poses. Sampling noise, which the
/// plain formula takes for spread between poses, is subtracted from the spread, so where poses differ by little more
/// than noise the estimate lies high in its interval, which is extended to reach it; more samples close that gap.
/// Mean and spread are combined, with their correlation, by the method of variance estimates recovery (Zou and
/// Donner 2008, Stat. Med. 27, 1693-1702). Where the spread seen is no more than noise at this level (chi-square with
/// Satterthwaite's degrees of freedom), the lower limit is that of the mean alone.
/// There the interval may cover more than its level; where poses differ clearly it covers its level.
/// Indices that are all exactly zero give [0, 0]; a pose without a standard error gives NaN at both ends.
Estimate global_index(std::span<const LocalIndex> poses, double conf_level);

/// The same without what sampling adds to it: mean + spread of the indices, each without the bias of a sample standard
/// deviation, the spread without that part of it which is sampling noise. The value lies within its interval, which
/// is that of global_index but for the extension. Where a pose has no standard error nothing can be taken off: the
/// value then is that of global_index, NaN at both ends.
Estimate corrected_global_index(std::span<const LocalIndex> poses, double conf_level);

/// An index holds at other sizes of its error if it changes by no more than this share at a tenth of the size.
inline constexpr double kIndexHolds = 0.02;

/// Whether an index is known to change with the size of its error. change: index at a tenth of the size over index - 1;
/// where it is NaN nothing is known.
bool changes_with_size(double change);

// What an index says where the effect of an error is no larger than the rounding of its solves. An index here is a
// response's standard deviation over sigma, the error's; all numbers are SI.

/// Below this an index is rounding whatever the size of the error: digits that cancel leave some 1e-16 of it.
inline constexpr double kIndexRounding = 1e-10;

/// An index of this size or more would be of interest. An error with a smaller one may be a million times larger than
/// errors with an index of 1.
inline constexpr double kIndexOfInterest = 1e-6;

/// Below this an index is rounding: response_rounding / sigma, for solves round whatever the size of the error, but at
/// least kIndexRounding. response_rounding: as Model::rounding gives it.
double index_rounding(double response_rounding, double sigma);

/// Up to this the response to errors of this size, lengths and angles, is rounding: response_rounding, but at least
/// kIndexRounding times the larger one of both, SI. NaN for a size that there is none of.
double size_rounding(double response_rounding, double linear, double angular);

/// Up to this standard deviation a response is rounding while errors vary together: the root sum square over them of
/// index_rounding x sigma, because independent effects add up like that. So a response on which no error has an effect
/// alone does not vary with all of them. sigma: [P]; all SI.
double joint_rounding(double response_rounding, std::span<const double> sigma);

/// Whether a response does not vary: none of its standard deviations, at poses for instance, is more than rounding,
/// though one of them is known. Such a response has nothing to be shared, so this is asked before any share of its
/// variance is formed. rounding: as joint_rounding gives it.
bool is_constant(std::span<const double> deviations, double rounding);

/// Whether an index is more than rounding. NaN is not. rounding: as index_rounding gives it.
bool has_effect(double index, double rounding = kIndexRounding);

/// Whether the error is too small to tell: it has no effect that is more than rounding, but would not even if its index
/// were of interest. rounding: likewise.
bool is_too_small_to_tell(double index, double rounding);

/// The index as far as it can be told from rounding: itself where the error has an effect, 0 where it has none, NaN
/// where the error is too small to tell, or the index not known. rounding: likewise.
double told_from_rounding(double index, double rounding);

}  // namespace poesy
