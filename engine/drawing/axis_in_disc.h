#pragma once

namespace poesy::drawing {

/// The quantile at 0 < u < 1 of the distance between two independent uniform points of the unit disc, given that the
/// distance is at most `most`. Precondition: 0 < most <= 2.
double distance_at_share(double u, double most);

/// The quantile at 0 < u < 1 of a coordinate of a uniform point in a lens. The lens is the intersection of two unit
/// discs whose centres are `distance` apart, and the coordinate is perpendicular to the line through the centres. It is
/// 0 on that line. Precondition: 0 <= distance <= 2.
double chord_at_share(double u, double distance);

}  // namespace poesy::drawing
