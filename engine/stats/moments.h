#pragma once

#include <cstdint>
#include <span>

#include "engine/base/archive.h"

namespace poesy {

/// A confidence interval; NaN at both ends where there are too few samples.
struct Interval {
  double low;   ///< lower end
  double high;  ///< upper end
};

/// An estimate with its interval.
struct Estimate {
  double value;       ///< what is estimated
  Interval interval;  ///< of the value, at the level that was asked for
};

/// Count, mean and central moments to fourth order of a stream of numbers, in one pass and mergeable
/// (Welford; Chan et al. 1983; Pebay 2008, Sandia report SAND2008-6212, Eqs. 1.1-1.7, 2.1-2.4).
class Moments {
 public:
  void add(double value);  ///< The order changes rounding only.
  /// The moments of a block of numbers that is in memory: twice over it, faster than adding them one by one.
  static Moments of(std::span<const double> values);
  /// The moments of both streams together. Merging in the same order gives the same bits.
  void merge(const Moments& other);

  std::uint64_t count() const { return count_; }  ///< Values.
  double mean() const { return mean_; }           ///< 0 when empty.
  double variance() const;                        ///< Sample variance, divided by count - 1; NaN below two values.
  double standard_deviation() const;              ///< Of the sample (n - 1); NaN with fewer than two values.
  /// Skewness m3 / m2^(3/2) of the sample (0 for what is symmetric); NaN when the variance is zero or undefined.
  double skewness() const;
  /// Kurtosis m4 / m2^2 of the sample (3 for a normal); NaN when the variance is zero or undefined.
  double kurtosis() const;

  void state(Archive& archive);  ///< Every bit of it.

 private:
  std::uint64_t count_ = 0;
  double mean_ = 0.0;
  double m2_ = 0.0;  ///< sum of (x - mean)^2
  double m3_ = 0.0;  ///< sum of (x - mean)^3
  double m4_ = 0.0;  ///< sum of (x - mean)^4
};

/// The mean square of `count` values with this mean and sample standard deviation; NaN where that is.
double sample_mean_square(double mean, double standard_deviation, double count);

/// The root mean square of `count` values with this mean and sample standard deviation; NaN without values.
double root_mean_square(double mean, double standard_deviation, std::uint64_t count);

/// What a standard error with so many degrees of freedom is multiplied by on either side of a two-sided interval
/// (Student's t). Preconditions: freedom > 0, 0 < conf_level < 1.
double student_quantile(double freedom, double conf_level);

/// The z for which a standard normal lies within +-z with this probability: 1.96 for 0.95.
/// Precondition: 0 < conf_level < 1.
double two_sided_normal_quantile(double conf_level);
/// The same of Student's distribution. Precondition: freedom > 0, degrees of freedom.
double two_sided_student_quantile(double freedom, double conf_level);

/// Student's interval for a mean: mean +- t(n - 1) s / sqrt(n). NaN at both ends below two samples.
/// Precondition: 0 < conf_level < 1.
Interval mean_interval(const Moments& moments, double conf_level);

/// mean_interval() of many: Student's quantile, which takes most of its time, is worked out once for samples of the
/// same number one behind the other.
class MeanIntervals {
 public:
  explicit MeanIntervals(double conf_level) : conf_level_(conf_level) {}  ///< Precondition: 0 < conf_level < 1.
  Interval of(const Moments& moments);                                    ///< The same bits as mean_interval().

 private:
  double conf_level_;
  std::uint64_t count_ = 0;  ///< samples of which quantile_ is
  double quantile_ = 0.0;
};

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
