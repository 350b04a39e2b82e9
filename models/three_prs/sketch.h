#pragma once

#include "engine/model/sketch.h"
#include "models/three_prs/kinematics.h"

namespace poesy::three_prs {

/// The upright pose with each carriage in the middle of its rail.
Pose home_pose(const Geometry& geometry);

/// The sketch of the mechanism at a nominal configuration. The frames of a limb are: 0 the base; 1 {A_i}, at the rail's
/// upper end; 2 {B_i}, on the carriage, with the axes of {A_i}; 3 {B_i'}, at the same point, with z along the rod; 4
/// {P_i'}, at the spherical joint; 5 the platform. Scalar errors act along z of their frames.
Sketch sketch(const Geometry& geometry, const Configuration& nominal);

}  // namespace poesy::three_prs
