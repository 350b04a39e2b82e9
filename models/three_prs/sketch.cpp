#include "models/three_prs/sketch.h"

#include <array>
#include <cmath>

#include "models/three_prs/error_mapping.h"

namespace poesy::three_prs {
namespace {

using Vector3 = lie::Vector3<double>;
using Matrix3 = lie::Matrix3<double>;

/// The place in a limb at which an error source acts. Its members have the meanings of the same members of
/// SketchedError.
struct Site {
  std::size_t frame;
  std::size_t after;
  std::size_t before;
};

Site site_of(Source source) {
  if (source == Source::q) return {1, 1, 1};
  if (source < Source::b) return {1, 0, 1};         // a and theta_A: position and attitude of the rail
  if (source < Source::theta_Bp) return {2, 1, 2};  // b and theta_B: gap and attitude of the revolute joint
  if (source < Source::c) return {3, 2, 3};         // theta_Bp and l: attitude of the rod's frame and length of the rod
  return {4, 3, 4};
}

/// The number (0 to 2) of an error's axis x, y or z. A scalar error acts along z.
std::size_t axis_of(const Factor& factor) {
  return factor.axis.empty() ? 2 : static_cast<std::size_t>(factor.axis.front() - 'x');
}

SketchVector sketched(const Vector3& vector) { return {vector.x(), vector.y(), vector.z()}; }

SketchedFrame sketched(const Vector3& origin, const Matrix3& R) {
  return {sketched(origin), {sketched(R.col(0)), sketched(R.col(1)), sketched(R.col(2))}};
}

SketchedJoint joint(char type, const Vector3& point, const Vector3& axis, std::size_t frame) {
  return {.name = {},
          .type = type,
          .actuated = type == 'P',
          .point = sketched(point),
          .axis = sketched(axis),
          .has_errors = true,
          .first = frame,
          .frame = frame};
}

void add_limb(Sketch& sketch, const Geometry& geometry, const Configuration& nominal, std::size_t i) {
  const LimbConfiguration& limb = nominal.limbs[i];
  const Matrix3 R = base_R_limb(i);
  const Vector3 A = geometry.a * R.col(0);
  const Vector3 B = A + limb.q * Vector3::UnitZ();
  const Vector3 C = nominal.platform.p + limb.c;
  Matrix3 rod;
  rod << limb.v.cross(limb.w), limb.v, limb.w;
  sketch.limbs.push_back(
      {joint('P', A, Vector3::UnitZ(), 1), joint('R', B, limb.v, 2), joint('S', C, nominal.platform.R.col(2), 4)});
  sketch.frames.push_back({sketched(Vector3::Zero(), Matrix3::Identity()), sketched(A, R), sketched(B, R),
                           sketched(B, rod), sketched(C, nominal.platform.R * R),
                           sketched(nominal.platform.p, nominal.platform.R)});
}

}  // namespace

Pose home_pose(const Geometry& g) {
  return {0.0, 0.0, 0.5 * g.rail + std::sqrt(g.l * g.l - (g.c - g.a) * (g.c - g.a))};
}

Sketch sketch(const Geometry& geometry, const Configuration& nominal) {
  const Vector3 P = nominal.platform.p;
  Sketch sketch{.limbs = {},
                .platform = sketched(P),
                .tool = {sketched(P + tool(geometry, nominal.platform.R))},
                .z_is_down = true};
  for (std::size_t i = 0; i < kLimbs; ++i) add_limb(sketch, geometry, nominal, i);
  const std::vector<Factor> all = factors();
  const Effects effects = first_order_effects(geometry, nominal);
  for (std::size_t f = 0; f < kFactors; ++f) {
    const Site site = site_of(static_cast<Source>(f % kSources));
    const auto column = effects.col(static_cast<Eigen::Index>(f));
    const Vector3 theta = column.segment<3>(kTheta);
    const Vector3 v = Vector3(column.segment<3>(kDr)) - theta.cross(P);
    SketchedError error{f / kSources, site.frame, axis_of(all[f]), all[f].dimension == Dimension::angle, site.after,
                        site.before,  {}};
    if (column.allFinite()) error.motions = {{theta.x(), theta.y(), theta.z(), v.x(), v.y(), v.z()}};
    sketch.errors.push_back(std::move(error));
  }
  return sketch;
}

}  // namespace poesy::three_prs
