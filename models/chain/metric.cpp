#include "models/chain/metric.h"

#include <algorithm>
#include <cmath>
#include <vector>

#include "engine/base/contract.h"
#include "engine/base/units.h"

namespace poesy::chain {
namespace {

using Vector3 = lie::Vector3<double>;
using Matrix3 = lie::Matrix3<double>;

/// A point counts as on a line if its distance from the line is below this share of the points' largest distance from
/// their centroid.
constexpr double kOnLine = 1e-6;

Vector3 middle_of(std::span<const Vector3> points) {
  Vector3 middle = Vector3::Zero();
  for (const Vector3& point : points) middle += point / static_cast<double>(points.size());
  return middle;
}

}  // namespace

lie::Matrix6<double> metric_of_points(std::span<const Vector3> points) {
  POESY_EXPECTS(!points.empty());
  lie::Matrix6<double> sum = lie::Matrix6<double>::Zero();
  for (const Vector3& point : points) {
    const Matrix3 cross = lie::hat<double>(point);
    sum.topLeftCorner<3, 3>() -= cross * cross;
    sum.topRightCorner<3, 3>() += cross;
    sum.bottomLeftCorner<3, 3>() -= cross;
    sum.bottomRightCorner<3, 3>() += Matrix3::Identity();
  }
  return sum / static_cast<double>(points.size());
}

double radius_of(std::span<const Vector3> points) {
  const Vector3 middle = middle_of(points);
  double sum = 0.0;
  for (const Vector3& point : points) sum += (point - middle).squaredNorm();
  return std::sqrt(sum / static_cast<double>(points.size()));
}

bool are_on_a_line(std::span<const Vector3> points) {
  const Vector3 middle = middle_of(points);
  Vector3 farthest = Vector3::Zero();
  for (const Vector3& point : points) {
    if ((point - middle).stableNorm() > farthest.stableNorm()) farthest = point - middle;
  }
  const Vector3 direction = farthest.stableNormalized();
  return std::ranges::none_of(points, [&](const Vector3& point) {
    return (point - middle).cross(direction).stableNorm() > kOnLine * farthest.stableNorm();
  });
}

std::string why_no_metric(std::span<const Vector3> points, double reach) {
  constexpr double kFarthest = 3.0;
  constexpr double kSmallest = 1e-3;
  double farthest = 0.0;
  for (const Vector3& point : points) farthest = std::max(farthest, point.stableNorm());
  const auto length = [](double metres) { return readable_text({metres, Dimension::length}); };
  if (!(farthest <= kFarthest * reach)) {
    return "a point is " + length(farthest) +
           " from the platform's origin, more than three times the mechanism's reach of " + length(reach);
  }
  if (are_on_a_line(points)) return "the points are on one line, about which the platform may turn unseen";
  if (radius_of(points) >= kSmallest * reach) return {};
  return "the points are " + length(radius_of(points)) +
         " from their middle, less than a thousandth of the mechanism's reach of " + length(reach);
}

Metric platform_metric(const ParallelChain& chain, std::span<const Vector3> points,
                       std::span<const double> displacements) {
  const Limb& limb = chain.limbs.front();
  const lie::Transform<double> platform = forward_kinematics<double>(
      limb, limb.home, displacements.first(limb.joints.size()), [](std::size_t, const lie::Screw<double>&) {});
  std::vector<Vector3> in_base;
  for (const Vector3& point : points) in_base.emplace_back(platform.R * point + platform.p);
  return {metric_of_points(in_base), chain.reach()};
}

}  // namespace poesy::chain
