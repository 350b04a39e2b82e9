#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include "engine/random/smoothed_values.h"
#include "engine/study/plan.h"

/// How the density of a machine's errors depends on the weight of each measured part in their distribution. Derivation:
/// theory.md, "Uncertainty from few parts".
namespace poesy::monte_carlo {

/// Errors that were measured on the same n parts: a single error, or a block of k correlated errors. Value i of each
/// error belongs to part i.
struct PartGroup {
  std::vector<std::size_t> errors;    ///< [errors] positions of the errors among all errors
  std::vector<SmoothedValues> parts;  ///< [errors] measured values of each error, one for each part
  /// [errors x errors] Inverse of the correlation matrix of the normal scores of the errors; empty for a single error.
  std::vector<double> inverse;
  /// [k (k - 1) / 2 x n] Derivative of the correlation of each pair (1 0, 2 0, 2 1, ...) with respect to the weight of
  /// each part. Empty if correlations are stated and not computed from the parts.
  std::vector<double> moves = {};

  std::size_t size() const { return parts.front().values().size(); }  ///< The number of parts, n.
};

/// All groups of measured errors of a study.
struct PartGroups {
  /// Whether the influence of parts can be computed. False if a machine draws a measured error anew at each pose, or if
  /// a measured error is correlated with an error that is not measured, or is measured on another number of parts.
  bool known = true;
  std::vector<PartGroup> each = {};  ///< the groups; an error is in one group only
};

/// The groups of a study; empty if no error is measured.
PartGroups part_groups(const Plan& plan);

/// The group of a single error, or of correlated errors. correlation: [errors x errors] correlation of the normal
/// scores; unused for a single error. Precondition: all errors have the same number of values.
PartGroup part_group(std::vector<std::size_t> errors, std::vector<SmoothedValues> parts,
                     std::span<const double> correlation);

/// Adds to `influence` [parts] the derivative d ln f / dw_i of the density f of the group's errors with respect to the
/// weight w_i = 1/n of each of the n parts. These derivatives sum to 0. x: [errors] errors of a machine, SI.
void add_influence(const PartGroup& group, std::span<const double> x, std::span<double> influence);

}  // namespace poesy::monte_carlo
