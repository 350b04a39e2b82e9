#include "models/assembly/compliance.h"

#include <cmath>

namespace poesy::assembly {
namespace {

Matrix6 moved(const Transform& frame, const Matrix6& compliance) {
  const Matrix6 ad = lie::adjoint(frame);
  return ad * compliance * ad.transpose();
}

/// The compliance of a beam of this length (m), in the frame at its middle.
Matrix6 beam_compliance(const BeamSection& section, double length) {
  const double shear = section.shear_stiffness ? length / *section.shear_stiffness : 0.0;
  const double bending = length * length * length / 12.0;
  Screw diagonal;
  diagonal << length / section.GJ, length / section.EIy, length / section.EIz, length / section.EA,
      bending / section.EIz + shear, bending / section.EIy + shear;
  return diagonal.asDiagonal();
}

/// A unit vector perpendicular to the unit vector `direction`. It points along the perpendicular part of `wanted`.
/// Without `wanted`, it has any perpendicular direction.
Vector3 across(const Vector3& direction, const std::optional<Vector3>& wanted) {
  if (wanted) return (*wanted - wanted->dot(direction) * direction).normalized();
  Eigen::Index smallest = 0;
  direction.cwiseAbs().minCoeff(&smallest);
  return direction.cross(Vector3::Unit(smallest)).normalized();
}

Matrix6 link_compliance(const Link& link, const LimbState& state, const Transform& from, const Transform& to) {
  const Transform begin = link_end(link.from, state, from, to);
  const Transform end = link_end(link.to, state, from, to);
  const Vector3 along = end.p - begin.p;
  const Vector3 x = along.normalized();
  const Vector3 y = across(x, link.y ? std::optional<Vector3>(end.R * *link.y) : std::nullopt);
  Transform frame;
  frame.R << x, y, x.cross(y);
  if (const auto* section = std::get_if<BeamSection>(&link.stiffness)) {
    frame.p = begin.p + 0.5 * along;
    return moved(frame, beam_compliance(*section, along.norm()));
  }
  frame.p = end.p;
  return moved(frame, std::get<Matrix6>(link.stiffness));
}

}  // namespace

Transform link_end(const LinkEnd& end, const LimbState& state, const Transform& from, const Transform& to) {
  switch (end.at) {
    case LinkEnd::At::from:
      return from;
    case LinkEnd::At::joint:
      return state.before[end.joint];
    case LinkEnd::At::to:
      break;
  }
  return to;
}

Matrix6 limb_compliance(const Limb& limb, const LimbState& state, const Transform& from, const Transform& to) {
  Matrix6 sum = Matrix6::Zero();
  for (const Bearing& bearing : limb.bearings) sum += moved(state.before[bearing.joint], bearing.compliance);
  for (const Link& link : limb.links) sum += link_compliance(link, state, from, to);
  if (limb.end) sum += moved(to, *limb.end);
  return sum;
}

}  // namespace poesy::assembly
