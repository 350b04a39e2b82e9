#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "engine/base/archive.h"
#include "engine/stats/error_scores.h"
#include "engine/stats/moments.h"

namespace poesy {

/// Sums of the powers of a number over machines; for most machines the number is 0.
struct PowerSums {
  double sum = 0.0;     ///< sum of the number
  double square = 0.0;  ///< sum of the square of the number
  double cube = 0.0;    ///< sum of the cube of the number

  void add(double value) {  ///< Adds the number of one machine.
    sum += value;
    square += value * value;
    cube += value * value * value;
  }
  /// Adds the sums over other machines.
  PowerSums& operator+=(const PowerSums& other) {
    sum += other.sum;
    square += other.square;
    cube += other.cube;
    return *this;
  }
};

/// The number of assumed rejects that are added when the spread of a score is estimated. Their scores have the moments
/// of the scores of all machines. A few rejects may not include the largest values of the score (Agresti and Coull
/// 1998, Am. Stat. 52, 119-126, add two successes and two failures for a share).
inline constexpr double kAddedRejects = 4.0;

/// With fewer rejects than this, the coverage of an interval of the gradient may be below its level (theory.md).
inline constexpr std::uint64_t kFewRejects = 20;

/// The mean of a number over n machines, from the sums `powers`, with an interval at this level by the central limit
/// theorem. The mean of a skewed number is skewed, so each end of the interval has its own variance (variance + (end -
/// mean) m3 / variance with the third central moment m3, as in Wilson's interval for a share). The quantile is
/// Student's with `freedom` degrees of freedom. added: terms added to the means of the number's square and cube. NaN at
/// both ends if freedom < 1.
Estimate skewed_mean(const PowerSums& powers, std::uint64_t machines, const ScoreMoments& added, double freedom,
                     double conf_level);

/// The gradient of the yield Y, the share of good machines, by the size t of each error. The gradient comes from the
/// run that gives the yield, without a further solve. With the score S of an error (error_scores.h),
///
///     dY/dt = -E[1_reject S] / t
///
/// This is exact for normal errors, also truncated or correlated ones. For other errors it is exact if the yield as a
/// function of the error is a polynomial of degree PolynomialScore::kDegree. NaN if the score is not known. The growth
/// score gives the change of the yield if t grows by the factor kErrorGrowth. Stores twelve sums for each error and
/// uses only the rejects.
class ScoreSums {
 public:
  explicit ScoreSums(ErrorScores scores);  ///< Empty sums for the errors of `scores`.

  /// Adds machines. errors: [errors x machines], SI, row-major as SampleBlock::values, finite. rejected: [machines] 1
  /// or 0, see MachineBlock::rejected().
  void add(std::span<const double> errors, std::span<const std::uint8_t> rejected);
  /// Adds the sums of later machines. Merging in the same order gives the same bits. Precondition: the same errors.
  void merge(const ScoreSums& other);

  std::uint64_t machines() const { return machines_; }  ///< The number of machines that were added.
  std::uint64_t rejects() const { return rejects_; }    ///< The number of rejects among these machines.

  /// [errors] dY/dt, per unit of the error (1/m, 1/rad). The interval is skewed_mean() over all machines, where good
  /// ones have the score 0, with Student's quantile for the number of rejects. Of 95 % intervals, 93 to 95 % contained
  /// the gradient of a sum of normal errors with nine or more rejects, and 90 % with five (theory.md). Scores of
  /// correlated errors and of other distributions spread more, so their second and third moments include four more
  /// rejects (kAddedRejects). The interval does not include what a PolynomialScore leaves out. That part is large if
  /// one error alone causes the rejects; the gradient by that error is then NaN. The criterion, by Student's test at 99
  /// %, is that the mean of the score up to degree 2 is less than half or more than twice the mean of the whole score.
  /// NaN for errors without a score; NaN at both ends below two rejects. Precondition: 0 < conf_level < 1.
  std::vector<Estimate> gradient(double conf_level) const;

  /// [errors] The change of Y, between -Y and 1 - Y, if the size of the error grows by the factor kErrorGrowth and the
  /// others stay as they are. The intervals and the cases with NaN are those of gradient().
  std::vector<Estimate> change(double conf_level) const;

  /// [errors] The standard deviation that change() would have by chance if the error had no effect. Such an error is
  /// drawn among the rejects as among all machines. NaN for errors without a score.
  std::vector<double> change_sd_without_effect() const;

  void state(Archive& archive);  ///< Reads or writes the sums, bit for bit.

 private:
  /// The mean score of one error over all machines; good machines have the score 0.
  Estimate mean_score(std::size_t error, double conf_level) const;
  Estimate mean_growth(std::size_t error, double conf_level) const;
  /// Returns true if this error alone causes the rejects, so that its PolynomialScore leaves out a large part.
  bool dominates(std::size_t error, const Estimate& score) const;
  /// Adds to the sums the scores of a block of correlated errors for the rejected machines. errors: as in add(). count:
  /// number of machines. rejects: indices of the rejected machines.
  void add_block(const NormalBlock& block, std::span<const double> errors, std::size_t count,
                 std::span<const std::size_t> rejects);

  ErrorScores scores_;
  std::uint64_t machines_ = 0;
  std::uint64_t rejects_ = 0;
  /// [errors] Sums of the score S over the rejects. For a NormalScore they are sums of z^2 - 1; mean_score() adds the
  /// constant term NormalScore::ends() of a truncated normal.
  std::vector<PowerSums> slope_;
  std::vector<PowerSums> growth_;  ///< [errors] sums of the growth score over the rejects; 0 for errors of a block,
                                   ///< because growth scores in a block are computed from slope_ (growth_moments())
  std::vector<PowerSums> less_;    ///< [errors] sums of parabola() - S / 2 of a PolynomialScore S over the rejects
  std::vector<PowerSums> more_;    ///< [errors] sums of 2 S - parabola() of a PolynomialScore S over the rejects
};

/// The estimate and the ends of its interval, each limited to the range from `least` to `most`.
Estimate within(const Estimate& estimate, double least, double most);

}  // namespace poesy
