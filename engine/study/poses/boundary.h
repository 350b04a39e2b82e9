#pragma once

#include <cstddef>

#include "engine/study/poses/workspace.h"

namespace poesy {

/// The first `count` poses of a sequence on the boundary of the feasible set, its faces on the box included, uniform by
/// area. Area is that in coordinates scaled to the box (each range is [0, 1]), because metres and radians have no
/// common measure. Any number of coordinates C; for C = 1 the boundary is the ends of intervals.
///
/// Lines distributed by the kinematic measure meet a surface in points uniform by area (Crofton): so a shifted Sobol'
/// sequence gives lines, of uniform direction and with a uniform offset from the cube's centre in a ball of dimension
/// C - 1 that covers the cube, and every crossing of the feasible set's boundary along a line is a pose. The chord that
/// the box leaves of a line is scanned in kScanIntervals intervals; where the ends of one differ, bisection refines to
/// rounding and the feasible side is kept. A pose on a face of the box lies on it exactly. A feasible piece or gap
/// shorter than a scan interval can be missed, and a piece shorter than rounding is left out. Among rejected poses the
/// points of the scans count.
///
/// Throws InputError when max(20 000, 100 count) lines do not give enough, or when poses coincide to rounding.
SelectedPoses boundary_poses(const PoseSelection& selection, const Model& model);

/// Steps along a line in which a change of feasibility is looked for.
inline constexpr std::size_t kScanIntervals = 32;

}  // namespace poesy
