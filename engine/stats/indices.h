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
  double value;           ///< index (Eqs. 51-52)
  double standard_error;  ///< standard error of the value, from sampling

  void state(Archive& archive) { archive.real(value, standard_error); }  ///< Reads or writes both.
};

/// The index and its standard error: that of its logarithm by Bonett 2006, times the index. The error is NaN below five
/// samples, and 0 for zero spread.
LocalIndex local_index_with_error(const Moments& response, double error_sigma);

/// The value of global_index(): mean over the poses plus sample standard deviation over the poses (Du et al. 2022, Eqs.
/// 53-54). NaN without a pose.
double published_index(std::span<const LocalIndex> poses);

/// The global index: mean over the poses plus sample standard deviation over the poses (Du et al. 2022, Eqs. 53-54);
/// NaN if a pose has no index, the mean alone for a single pose.
///
/// The interval is for the value that infinitely many samples would give at the same poses. The plain formula takes
/// sampling noise for spread between poses; the interval subtracts it. So where poses differ by little more than noise,
/// the estimate is near the upper end of its interval, which is extended to contain it; more samples close that gap.
/// Mean and spread are combined, with their correlation, by the method of variance estimates recovery (Zou and Donner
/// 2008, Stat. Med. 27, 1693-1702). If the spread is no more than noise at this level (chi-square with Satterthwaite's
/// degrees of freedom), the lower limit is that of the mean alone, and the coverage may be higher than the level. If
/// poses differ clearly, the coverage is the level. Indices that are all zero give [0, 0]; a pose without a standard
/// error gives NaN at both ends.
Estimate global_index(std::span<const LocalIndex> poses, double conf_level);

/// The global index without sampling noise: mean + spread of the indices, each without the bias of a sample standard
/// deviation, and the spread without its part from noise. The value lies within its interval, which is that of
/// global_index() without the extension. If a pose has no standard error, the noise is unknown: the value is that of
/// global_index(), with NaN at both ends.
Estimate corrected_global_index(std::span<const LocalIndex> poses, double conf_level);

/// The largest relative change of an index at a tenth of its error's size for which it holds at other sizes.
inline constexpr double kIndexHolds = 0.02;

/// Whether an index is known to change with the size of its error. change: index at a tenth of the size over index,
/// less 1; NaN if not known.
bool changes_with_size(double change);

// Whether an index is rounding. An effect that is no larger than the rounding of solves has an index without meaning.
// Here an index is a response's standard deviation over sigma, the error's; all numbers are SI.

/// An index below this is rounding for any size of the error: cancelling digits leave about 1e-16 of it.
inline constexpr double kIndexRounding = 1e-10;

/// The least index that is of interest. An error with a smaller one could be a million times larger than errors with an
/// index of 1.
inline constexpr double kIndexOfInterest = 1e-6;

/// The magnitude below which an index is rounding: response_rounding / sigma, because solves round for any size of the
/// error, but at least kIndexRounding. response_rounding: see Model::rounding().
double index_rounding(double response_rounding, double sigma);

/// The magnitude up to which the response to errors of these sizes is rounding: response_rounding, but at least
/// kIndexRounding times the larger size, SI. A size may be NaN if there is none.
double size_rounding(double response_rounding, double linear, double angular);

/// The standard deviation up to which a response is rounding while errors vary together: the root sum of squares of
/// index_rounding x sigma over the errors, because independent effects add like that. So a response on which no error
/// has an effect alone does not vary with all of them. sigma: [P]; all SI.
double joint_rounding(double response_rounding, std::span<const double> sigma);

/// Whether a response does not vary: none of its standard deviations, at poses for instance, is more than rounding, and
/// at least one is known. Check this before computing shares of its variance. rounding: see joint_rounding().
bool is_constant(std::span<const double> deviations, double rounding);

/// Whether an index is more than rounding; false for NaN. rounding: see index_rounding().
bool has_effect(double index, double rounding = kIndexRounding);

/// Whether the error is too small to tell: its index is rounding, and so would be an index of interest. rounding: see
/// index_rounding().
bool is_too_small_to_tell(double index, double rounding);

/// The index with rounding removed: the index itself if the error has an effect, 0 if it has none, NaN if the error is
/// too small to tell or the index is not known. rounding: see index_rounding().
double told_from_rounding(double index, double rounding);

}  // namespace poesy
