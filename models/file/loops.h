#pragma once

#include <Eigen/Core>

#include "models/file/mechanism.h"

/// The equations that close a mechanism's loops, with lengths in units of its reach.
namespace poesy::file {

/// Displacements [moving], limb by limb, then the platform's pose [6]; lengths in units of the reach.
using State = Eigen::VectorXd;

/// Every limb's platform moves to where the pose says: J_i dq_i - C dpose = log(T g_i^-1), twists at the base's origin.
struct LoopEquations {
  Eigen::MatrixXd columns;   ///< [6 limbs x (moving + 6)]
  Eigen::VectorXd residual;  ///< [6 limbs]
};

/// unit: a mechanism in_reaches().
LoopEquations loop_equations(const Mechanism& unit, const State& state);

/// The platform's pose of a state.
PlatformPose pose_of(const State& state);

/// U with |U xi| the root mean square displacement of the metric's points by the twist xi, where the platform has this
/// pose.
lie::Matrix6<double> metric_root(const Mechanism& unit, const PlatformPose& pose);

/// U times every limb's rows: [6 limbs x columns].
Eigen::MatrixXd weighed(const lie::Matrix6<double>& root, const Eigen::MatrixXd& rows);

/// The limbs' mismatch with this residual as a share of the reach, as the response `gap` has it: the root mean square
/// over the pairs of |r_k - r_i| by the metric.
double mismatch(const Mechanism& unit, const lie::Matrix6<double>& root, const Eigen::VectorXd& residual);

}  // namespace poesy::file
