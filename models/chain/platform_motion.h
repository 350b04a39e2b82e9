#pragma once

#include <cstddef>
#include <optional>
#include <span>
#include <vector>

#include "models/chain/block_problem.h"
#include "models/chain/limb.h"

namespace poesy::chain {

/// What is reported of the platform's own motion, in the base frame at a nominal pose; see KernelPlatform.
struct PlatformPoints {
  lie::Transform<double> platform;                ///< its frame
  std::optional<lie::Vector3<double>> tool = {};  ///< a second point (m)

  /// Numbers that are reported.
  std::size_t rows() const { return platform_rows(tool.has_value()); }
};

/// The mean of the limbs' motions xi_i = log(g_i g_nominal^-1), in the base frame. frames [chain.frames()]: with
/// errors; displacements [chain.joints()].
lie::Screw<double> mean_motion(const ParallelChain& chain, std::span<const lie::Transform<double>> frames,
                               std::span<const double> displacements, const lie::Transform<double>& nominal);

/// What D = exp(xi), or 1 + xi to first order, does to the points: [points.rows()], see platform_rows(). Plain double
/// arithmetic: the reference for the kernels.
std::vector<double> platform_displacement(const lie::Screw<double>& xi, const PlatformPoints& points, bool is_linear);

}  // namespace poesy::chain
