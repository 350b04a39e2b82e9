#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "engine/base/archive.h"
#include "engine/kinds/monte_carlo/part_groups.h"
#include "engine/stats/moments.h"

namespace poesy::monte_carlo {

/// Sums for the derivative of the probability p that a machine is rejected with respect to the weight of each measured
/// part. Let f be the density of all errors, in which part i of n has the weight w_i = 1/n. Then
///
///     dp/dw_i = E[1_reject d ln f / dw_i]
///
/// where 1_reject is 1 for a rejected machine and 0 for a good one. So only rejected machines are added.
class PartSums {
 public:
  /// Empty sums. Keeps a reference to the groups.
  explicit PartSums(const PartGroups& groups);

  /// Adds machines. errors: [errors x machines], SI. rejected: [machines] 1 if rejected, otherwise 0.
  void add(std::span<const double> errors, std::span<const std::uint8_t> rejected);
  /// Adds the sums of later machines. Merging in the same order gives the same bits.
  void merge(const PartSums& later);

  /// The smallest number of rejects, and of good machines, from which the influence of parts is estimated.
  static constexpr std::uint64_t kLeast = 10;

  /// The confidence interval of the yield, which includes the uncertainty from few machines and from few parts:
  /// Student's interval of the normal quantile at the yield, converted back to shares. Both ends are NaN with fewer
  /// than kLeast rejects or good machines, or if the influence of parts cannot be computed (PartGroups::known).
  /// Precondition: 0 < conf_level < 1.
  Interval interval(double conf_level) const;

  void state(Archive& archive);  ///< Reads or writes the sums, bit for bit.

 private:
  const PartGroups* groups_;
  std::uint64_t machines_ = 0;
  std::uint64_t rejects_ = 0;
  std::vector<std::vector<double>> sums_;  ///< [groups][parts] sum of each part's influence over rejected machines
  std::vector<double> squares_;            ///< [groups] sum of squared influences over parts and rejected machines
};

}  // namespace poesy::monte_carlo
