#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "engine/base/archive.h"
#include "engine/stats/error_scores.h"
#include "engine/stats/moments.h"

namespace poesy {

/// Sums of the powers of one number over machines; of most machines it is 0.
struct PowerSums {
  double sum = 0.0;     ///< of the number
  double square = 0.0;  ///< of its square
  double cube = 0.0;    ///< of its cube

  void add(double value) {  ///< One machine's.
    sum += value;
    square += value * value;
    cube += value * value * value;
  }
  /// Both together.
  PowerSums& operator+=(const PowerSums& other) {
    sum += other.sum;
    square += other.square;
    cube += other.cube;
    return *this;
  }
};

/// So many rejects, with any error, are added where the spread of a score is estimated, because few rejects need not
/// have had its largest values (as Agresti and Coull 1998, Am. Stat. 52, 119-126, add two of each kind for a share).
inline constexpr double kAddedRejects = 4.0;

/// With fewer rejects an interval holds the gradient less often than it says (theory.md).
inline constexpr std::uint64_t kFewRejects = 20;

/// The mean of a number over n machines, of which `powers` has the sums, with an interval at this level by the central
/// limit theorem: the mean of a skewed number is skewed, so the variance is taken at the end in question (variance +
/// skewness (end - mean), as in Wilson's interval for a share), and Student's quantile is that for `freedom` degrees.
/// added: to the mean powers. NaN at both ends where freedom < 1.
Estimate skewed_mean(const PowerSums& powers, std::uint64_t machines, const ScoreMoments& added, double freedom,
                     double conf_level);

/// The gradient of the yield Y, the share of machines that are good, by the size t of each of P errors, from the run
/// that gives the yield and without a further solve: with the score S of an error (error_scores.h)
///
///     dY/dt = -E[1_reject S] / t
///
/// which is exact for normal errors, also cut off or correlated with each other, and for others if the yield, given the
/// error, is a polynomial of degree PolynomialScore::kDegree. NaN where the score is not known. With the growth score
/// it is what the yield changes by while t grows by the factor kErrorGrowth. Holds twelve sums for each error, and
/// looks at the rejects alone.
class ScoreSums {
 public:
  explicit ScoreSums(ErrorScores scores);  ///< Of no machines. [P] errors.

  /// Adds B machines. errors: [P x B], SI, row-major as SampleBlock::values are. rejected: [B] 1 or 0, as
  /// MachineBlock::rejected gives it. Precondition: the errors are finite.
  void add(std::span<const double> errors, std::span<const std::uint8_t> rejected);
  /// Adds what the other one added. Merging in the same order gives the same bits. Precondition: the same errors.
  void merge(const ScoreSums& other);

  std::uint64_t machines() const { return machines_; }  ///< That were added.
  std::uint64_t rejects() const { return rejects_; }    ///< Of these.

  /// [P] dY/dt, for each unit of the error (1/m, 1/rad). The interval is skewed_mean() over all machines, of which the
  /// good ones have the score 0, with Student's quantile for the number of rejects: of 95 % intervals, 93 to 95 % held
  /// the gradient of a sum of normal errors from nine rejects on, and 90 % with five (theory.md). The scores of errors
  /// of other shapes and of correlated ones spread more, so their second and third moments are taken with four rejects
  /// in addition, with any error. The interval does not cover what a PolynomialScore leaves out; where that is much,
  /// because one error alone makes the rejects, the gradient by that error is NaN: its score up to degree 2 then has
  /// less than half of the mean of S, or more than twice that, by Student's test at 99 %. NaN for errors without a
  /// score; NaN at both ends below two rejects. Precondition: 0 < conf_level < 1.
  std::vector<Estimate> gradient(double conf_level) const;

  /// [P] what Y changes by while the size of the error grows by the factor kErrorGrowth, the others as they are:
  /// between -Y and 1 - Y. As gradient() in all else.
  std::vector<Estimate> change(double conf_level) const;

  void state(Archive& archive);  ///< Every bit of the sums.

 private:
  /// Of the score of one error, over all machines; that of the good ones is 0.
  Estimate mean_score(std::size_t error, double conf_level) const;
  Estimate mean_growth(std::size_t error, double conf_level) const;
  /// Whether the error alone makes the rejects, so that its PolynomialScore leaves out much.
  bool dominates(std::size_t error, const Estimate& score) const;
  /// Adds the errors of a block.
  void add_block(const NormalBlock& block, std::span<const double> errors, std::size_t count,
                 std::span<const std::size_t> rejects);

  ErrorScores scores_;
  std::uint64_t machines_ = 0;
  std::uint64_t rejects_ = 0;
  std::vector<PowerSums> slope_;   ///< [P] of S over the rejects, without what ends of a normal add
  std::vector<PowerSums> growth_;  ///< [P] of the growth score; 0 for errors of a block, where S says it
  std::vector<PowerSums> less_;    ///< [P] of the part of a PolynomialScore up to degree 2, less half of S
  std::vector<PowerSums> more_;    ///< [P] of 2 S less that part
};

/// An estimate and its ends kept within these bounds.
Estimate within(const Estimate& estimate, double least, double most);

}  // namespace poesy
