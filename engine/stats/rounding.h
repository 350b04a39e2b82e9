#pragma once

/// What an index says where the effect of an error is no larger than the rounding of its solves. An index here is a
/// response's standard deviation over sigma, the error's; all numbers are SI.
namespace poesy {

/// Below this an index is rounding whatever the size of the error: digits that cancel leave some 1e-16 of it.
inline constexpr double kIndexRounding = 1e-10;

/// An index of this size or more would be of interest. An error with a smaller one may be a million times larger than
/// errors with an index of 1.
inline constexpr double kIndexOfInterest = 1e-6;

/// Below this an index is rounding: response_rounding / sigma, for solves round whatever the size of the error, but at
/// least kIndexRounding. response_rounding: as Model::rounding gives it.
double index_rounding(double response_rounding, double sigma);

/// Up to this the response to errors of this size, lengths and angles, is rounding: kIndexRounding times the larger one
/// of both, SI. NaN for a size that there is none of.
double size_rounding(double linear, double angular);

/// Whether an index is more than rounding. NaN is not. rounding: as index_rounding gives it.
bool has_effect(double index, double rounding = kIndexRounding);

/// Whether the error is too small to tell: it has no effect that is more than rounding, but would not even if its index
/// were of interest. rounding: likewise.
bool is_too_small_to_tell(double index, double rounding);

/// The index as far as it can be told from rounding: itself where the error has an effect, 0 where it has none, NaN
/// where the error is too small to tell, or the index not known. rounding: likewise.
double told_from_rounding(double index, double rounding);

}  // namespace poesy
