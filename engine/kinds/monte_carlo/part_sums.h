#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "engine/base/archive.h"
#include "engine/kinds/monte_carlo/part_groups.h"
#include "engine/stats/moments.h"

namespace poesy {

/// Sums over the rejects of how much each part weighs in the probability p of a reject: with the density f of all
/// errors, made of parts of weight w_i = 1/n, dp/dw_i = E[1_reject d ln f / dw_i]. Looks at the rejects alone.
class PartSums {
 public:
  /// Of no machines. Refers to the groups.
  explicit PartSums(const PartGroups& groups);

  /// Adds machines. errors: along errors and machines, row-major, SI. rejected: of each machine 1 or 0.
  void add(std::span<const double> errors, std::span<const std::uint8_t> rejected);
  /// Adds what the other one added. Merging in the same order gives the same bits.
  void merge(const PartSums& later);

  /// Rejects of fewer machines, or good ones, do not say how much a part weighs.
  static constexpr std::uint64_t kLeast = 10;

  /// The interval of the yield that counts both that machines and that parts are few: Student's on the scale of normal
  /// scores. NaN at both ends below kLeast rejects or good machines, and where the groups are not known.
  /// Precondition: 0 < conf_level < 1.
  Interval interval(double conf_level) const;

  void state(Archive& archive);  ///< Every bit.

 private:
  const PartGroups* groups_;
  std::uint64_t machines_ = 0;
  std::uint64_t rejects_ = 0;
  std::vector<std::vector<double>> sums_;  ///< of each group, [n] of A
  std::vector<double> squares_;            ///< of each group, of the square of A over all parts
};

}  // namespace poesy
