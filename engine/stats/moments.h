#pragma once

#include <cstdint>
#include <span>

#include "engine/base/archive.h"

namespace poesy {

/// A confidence interval; NaN at both ends if there are too few samples.
struct Interval {
  double low;   ///< lower end
  double high;  ///< upper end
};

/// An estimate with its interval.
struct Estimate {
  double value;       ///< the estimate
  Interval interval;  ///< confidence interval of the value
};

/// Count, mean and central moments up to the fourth of a stream of numbers, computed in one pass. Moments of several
/// streams can be merged (Welford; Chan et al. 1983; Pebay 2008, Sandia report SAND2008-6212, Eqs. 1.1-1.7, 2.1-2.4).
class Moments {
 public:
  void add(double value);  ///< Adds a value. The order of values changes only rounding errors.
  /// The moments of numbers in memory, computed in two passes, which is faster than adding them one by one.
  static Moments of(std::span<const double> values);
  /// Adds the moments of a later stream. Merging in the same order gives the same bits.
  void merge(const Moments& other);

  std::uint64_t count() const { return count_; }  ///< The number of values.
  double mean() const { return mean_; }           ///< The mean; 0 when empty.
  double variance() const;                        ///< The sample variance, divided by count - 1; NaN below two values.
  double standard_deviation() const;              ///< The square root of the sample variance; NaN below two values.
  /// The skewness m3 / m2^(3/2) with the central moments m2 and m3 of the sample; 0 for a symmetric sample. NaN if the
  /// variance is zero or undefined.
  double skewness() const;
  /// The kurtosis m4 / m2^2 with the central moments m2 and m4 of the sample; 3 for a normal. NaN if the variance is
  /// zero or undefined.
  double kurtosis() const;

  void state(Archive& archive);  ///< Reads or writes all members, bit for bit.

 private:
  std::uint64_t count_ = 0;
  double mean_ = 0.0;
  double m2_ = 0.0;  ///< sum of (x - mean)^2
  double m3_ = 0.0;  ///< sum of (x - mean)^3
  double m4_ = 0.0;  ///< sum of (x - mean)^4
};

/// The mean square of `count` values with this mean and sample standard deviation; NaN if one of these is NaN.
double sample_mean_square(double mean, double standard_deviation, double count);

/// The root mean square of `count` values with this mean and sample standard deviation; NaN without values.
double root_mean_square(double mean, double standard_deviation, std::uint64_t count);
/// The root mean square of these values; NaN without values.
double root_mean_square(std::span<const double> values);

/// The z for which a standard normal is within +-z with the probability conf_level: 1.96 for 0.95. Precondition: 0 <
/// conf_level < 1.
double two_sided_normal_quantile(double conf_level);
/// The t for which Student's distribution with these degrees of freedom is within +-t with the probability conf_level.
/// Preconditions: freedom > 0, 0 < conf_level < 1.
double two_sided_student_quantile(double freedom, double conf_level);

/// Student's interval for a mean: mean +- t(n - 1) s / sqrt(n). NaN at both ends below two samples.
/// Precondition: 0 < conf_level < 1.
Interval mean_interval(const Moments& moments, double conf_level);

/// Computes mean_interval() of many moments. Student's quantile, which takes most of the time, is reused while the
/// number of samples stays the same.
class MeanIntervals {
 public:
  explicit MeanIntervals(double conf_level) : conf_level_(conf_level) {}  ///< Precondition: 0 < conf_level < 1.
  Interval of(const Moments& moments);  ///< The interval of mean_interval(), with the same bits.

 private:
  double conf_level_;
  std::uint64_t count_ = 0;  ///< number of samples for which quantile_ was computed
  double quantile_ = 0.0;
};

/// Statistics of samples in several groups.
struct Groups {
  std::span<const std::uint64_t> count;  ///< [groups] number of samples in each group
  std::span<const double> mean;          ///< [groups] mean of the samples
  std::span<const double> std;           ///< [groups] sample standard deviation
};

/// The mean of all samples of all groups together. The interval is that of stratified sampling, where the groups are
/// fixed and only the samples in them are random (Cochran 1977, Sampling Techniques, Eqs. 5.7 and 5.16). The variance
/// is the sum of n_m s_m^2 / N^2 over the groups, with n_m samples of standard deviation s_m in group m, and N samples
/// in all groups. Student's quantile has Satterthwaite's degrees of freedom. For one group the interval is
/// mean_interval(). Groups without a sample are left out; a group of a single sample gives NaN at both ends.
/// Precondition: 0 < conf_level < 1.
Estimate stratified_mean(const Groups& groups, double conf_level);

}  // namespace poesy
