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
  lie::Transform<double> platform;                ///< base_T_platform
  std::optional<lie::Vector3<double>> tool = {};  ///< second point (m); none: only the origin

  /// Number of reported responses.
  std::size_t rows() const { return platform_rows(tool.has_value()); }
};

/// The mean of the limbs' motions xi_i = log(g_i g_nominal^-1), in the base frame. frames [chain.frames()]: with
/// errors; displacements [chain.joints()] (rad, m).
lie::Screw<double> mean_motion(const ParallelChain& chain, std::span<const lie::Transform<double>> frames,
                               std::span<const double> displacements, const lie::Transform<double>& nominal);

/// The displacements of the points by D = exp(xi), or by 1 + xi to first order, [points.rows()]; see platform_rows().
/// Plain double arithmetic: the reference for the kernels.
std::vector<double> platform_displacement(const lie::Screw<double>& xi, const PlatformPoints& points, bool is_linear);

}  // namespace poesy::chain
