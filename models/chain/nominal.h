#pragma once

#include <span>
#include <vector>

#include "models/chain/limb.h"

// Perfect limbs whose numbers are rounded (ParallelChain::rounded): they do not quite fit each other, and hold the
// platform as well as they can.
namespace poesy::chain {

/// Displacements [all joints] (rad, m) near these with J^T W delta_mu = 0, drives as they are: where a solve without
/// errors ends. points: of the metric, in the platform's frame; none: as published.
std::vector<double> settled(const ParallelChain& chain, std::span<const lie::Vector3<double>> points,
                            std::vector<double> displacements);

/// The pose g of the platform between the limbs' g_i: sum log(g_i g^-1) = 0, so that the mean motion counts from there.
lie::Transform<double> mean_platform(const ParallelChain& chain, std::span<const double> displacements);

/// Of each limb log(g_i g^-1) with that g: [limbs].
std::vector<lie::Screw<double>> nominal_motions(const ParallelChain& chain, std::span<const double> displacements);

/// The limbs' mismatch log(g_k g_i^-1) of each pair: [6 x pairs].
std::vector<double> nominal_mismatch(const ParallelChain& chain, std::span<const double> displacements);

}  // namespace poesy::chain
