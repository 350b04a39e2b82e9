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

/// An error whose effect on the yield is found by linear limits.
struct MappedError {
  ErrorRange range;       ///< distribution of the error
  PolynomialScore score;  ///< of degree 2, for the nonlinear rest
};

/// The gradient of the yield by errors of any shape, with a linear map that predicts which machines are good. With G =
/// 1 for a good machine, H = 1 for one that the map predicts to be good, and t the size of an error,
///
///     dP(G)/dt = dP(H)/dt + d(P(G) - P(H))/dt
///
/// The first term is a mean over machines: the change of the probability that the error is in the machine's range in
/// which H = 1. It does not depend on whether a machine crosses the limit by chance. The second term is -E[(reject -
/// reject by the map) S] / t as in ScoreSums, but only of the few machines that are judged differently. So it has
/// little noise, and the part that the score leaves out is small. Both terms are as unbiased as the score, for any map:
/// a bad map adds noise.
class MappedGradient {
 public:
  /// errors: [P], none if the gradient by an error is not wanted.
  MappedGradient(LinearLimits limits, std::vector<std::optional<MappedError>> errors);

  /// Adds B machines. errors: [P x B], SI. rejected: [B] 1 or 0.
  void add(std::span<const double> errors, std::span<const std::uint8_t> rejected);

  std::uint64_t machines() const { return machines_; }    ///< The number of machines that were added.
  std::uint64_t misjudged() const { return misjudged_; }  ///< The number of these that the map judges wrongly.

  /// dY/dt by one error. The interval is skewed_mean() over the machines, with the second and third moments of four
  /// more machines that the map judges wrongly, with any error. Preconditions: the error is a MappedError; 0 <
  /// conf_level < 1.
  Estimate gradient(std::size_t error, double conf_level) const;
  /// The change of Y if t grows by the factor kErrorGrowth, with the interval and preconditions of gradient().
  Estimate change(std::size_t error, double conf_level) const;

 private:
  LinearLimits limits_;
  std::vector<std::optional<MappedError>> errors_;
  std::vector<double> reach_;  ///< [P]
  std::uint64_t machines_ = 0;
  std::uint64_t misjudged_ = 0;
  std::vector<PowerSums> slope_;   ///< [P] of t dY/dt
  std::vector<PowerSums> growth_;  ///< [P] of the change
};

}  // namespace poesy
