#pragma once

#include <span>

#include "models/chain/metric.h"

namespace poesy::chain {

/// Condition number (2-norm) of the passive joints' Jacobian J of Du et al. 2022, Eq. 43, [6 pairs x passive joints],
/// for perfect limbs at these displacements [all joints] (rad, m). Lengths, which are moments of revolute axes about
/// the base's origin and displacements of prismatic joints, are in units of the chain's reach. So the number is
/// dimensionless and invariant to scaling. By a metric it is the condition number of W^(1/2) J with columns of length
/// 1, which also depends on no origin. Infinity if J is rank-deficient to rounding. metric: null as published.
double passive_condition(const ParallelChain& chain, std::span<const double> displacements,
                         const Metric* metric = nullptr);

}  // namespace poesy::chain
