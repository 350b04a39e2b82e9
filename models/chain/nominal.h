#pragma once

#include <span>
#include <vector>

#include "models/chain/limb.h"

// Perfect limbs with rounded numbers (ParallelChain::rounded): they do not fit each other exactly, and hold the
// platform as well as they can.
namespace poesy::chain {

/// Displacements [all joints] (rad, m) near the given ones with J^T W delta_mu = 0 and unchanged drives: the result of
/// a solve without errors. points: of the metric, in the platform's frame (m); none: the published weight.
std::vector<double> settled(const ParallelChain& chain, std::span<const lie::Vector3<double>> points,
                            std::vector<double> displacements);

/// The mean base_T_platform g of the limbs' poses g_i: sum log(g_i g^-1) = 0, so that the mean motion is zero there.
lie::Transform<double> mean_platform(const ParallelChain& chain, std::span<const double> displacements);

/// The motions log(g_i g^-1) of all limbs [limbs] from mean_platform() g.
std::vector<lie::Screw<double>> nominal_motions(const ParallelChain& chain, std::span<const double> displacements);

/// The mismatch log(g_k g_i^-1) of each pair [6 x pairs].
std::vector<double> nominal_mismatch(const ParallelChain& chain, std::span<const double> displacements);

}  // namespace poesy::chain
