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

/// An error whose part in the yield is told by way of linear limits.
struct MappedError {
  ErrorRange range;       ///< its values
  PolynomialScore score;  ///< of degree 2, for what is not linear
};

/// The gradient of the yield by errors of any shape, with the help of a map that tells to first order which machines
/// are good. With G = 1 for a good machine, H = 1 for one that is good by the map, and t the size of an error,
///
///     dP(G)/dt = dP(H)/dt + d(P(G) - P(H))/dt
///
/// The first term is a mean over machines of what the probability that the error is in the machine's own range, in
/// which H = 1, changes by: no machine is counted that crosses the limit by chance. The second one is -E[(reject -
/// reject by the map) S] / t as ScoreSums has it, but of the few machines that both judge differently, so it hardly has
/// noise, and what the score leaves out is a part of little. Both are unbiased as far as the score is, whatever the map
/// is: a bad map costs noise.
class MappedGradient {
 public:
  /// errors: [P], none where the gradient by an error is not wanted.
  MappedGradient(LinearLimits limits, std::vector<std::optional<MappedError>> errors);

  /// Adds B machines. errors: [P x B], SI. rejected: [B] 1 or 0.
  void add(std::span<const double> errors, std::span<const std::uint8_t> rejected);

  std::uint64_t machines() const { return machines_; }    ///< That were added.
  std::uint64_t misjudged() const { return misjudged_; }  ///< Of these, those of which the map says something else.

  /// dY/dt by one error. The interval is skewed_mean() over the machines, with the second and third moments of four
  /// machines in addition that the map judges wrongly, with any error. Preconditions: it is a MappedError; 0 <
  /// conf_level < 1.
  Estimate gradient(std::size_t error, double conf_level) const;
  /// What Y changes by while t grows by the factor kErrorGrowth. Likewise.
  Estimate change(std::size_t error, double conf_level) const;

 private:
  LinearLimits limits_;
  std::vector<std::optional<MappedError>> errors_;
  std::vector<double> reach_;  ///< [P]
  std::uint64_t machines_ = 0;
  std::uint64_t misjudged_ = 0;
  std::vector<PowerSums> slope_;   ///< [P] of t dY/dt
  std::vector<PowerSums> growth_;  ///< [P]
};

}  // namespace poesy
