#pragma once

#include <cstddef>
#include <optional>
#include <span>
#include <vector>

#include "models/chain/block_problem.h"
#include "models/chain/limb.h"

namespace poesy::chain {

/// The reported points of the platform, in the base frame at a nominal pose; see KernelPlatform.
struct PlatformPoints {
  lie::Transform<double> platform;  ///< pose base_T_platform
  /// Tool point, the second reported point (m); none if only the origin is reported.
  std::optional<lie::Vector3<double>> tool = {};

  /// The number of reported responses.
  std::size_t rows() const { return platform_rows(tool.has_value()); }
};

/// The mean, over all limbs i, of the motions xi_i = log(g_i g_nominal^-1) in the base frame, where g_i is the platform
/// pose of limb i. frames: [chain.frames()], with errors. displacements: [chain.joints()] (rad, m).
lie::Screw<double> mean_motion(const ParallelChain& chain, std::span<const lie::Transform<double>> frames,
                               std::span<const double> displacements, const lie::Transform<double>& nominal);

/// The displacements [points.rows()] of the points by D = exp(xi), or by 1 + xi to first order; see platform_rows().
/// Uses plain double arithmetic; tests compare the kernels with it.
std::vector<double> platform_displacement(const lie::Screw<double>& xi, const PlatformPoints& points, bool is_linear);

}  // namespace poesy::chain
