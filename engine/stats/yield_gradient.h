#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "engine/base/bytes.h"
#include "engine/stats/moments.h"

namespace poesy {

/// The size of an error, as Distribution::sigma() and half_width() have it.
struct ErrorScale {
  double sigma;       ///< t, of the normal before it is cut off; 0 for distributions that are not made of a normal
  double half_width;  ///< w, the largest possible error; infinite for the normal
};

/// The gradient of the yield Y, the share of machines that are good, by the sigma t of each of P errors, from the run
/// that gives the yield and without a further solve (likelihood ratio method; Rubinstein 1986, Math. Comput. Simul. 28,
/// 365-379): for an error e = t z
///
///     dY/dt = -E[1_reject (z^2 - 1)] / t                                            z normal
///     dY/dt = -E[1_reject (z^2 - 1 + (2 w/t) phi(w/t) / (2 Phi(w/t) - 1))] / t      cut off at a fixed +-w
///
/// Uniform and triangular errors have no such score, because the ends of their range move with their size: NaN.
/// Holds three sums for each error, and looks at the rejects alone.
class ScoreSums {
 public:
  explicit ScoreSums(std::span<const ErrorScale> errors);  ///< [P]

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
  /// Student's quantile is that for the number of rejects: of 95 % intervals, 94 to 95 % held the gradient of a sum of
  /// normal errors from nine rejects on, and 90 % with five (THEORY.md). NaN for errors without a score; NaN at both
  /// ends below two rejects. Precondition: 0 < conf_level < 1.
  std::vector<Estimate> gradient(double conf_level) const;

  /// Every bit of the sums, and back.
  void write(ByteWriter& to) const;
  /// The same for these errors [P]. Throws BytesError for what no machines give.
  static ScoreSums read(ByteReader& from, std::span<const ErrorScale> errors);

 private:
  /// Of the score of one error, over all machines; that of the good ones is 0.
  Estimate mean_score(std::size_t error, double conf_level) const;

  std::vector<ErrorScale> errors_;  ///< [P]
  std::uint64_t machines_ = 0;
  std::uint64_t rejects_ = 0;
  std::vector<double> sums_;     ///< [P] of z^2 - 1 over the rejects
  std::vector<double> squares_;  ///< [P] of its square
  std::vector<double> cubes_;    ///< [P] of its cube
};

}  // namespace poesy
