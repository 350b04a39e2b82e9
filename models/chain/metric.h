#pragma once

#include <span>
#include <string>

#include "models/chain/limb.h"

namespace poesy::chain {

/// The tolerance of solves by a metric where a study names none: some fifty times what they round to.
inline constexpr double kToleranceByMetric = 1e-14;

/// By what the mismatch of two limbs is judged, at one pose and in the base frame: |xi|_W = sqrt(xi^T W xi), a length,
/// for a twist xi = [omega; v] (rad, m). The solvers make sum |delta_mu|_W^2 stationary: J^T W delta_mu = 0.
struct Metric {
  lie::Matrix6<double> W;       ///< symmetric and positive: m^2, m and 1 in its blocks
  lie::Vector3<double> origin;  ///< of the platform, where linear mismatch is taken (m)
  double reach;                 ///< of the chain (m); changes and rounding are counted in it
};

/// W = 1/n sum P_a^T P_a with P_a = [-[c_a]x, I]: |xi|_W is the root mean square displacement of the points c_a under
/// the twist. It moves with the points: no unit, no frame and no origin enters. points: [n], in the frame of the twist.
lie::Matrix6<double> metric_of_points(std::span<const lie::Vector3<double>> points);

/// Root mean square distance of the points from their middle.
double radius_of(std::span<const lie::Vector3<double>> points);

/// Whether a rotation leaves all points where they are, up to a millionth of the largest distance from their middle:
/// then their metric is not positive.
bool are_on_a_line(std::span<const lie::Vector3<double>> points);

/// Why a chain of this reach (m) has no metric of these points of the platform, in its frame: a clause; empty where it
/// has one. They must not be on a line, nor so far away or so close together that angles or lengths drown in the other.
std::string why_no_metric(std::span<const lie::Vector3<double>> points, double reach);

/// The metric of points of the platform (in its frame), where the perfect limbs hold it at these displacements
/// [all joints] (rad, m).
Metric platform_metric(const ParallelChain& chain, std::span<const lie::Vector3<double>> points,
                       std::span<const double> displacements);

}  // namespace poesy::chain
