#pragma once

#include <Eigen/Core>

#include "models/file/mechanism.h"

/// The equations that close a mechanism's loops, with lengths in units of its reach.
namespace poesy::file {

/// The configuration of a mechanism: displacements [moving], limb by limb, then the poses [6] of the platform and of
/// all other bodies except the base (rad, and lengths in units of the reach).
using State = Eigen::VectorXd;

/// The state at home.
State home_state(const Mechanism& unit);

/// The loop equations, linearised. The end of every limb, from body a to body b, must agree with the pose of b: C_a
/// dpose_a + J dq - C_b dpose_b = log(T_b (T_a g)^-1), twists [omega; v] at the base's origin.
struct LoopEquations {
  Eigen::MatrixXd columns;   ///< [6 limbs x (moving + 6 bodies)]
  Eigen::VectorXd residual;  ///< [6 limbs]
};

/// The loop equations at a state. unit: a mechanism from in_reaches().
LoopEquations loop_equations(const Mechanism& unit, const State& state);

/// The pose of a body that is not the base.
PlatformPose pose_of(const Mechanism& unit, const State& state, std::size_t body = kPlatform);

/// base_T_body of a body.
Transform transform_of(const Mechanism& unit, const State& state, std::size_t body);

/// U at this pose of the platform: |U xi| is the root mean square displacement of the metric's points by the twist xi.
lie::Matrix6<double> metric_root(const Mechanism& unit, const PlatformPose& pose);

/// U times the rows of every limb: [6 limbs x columns].
Eigen::MatrixXd weighed(const lie::Matrix6<double>& root, const Eigen::MatrixXd& rows);

/// The limbs' mismatch for this residual as a share of the reach, defined like the response `gap`: the root mean square
/// over the pairs of |r_k - r_i| by the metric, or, where limbs branch, over the independent loops, of which each has
/// two limbs.
double mismatch(const Mechanism& unit, const lie::Matrix6<double>& root, const Eigen::VectorXd& residual);

}  // namespace poesy::file
