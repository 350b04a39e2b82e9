#pragma once

#include <span>

#include "models/chain/limb.h"

namespace poesy::chain {

/// The condition number (2-norm) of the passive joints' Jacobian J [6 pairs x passive joints] of Du et al. 2022, Eq.
/// 43, for perfect limbs at these displacements [all joints] (rad, m). Lengths in J are moments of revolute axes about
/// the base's origin and displacements of prismatic joints. These lengths are in units of the chain's reach, so the
/// number is dimensionless and invariant to scaling. Infinite if J is rank-deficient to rounding.
double passive_condition(const ParallelChain& chain, std::span<const double> displacements);

}  // namespace poesy::chain
