#pragma once

#include <span>

#include "models/chain/metric.h"

namespace poesy::chain {

/// Condition number (2-norm) of the passive joints' Jacobian J of Du et al. 2022, Eq. 43, [6 pairs x passive joints],
/// for perfect limbs at these displacements [all joints] (rad, m). Lengths are measured in units of the chain's reach:
/// moments of revolute axes, about the base's origin, and displacements of prismatic joints. So it has no unit and
/// scaling all lengths does not change it. By a metric that of W^(1/2) J, how far joints move the platform's points,
/// each column divided by its length: that has no unit, and no origin enters. Infinity where J has lost a rank to
/// rounding. metric: null as published.
double passive_condition(const ParallelChain& chain, std::span<const double> displacements,
                         const Metric* metric = nullptr);

}  // namespace poesy::chain
