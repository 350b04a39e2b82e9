#pragma once

#include <Eigen/Core>

#include "models/file/mechanism.h"

/// The equations that close a mechanism's loops, with lengths in units of its reach.
namespace poesy::file {

/// Displacements [moving], limb by limb, then the poses [6] of the platform and of all other bodies but the base;
/// lengths in units of the reach.
using State = Eigen::VectorXd;

/// Home.
State home_state(const Mechanism& unit);

/// Every limb, from body a to b, puts its end where the pose of b says: C_a dpose_a + J dq - C_b dpose_b =
/// log(T_b (T_a g)^-1), twists at the base's origin.
struct LoopEquations {
  Eigen::MatrixXd columns;   ///< [6 limbs x (moving + 6 bodies)]
  Eigen::VectorXd residual;  ///< [6 limbs]
};

/// unit: a mechanism in_reaches().
LoopEquations loop_equations(const Mechanism& unit, const State& state);

/// The pose of a body that is not the base.
PlatformPose pose_of(const Mechanism& unit, const State& state, std::size_t body = kPlatform);

/// base_T_body of a body.
Transform transform_of(const Mechanism& unit, const State& state, std::size_t body);

/// U with |U xi| the root mean square displacement of the metric's points by the twist xi, where the platform has this
/// pose.
lie::Matrix6<double> metric_root(const Mechanism& unit, const PlatformPose& pose);

/// U times every limb's rows: [6 limbs x columns].
Eigen::MatrixXd weighed(const lie::Matrix6<double>& root, const Eigen::MatrixXd& rows);

/// The limbs' mismatch with this residual as a share of the reach, as the response `gap` has it: the root mean square
/// over the pairs of |r_k - r_i| by the metric.
double mismatch(const Mechanism& unit, const lie::Matrix6<double>& root, const Eigen::VectorXd& residual);

}  // namespace poesy::file
