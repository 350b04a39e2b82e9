#pragma once

#include <Eigen/Core>

#include "models/file/mechanism.h"

/// The equations that close a mechanism's loops. Lengths are in units of the mechanism's reach.
namespace poesy::file {

/// The configuration of a mechanism as a vector: the displacements of all joints that move, limb by limb, then six
/// numbers for the pose of each body except the base, the platform first (rad, and lengths in units of the reach).
using State = Eigen::VectorXd;

/// The configuration at home. unit: a mechanism from in_reaches().
State home_state(const Mechanism& unit);

/// The linearised loop equations. The end of every limb, from body a to body b, must agree with the pose of b: C_a
/// dpose_a + J dq - C_b dpose_b = log(T_b (T_a g)^-1). T are the poses of the bodies and g is the motion of the limb. C
/// and J map changes of poses and of joint displacements to twists [omega; v] at the base's origin.
struct LoopEquations {
  Eigen::MatrixXd columns;   ///< matrix of the left side: six rows for each limb, a column for each entry of a State
  Eigen::VectorXd residual;  ///< right side: six rows for each limb
};

/// The loop equations at a state. unit: a mechanism from in_reaches().
LoopEquations loop_equations(const Mechanism& unit, const State& state);

/// The pose of a body other than the base.
PlatformPose pose_of(const Mechanism& unit, const State& state, std::size_t body = kPlatform);

/// The pose base_T_body of a body as a rigid motion.
Transform transform_of(const Mechanism& unit, const State& state, std::size_t body);

/// [6 x 6] The root U of the metric at this pose of the platform: |U xi| is the root mean square displacement of the
/// metric's points by the twist xi.
lie::Matrix6<double> metric_root(const Mechanism& unit, const PlatformPose& pose);

/// The matrix `rows` with the six rows of each limb multiplied from the left by `root`.
Eigen::MatrixXd weighed(const lie::Matrix6<double>& root, const Eigen::MatrixXd& rows);

/// The mismatch of the limbs for this residual as a share of the reach, defined like the response `gap`. With the parts
/// r_i of the residual that belong to the limbs i, it is the root mean square over pairs of limbs of |r_k - r_i| in the
/// metric. If the mechanism is branched, the mean is over the independent loops, each of which has two limbs.
double mismatch(const Mechanism& unit, const lie::Matrix6<double>& root, const Eigen::VectorXd& residual);

}  // namespace poesy::file
