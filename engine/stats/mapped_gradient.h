#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "engine/stats/error_scores.h"
#include "engine/stats/linear_limits.h"
#include "engine/stats/yield_gradient.h"

namespace poesy {

/// An error for which MappedGradient finds the gradient of the yield.
struct MappedError {
  ErrorRange range;       ///< distribution of the error
  PolynomialScore score;  ///< score of degree 2, used for machines that the linear map judges wrongly
};

/// The gradient of the yield by the sizes of errors of any distribution. A linear map from the errors to the limited
/// vectors (LinearLimits) predicts which machines are good. With G = 1 for a good machine, H = 1 for a machine that the
/// map predicts to be good, and t the size of an error,
///
///     dP(G)/dt = dP(H)/dt + d(P(G) - P(H))/dt
///
/// The first term is a mean over machines: the change of the probability that the error is in the machine's range in
/// which H = 1. This mean has little noise, because every machine contributes a probability instead of 0 or 1. The
/// second term is -E[(reject - reject by the map) S] / t with the score S, as in ScoreSums. Only the few machines that
/// the map misjudges contribute, so this term has little noise too, and the part that the score leaves out is small.
/// Whatever the map, the bias is at most that of the score; a bad map only adds noise.
class MappedGradient {
 public:
  /// errors: [errors], std::nullopt for an error whose gradient is not wanted.
  MappedGradient(LinearLimits limits, std::vector<std::optional<MappedError>> errors);

  /// Adds machines. errors: [errors x machines], SI. rejected: [machines] 1 or 0.
  void add(std::span<const double> errors, std::span<const std::uint8_t> rejected);

  std::uint64_t machines() const { return machines_; }  ///< The number of machines that were added.
  /// The number of machines for which the linear map (LinearLimits) predicts the wrong verdict.
  std::uint64_t misjudged() const { return misjudged_; }

  /// dY/dt, the derivative of the yield Y by the size t of one error. The interval is that of skewed_mean() over the
  /// machines. To the second moment that skewed_mean() uses, four assumed machines are added that the map misjudges
  /// (kAddedRejects), each with the mean square of the score over all machines. Preconditions: the error is a
  /// MappedError; 0 < conf_level < 1.
  Estimate gradient(std::size_t error, double conf_level) const;
  /// The change of the yield if the size t of one error grows by the factor kErrorGrowth, with the interval and
  /// preconditions of gradient().
  Estimate change(std::size_t error, double conf_level) const;

 private:
  LinearLimits limits_;
  std::vector<std::optional<MappedError>> errors_;
  std::vector<double> reach_;  ///< [errors] largest change of each error, see LinearLimits::machines()
  std::uint64_t machines_ = 0;
  std::uint64_t misjudged_ = 0;
  std::vector<PowerSums> slope_;   ///< [errors] sums for t dY/dt, with the yield Y and the size t of the error
  std::vector<PowerSums> growth_;  ///< [errors] sums for the change of the yield if the error grows
};

}  // namespace poesy
