#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include "engine/random/smoothed_values.h"
#include "engine/study/plan.h"

/// How much each part that was measured weighs in the density of the errors of a machine: derivation in theory.md,
/// "What few parts leave open".
namespace poesy {

/// Errors that were measured on the same n parts: one error, or a block of k that are correlated. Row i of each error's
/// values is part i.
struct PartGroup {
  std::vector<std::size_t> errors;    ///< [k] positions among all errors
  std::vector<SmoothedValues> parts;  ///< [k] of each, all of n values
  /// [k x k] inverse of the correlation of their normal scores; empty for one error.
  std::vector<double> inverse;
  /// [k (k - 1) / 2 x n] by how much the weight of each part moves the correlation of each pair (1 0, 2 0, 2 1, ...)
  /// where that is taken from the parts; else empty.
  std::vector<double> moves = {};

  std::size_t size() const { return parts.front().values().size(); }  ///< n.
};

/// All such groups of a study.
struct PartGroups {
  /// False where a measured error is correlated with one that is not measured, or is measured on other parts.
  bool known = true;
  std::vector<PartGroup> each = {};  ///< an error is in one at the most
};

/// Those of a study; none where no error is measured.
PartGroups part_groups(const Plan& plan);

/// One error, or errors that go with each other. correlation: [k x k] of their normal scores; nothing is looked at for
/// one error. Precondition: all of the same number of values.
PartGroup part_group(std::vector<std::size_t> errors, std::vector<SmoothedValues> parts,
                     std::span<const double> correlation);

/// Adds the influence d ln f / dw_i of the weight of each of the n parts, w_i = 1/n, on the density f of the group's
/// errors: influence [n]. Sums to 0. x: [k] the errors of a machine, SI.
void add_influence(const PartGroup& group, std::span<const double> x, std::span<double> influence);

}  // namespace poesy
