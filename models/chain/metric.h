#pragma once

#include <span>
#include <string>

#include "models/chain/limb.h"

namespace poesy::chain {

/// The default tolerance of solves that use a metric, as a share of the reach. It is about fifty times the rounding
/// error of such solves.
inline constexpr double kToleranceByMetric = 1e-14;

/// The metric that weighs the mismatch of two limbs, at one pose and in the base frame. For a twist xi = [omega; v]
/// (rad, m) the norm |xi|_W = sqrt(xi^T W xi) is a length (m).
struct Metric {
  lie::Matrix6<double> W;  ///< symmetric and positive definite: blocks in m^2, m and 1
  double reach;            ///< reach of the chain (m): unit of tolerances on |xi|_W and of its rounding
};

/// The metric W = 1/n sum P_a^T P_a with P_a = [-[c_a]x, I]: |xi|_W is the root mean square displacement of the n
/// points c_a by the twist xi. This length does not depend on the choice of frame, origin and unit. points: [n], in the
/// frame of the twist (m).
lie::Matrix6<double> metric_of_points(std::span<const lie::Vector3<double>> points);

/// The root mean square distance of the points from their centroid (m).
double radius_of(std::span<const lie::Vector3<double>> points);

/// Returns true if all points are on a line, up to a millionth of their largest distance from the centroid. A rotation
/// about the line then moves no point, so the metric of the points is not positive definite.
bool are_on_a_line(std::span<const lie::Vector3<double>> points);

/// Explains, as a clause of a sentence, why points of the platform give no metric for a chain of this reach (m); empty
/// if they give one. The points must not be on a line. They must be neither so far apart nor so close together that
/// lengths or angles vanish in rounding. points: in the platform's frame (m).
std::string why_no_metric(std::span<const lie::Vector3<double>> points, double reach);

/// The metric of points of the platform (m, in its frame) at the nominal pose. displacements: [all joints] (rad, m) of
/// the perfect limbs at that pose.
Metric platform_metric(const ParallelChain& chain, std::span<const lie::Vector3<double>> points,
                       std::span<const double> displacements);

}  // namespace poesy::chain
