#pragma once

#include <span>
#include <vector>

#include "models/chain/limb.h"

// Functions for perfect limbs whose numbers are rounded (ParallelChain::rounded). Because of the rounding, such limbs
// do not fit each other exactly. Their nominal pose is the one at which their mismatch is least.
namespace poesy::chain {

/// Displacements [all joints] (rad, m) near the given ones that solve J^T delta_mu = 0 with unchanged drives and
/// without errors. If a solve does not converge, returns the displacements before this solve.
std::vector<double> settled(const ParallelChain& chain, std::vector<double> displacements);

/// The mean pose base_T_platform g of the limbs' platform poses g_i. The mean pose is defined by sum log(g_i g^-1) = 0.
lie::Transform<double> mean_platform(const ParallelChain& chain, std::span<const double> displacements);

/// [limbs] The motions log(g_i g^-1) of all limbs from mean_platform() g.
std::vector<lie::Screw<double>> nominal_motions(const ParallelChain& chain, std::span<const double> displacements);

/// [6 x pairs] The mismatch log(g_k g_i^-1) of each pair of limbs.
std::vector<double> nominal_mismatch(const ParallelChain& chain, std::span<const double> displacements);

}  // namespace poesy::chain
