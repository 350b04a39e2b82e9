#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include "engine/random/smoothed_values.h"
#include "engine/study/plan.h"

/// The weight of each measured part in the density of a machine's errors. Derivation: theory.md, "What few parts leave
/// open".
namespace poesy {

/// Errors that were measured on the same n parts: one error, or a block of k correlated errors. Row i of each error's
/// values belongs to part i.
struct PartGroup {
  std::vector<std::size_t> errors;    ///< [k] positions among all errors
  std::vector<SmoothedValues> parts;  ///< [k] the values of each error, n each
  /// [k x k] Inverse of the correlation matrix of their normal scores; empty for one error.
  std::vector<double> inverse;
  /// [k (k - 1) / 2 x n] Derivatives of the correlation of each pair (1 0, 2 0, 2 1, ...) by the weight of each part,
  /// if the correlation is computed from the parts; else empty.
  std::vector<double> moves = {};

  std::size_t size() const { return parts.front().values().size(); }  ///< The number of parts, n.
};

/// All such groups of a study.
struct PartGroups {
  /// False if a measured error is correlated with one that is not measured, or that is measured on other parts.
  bool known = true;
  std::vector<PartGroup> each = {};  ///< no error is in two of them
};

/// The groups of a study; none if no error is measured.
PartGroups part_groups(const Plan& plan);

/// A group of one error, or of correlated errors. correlation: [k x k] of their normal scores; unused for one error.
/// Precondition: all errors have the same number of values.
PartGroup part_group(std::vector<std::size_t> errors, std::vector<SmoothedValues> parts,
                     std::span<const double> correlation);

/// Adds the influence d ln f / dw_i of the weight of each of the n parts, w_i = 1/n, on the density f of the group's
/// errors. influence: [n], sums to 0. x: [k] the errors of a machine, SI.
void add_influence(const PartGroup& group, std::span<const double> x, std::span<double> influence);

}  // namespace poesy
