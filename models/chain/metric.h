#pragma once

#include <span>
#include <string>

#include "models/chain/limb.h"

namespace poesy::chain {

/// The default tolerance of solves by a metric, about fifty times their rounding error.
inline constexpr double kToleranceByMetric = 1e-14;

/// The norm of the mismatch of two limbs, at one pose and in the base frame: |xi|_W = sqrt(xi^T W xi), a length, for a
/// twist xi = [omega; v] (rad, m). The solvers make sum |delta_mu|_W^2 stationary: J^T W delta_mu = 0.
struct Metric {
  lie::Matrix6<double> W;       ///< symmetric and positive definite: blocks in m^2, m and 1
  lie::Vector3<double> origin;  ///< of the platform (m); linear mismatch is measured there
  double reach;                 ///< of the chain (m); the unit of changes and rounding
};

/// W = 1/n sum P_a^T P_a with P_a = [-[c_a]x, I]: |xi|_W is the root mean square displacement of the points c_a by the
/// twist. It depends on no unit, frame or origin. points: [n], in the frame of the twist (m).
lie::Matrix6<double> metric_of_points(std::span<const lie::Vector3<double>> points);

/// Root mean square distance of the points from their middle (m).
double radius_of(std::span<const lie::Vector3<double>> points);

/// Whether some rotation moves no point, up to a millionth of the largest distance from their middle; then their metric
/// is not positive definite.
bool are_on_a_line(std::span<const lie::Vector3<double>> points);

/// The reason, as a clause, why points of the platform give no metric for a chain of this reach (m); empty if they do.
/// They must not be on a line, nor so far apart or so close together that lengths or angles vanish in rounding. points:
/// in the platform's frame (m).
std::string why_no_metric(std::span<const lie::Vector3<double>> points, double reach);

/// The metric of points of the platform (in its frame, m) at its nominal pose, which perfect limbs give at these
/// displacements [all joints] (rad, m).
Metric platform_metric(const ParallelChain& chain, std::span<const lie::Vector3<double>> points,
                       std::span<const double> displacements);

}  // namespace poesy::chain
