#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "engine/base/archive.h"
#include "engine/kinds/monte_carlo/part_groups.h"
#include "engine/stats/moments.h"

namespace poesy {

/// Sums the influence of each part's weight on the probability p of a reject. If the density f of all errors is made of
/// parts of weight w_i = 1/n, then dp/dw_i = E[1_reject d ln f / dw_i], so only rejects are added.
class PartSums {
 public:
  /// Empty sums. Refers to the groups.
  explicit PartSums(const PartGroups& groups);

  /// Adds machines. errors: [errors x machines], SI. rejected: [machines] 1 or 0.
  void add(std::span<const double> errors, std::span<const std::uint8_t> rejected);
  /// Adds the sums of later machines. Merging in the same order gives the same bits.
  void merge(const PartSums& later);

  /// With fewer rejects, or fewer good machines, the influence of a part is unknown.
  static constexpr std::uint64_t kLeast = 10;

  /// The interval of the yield that includes the uncertainty from few machines and from few parts: Student's on the
  /// scale of normal scores. NaN at both ends with fewer than kLeast rejects or good machines, and if the groups are
  /// not known. Precondition: 0 < conf_level < 1.
  Interval interval(double conf_level) const;

  void state(Archive& archive);  ///< Reads or writes every bit.

 private:
  const PartGroups* groups_;
  std::uint64_t machines_ = 0;
  std::uint64_t rejects_ = 0;
  std::vector<std::vector<double>> sums_;  ///< [groups] [n] sums of A
  std::vector<double> squares_;            ///< [groups] sum of A^2 over all parts
};

}  // namespace poesy
