#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "engine/base/bytes.h"
#include "engine/stats/error_scores.h"
#include "engine/stats/moments.h"

namespace poesy {

/// The gradient of the yield Y, the share of machines that are good, by the size t of each of P errors, from the run
/// that gives the yield and without a further solve: with the score S of an error (error_scores.h)
///
///     dY/dt = -E[1_reject S] / t
///
/// which is exact for normal errors, also cut off or correlated with each other, and for others if the yield, given the
/// error, is a polynomial of degree PolynomialScore::kDegree. NaN where the score is not known. Holds three sums for
/// each error, and looks at the rejects alone.
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

  /// [P] dY/dt, for each unit of the error (1/m, 1/rad). The interval is that of a mean over all machines, of which the
  /// good ones have the score 0, by the central limit theorem. Few rejects make that mean skewed, so the variance is
  /// taken at the end in question (variance + skewness (end - mean), as in Wilson's interval for a share), and
  /// Student's quantile is that for the number of rejects: of 95 % intervals, 93 to 95 % held the gradient of a sum of
  /// normal errors from nine rejects on, and 90 % with five (THEORY.md). The scores of errors of other shapes and of
  /// correlated ones spread more, so their second and third moments are taken with four rejects in addition, with any
  /// error. The interval does not cover what a PolynomialScore leaves out. NaN for errors without a score; NaN at both
  /// ends below two rejects. Precondition: 0 < conf_level < 1.
  std::vector<Estimate> gradient(double conf_level) const;

  /// Every bit of the sums, and back.
  void write(ByteWriter& to) const;
  /// The same for these errors. Throws BytesError for what no machines give.
  static ScoreSums read(ByteReader& from, const ErrorScores& scores);

 private:
  /// Of the score of one error, over all machines; that of the good ones is 0.
  Estimate mean_score(std::size_t error, double conf_level) const;
  /// Adds the errors of a block.
  void add_block(const NormalBlock& block, std::span<const double> errors, std::size_t count,
                 std::span<const std::size_t> rejects);

  ErrorScores scores_;
  std::uint64_t machines_ = 0;
  std::uint64_t rejects_ = 0;
  std::vector<double> sums_;     ///< [P] of S over the rejects, without what ends of a normal add
  std::vector<double> squares_;  ///< [P] of its square
  std::vector<double> cubes_;    ///< [P] of its cube
};

}  // namespace poesy
