#pragma once

#include <span>

#include "engine/base/archive.h"
#include "engine/stats/moments.h"

namespace poesy {

/// Sensitivity index at one pose: sigma(response) / sigma(error) (Du et al. 2022, Eqs. 51-52), the response's sample
/// standard deviation over the standard deviation that the study sets for the error. Interval: Bonett 2006, Comput.
/// Stat. Data Anal. 50, 775-782, on the logarithm of the variance, with the plain sample kurtosis. Zero spread gives
/// the interval [0, 0]; fewer than five samples give NaN at both ends.
Estimate local_index(const Moments& response, double error_sigma, double conf_level);

/// The local index at one pose, from which a global index is computed.
struct LocalIndex {
  double value;           ///< index (Du et al. 2022, Eqs. 51-52)
  double standard_error;  ///< standard error of the value, from sampling

  void state(Archive& archive) { archive.real(value, standard_error); }  ///< Reads or writes both members.
};

/// The local index with its standard error, which is the index times the standard error of its logarithm (Bonett 2006).
/// The standard error is NaN below five samples, and 0 for zero spread.
LocalIndex local_index_with_error(const Moments& response, double error_sigma);

/// The value of global_index(): mean over the poses plus sample standard deviation over the poses (Du et al. 2022, Eqs.
/// 53-54). NaN without a pose.
double published_index(std::span<const LocalIndex> poses);

/// The global index: mean over the poses plus sample standard deviation over the poses (Du et al. 2022, Eqs. 53-54);
/// NaN if a pose has no index, the mean alone for a single pose.
///
/// The interval is for the value that infinitely many samples would give at the same poses. The estimate counts
/// sampling noise as spread between poses; the interval subtracts this noise. So if the poses differ by little more
/// than noise, the estimate is near or above the upper end of its interval. The interval is extended to contain the
/// estimate. With more samples the difference disappears. Mean and spread are combined, with their correlation, by the
/// method of variance estimates recovery (Zou and Donner 2008, Stat. Med. 27, 1693-1702). If the spread is no more than
/// noise at this level (chi-square with Satterthwaite's degrees of freedom), the lower limit is that of the mean alone,
/// and the coverage may be higher than the level. If poses differ clearly, the coverage is the level. Indices that are
/// all zero give [0, 0]; a pose without a standard error gives NaN at both ends.
Estimate global_index(std::span<const LocalIndex> poses, double conf_level);

/// The global index without sampling noise: the mean plus the spread of the indices over the poses. Each index is
/// corrected for the bias of a sample standard deviation, and the part of the spread that comes from noise is
/// subtracted. The value lies within its interval, which is that of global_index() before its extension. If a pose has
/// no standard error, the noise is unknown: the value is that of global_index(), and both ends are NaN.
Estimate corrected_global_index(std::span<const LocalIndex> poses, double conf_level);

/// An index counts as valid for all sizes of its error if it changes by at most this share when the size is divided by
/// ten.
inline constexpr double kIndexHolds = 0.02;

/// Returns true if an index is known to change with the size of its error. change: (index at a tenth of the size) /
/// index - 1; NaN if not known.
bool changes_with_size(double change);

// The following functions tell indices from rounding. If an effect is no larger than the rounding errors of solves, its
// index has no meaning. Here an index is the standard deviation of a response divided by sigma, the standard deviation
// of the error. All numbers are SI.

/// An index below this is only rounding, whatever the size of the error: if an error has no effect, cancelling digits
/// leave about 1e-16 of the error in the response.
inline constexpr double kIndexRounding = 1e-10;

/// The least index that is of interest. An error with a smaller index may be a million times larger than an error with
/// an index of 1, and still have a smaller effect.
inline constexpr double kIndexOfInterest = 1e-6;

/// The magnitude below which an index is rounding: response_rounding / sigma, because the rounding of solves does not
/// depend on the size of the error, but at least kIndexRounding. response_rounding: see Model::rounding().
double index_rounding(double response_rounding, double sigma);

/// The magnitude up to which a response to errors is rounding: response_rounding, but at least kIndexRounding times the
/// larger of the two sizes. linear, angular: the sizes of the length errors (m) and angle errors (rad); NaN if there
/// are none. SI.
double size_rounding(double response_rounding, double linear, double angular);

/// While several errors vary together, a response counts as constant if its standard deviation is below this value,
/// because rounding alone may cause it. The value is the root of the sum of (index_rounding() sigma)^2 over the errors,
/// because independent effects add in this way. So if every error alone has no effect on a response, all errors
/// together count as having none. sigma: [errors]. All numbers are SI.
double joint_rounding(double response_rounding, std::span<const double> sigma);

/// Returns true if a response does not vary: none of its standard deviations (for instance at several poses) is more
/// than rounding, and at least one is not NaN. Check this before computing shares of its variance. rounding: see
/// joint_rounding().
bool is_constant(std::span<const double> deviations, double rounding);

/// Returns true if an index is more than rounding; false for NaN. rounding: see index_rounding().
bool has_effect(double index, double rounding = kIndexRounding);

/// Returns true if an error is too small to decide whether it has an effect: its index is rounding, and even an index
/// of kIndexOfInterest would be. rounding: see index_rounding().
bool is_too_small_to_tell(double index, double rounding);

/// The index with rounding removed: the index itself if the error has an effect, 0 if it has none, NaN if the error is
/// too small to decide this or the index is not known. rounding: see index_rounding().
double told_from_rounding(double index, double rounding);

}  // namespace poesy
