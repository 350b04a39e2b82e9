#include "models/file/stiffness.h"

#include <array>
#include <cmath>
#include <numbers>
#include <stdexcept>
#include <utility>

#include "engine/base/text.h"
#include "engine/linalg/decompositions.h"
#include "models/file/bodies.h"

namespace poesy::file {
namespace {

/// Evaluates the compliances of a limb.
class Stiffness {
 public:
  explicit Stiffness(const Numbers& numbers) : numbers_(numbers) {}

  /// Sets the bearings, the links and the compliance of the whole limb.
  void add(const LimbLines& lines, const Transform& turn, const std::vector<assembly::Body>& bodies, Limb& limb) const {
    std::size_t first = 0;
    for (const JointLines& joint : lines.joints) {
      if (joint.stiffness) limb.bearings.push_back({first, bearing_compliance(joint)});
      first += elements(joint.kind);
    }
    for (const LinkLines& link : lines.links) limb.links.push_back(link_of(lines, link, turn, bodies, limb));
    if (lines.compliance) limb.compliance = compliance_of(*lines.compliance);
  }

 private:
  assembly::Matrix6 bearing_compliance(const JointLines& joint) const {
    constexpr std::array<std::string_view, 6> kNames{"rx", "ry", "rz", "x", "y", "z"};
    assembly::Screw diagonal = assembly::Screw::Zero();
    const auto entries = joint.stiffness->in_order();
    for (std::size_t k = 0; k < entries.size(); ++k) {
      const std::optional<Expression>& entry = *entries[k];
      if (!entry) continue;
      if (is_free(joint, k)) {
        const std::string drive = drive_along(joint, k);
        throw InputError(entry->place, entry->key + " is along the joint's own freedom, where it has no stiffness",
                         "remove " + std::string(kNames[k]) +
                             (drive.empty() ? "" : ", or write actuated = " + drive + " if a drive holds it"));
      }
      diagonal[static_cast<Eigen::Index>(k)] =
          1.0 / numbers_.positive(*entry, k < 3 ? kRotationalStiffness : kStiffness);
    }
    return diagonal.asDiagonal();
  }

  static constexpr std::size_t kAboutZ = 2;
  static constexpr std::size_t kAlongZ = 5;

  /// The value of the key `actuated` with which a drive holds the freedom in this direction; empty if the file format
  /// has no such value. direction: as for is_free().
  static std::string drive_along(const JointLines& joint, std::size_t direction) {
    if (joint.kind == JointKind::spherical || direction < kAboutZ) return {};
    if (joint.kind == JointKind::universal) return "1";
    const bool holds_the_other = joint.actuated[0] || joint.actuated[1];
    if (joint.kind != JointKind::cylindrical || holds_the_other) return "true";
    return direction == kAboutZ ? "1" : "2";
  }

  /// Returns true if a joint moves freely about (direction 0, 1, 2) or along (3, 4, 5) an axis of its first frame.
  static bool is_free(const JointLines& joint, std::size_t direction) {
    const bool held = joint.actuated[0];
    switch (joint.kind) {
      case JointKind::fixed:
        return false;
      case JointKind::revolute:
        return direction == kAboutZ && !held;
      case JointKind::prismatic:
        return direction == kAlongZ && !held;
      case JointKind::helical:
        return (direction == kAboutZ || direction == kAlongZ) && !held;
      case JointKind::cylindrical:
        return (direction == kAboutZ && !held) || (direction == kAlongZ && !joint.actuated[1]);
      case JointKind::universal:
        return direction < kAboutZ || (direction == kAboutZ && !held);
      case JointKind::spherical:
        return direction < 3;
    }
    throw std::logic_error("unknown kind of joint");
  }

  /// Largest asymmetry, as a share of the largest entry of the same [3 x 3] block.
  static constexpr double kSymmetric = 1e-9;

  /// The first two numbers of the matrix that differ but should be equal, as text; empty if the matrix is symmetric.
  static std::string asymmetry(const assembly::Matrix6& C) {
    for (Eigen::Index row = 0; row < 6; ++row) {
      for (Eigen::Index column = 0; column < row; ++column) {
        const auto block = C.block<3, 3>(row / 3 * 3, column / 3 * 3);
        const double apart = C(row, column) - C(column, row);
        if (std::abs(apart) <= kSymmetric * block.cwiseAbs().maxCoeff()) continue;
        const auto entry = [&](Eigen::Index i, Eigen::Index k) {
          return "row " + std::to_string(i + 1) + ", column " + std::to_string(k + 1) + " is " + shortest(C(i, k));
        };
        return entry(row, column) + ", and " + entry(column, row);
      }
    }
    return {};
  }

  assembly::Matrix6 compliance_of(const ComplianceLines& lines) const {
    using RowMajor = Eigen::Matrix<double, 6, 6, Eigen::RowMajor>;
    const assembly::Matrix6 C = Eigen::Map<const RowMajor>(lines.entries.data());
    const auto fail = [&](const std::string& problem) {
      throw InputError(lines.place, lines.key + " " + problem,
                       "write the compliance as rows of six numbers, [rotation; translation] from [moment; force]");
    };
    if (!C.allFinite()) fail("has a number that is not finite");
    const std::string asymmetric = asymmetry(C);
    if (!asymmetric.empty()) fail("is not symmetric: " + asymmetric);
    assembly::Screw unit;
    unit << 1.0, 1.0, 1.0, 1.0 / numbers_.reach(), 1.0 / numbers_.reach(), 1.0 / numbers_.reach();
    const assembly::Matrix6 even = unit.asDiagonal() * (0.5 * (C + C.transpose())) * unit.asDiagonal();
    const double largest = even.cwiseAbs().maxCoeff();
    if (linalg::eigenvalues(even)[0] < -kSymmetric * largest)
      fail("has a negative eigenvalue, so a load would do work");
    return 0.5 * (C + C.transpose());
  }

  assembly::LinkEnd link_end(const LimbLines& limb, const Reference& reference, bool is_first) const {
    std::size_t first = 0;
    for (const JointLines& joint : limb.joints) {
      if (joint.name == reference.name) return {assembly::LinkEnd::At::joint, first};
      first += elements(joint.kind);
    }
    const std::string from = limb.from ? limb.from->name : "base";
    const std::string to = limb.to ? limb.to->name : "platform";
    if (is_first && reference.name == from) return {assembly::LinkEnd::At::from};
    if (!is_first && reference.name == to) return {assembly::LinkEnd::At::to};
    std::vector<std::string_view> known = names(limb.joints);
    known.push_back(is_first ? from : to);
    throw InputError(reference.place,
                     reference.key + " '" + printable(reference.name) +
                         "' is not a joint of this limb, and not the body '" + std::string(known.back()) +
                         "' where it " + (is_first ? "begins" : "ends"),
                     suggestion(reference.name, known));
  }

  assembly::Link link_of(const LimbLines& lines, const LinkLines& link, const Transform& turn,
                         const std::vector<assembly::Body>& bodies, const Limb& limb) const {
    using At = assembly::LinkEnd::At;
    assembly::Link made{
        link_end(lines, *link.from, true), link_end(lines, *link.to, false), {}, assembly::BeamSection()};
    const auto frame = [&](const assembly::LinkEnd& end) {
      if (end.at == At::joint) return limb.joints[end.joint].at_home;
      return bodies[end.at == At::from ? limb.from : limb.to].home;
    };
    const auto fail = [&](const std::string& problem, const std::string& remedy) {
      throw InputError(link.place, link.key + " from '" + link.from->name + "' to '" + link.to->name + "' " + problem,
                       remedy);
    };
    if (made.from.at == At::joint && made.to.at == At::joint && made.from.joint == made.to.joint) {
      fail("ends where it begins", "name two joints, or a body and a joint");
    }
    const bool in_order = made.from.at != At::joint || made.to.at != At::joint || made.from.joint < made.to.joint;
    if (!in_order) fail("goes backwards", "write the joint first that is first in the limb");
    const Transform end = frame(made.to);
    const Vector3 begin = frame(made.from).p;
    if (numbers_.same(begin, end.p)) fail("has no length, because both are one point at home", "correct its ends");
    check_between(link, made, (end.p - begin).normalized(), begin, limb);
    made.stiffness = link.compliance ? std::variant<assembly::BeamSection, assembly::Matrix6>(link_compliance(link))
                                     : section_of(link);
    const auto* section = std::get_if<assembly::BeamSection>(&made.stiffness);
    if (!link.y && (section == nullptr || section->EIy != section->EIz)) {
      fail(section == nullptr ? "has no y, which is an axis of its compliance" : "has no y, but its Iy and Iz differ",
           "write y = a direction at home");
    }
    if (!link.y) return made;
    const Vector3 y = turn.R * numbers_.direction(*link.y);
    if (parallel(y, (end.p - begin).normalized())) {
      throw InputError(link.y->place, link.y->key + " is along the link", "give another direction");
    }
    made.y = end.R.transpose() * y;
    return made;
  }

  assembly::Matrix6 link_compliance(const LinkLines& link) const {
    for (const auto* other :
         {&link.E, &link.G, &link.diameter, &link.bore, &link.A, &link.Iy, &link.Iz, &link.J, &link.shear}) {
      if (!*other) continue;
      throw InputError((*other)->place, (*other)->key + " is given besides `compliance`", "remove one of them");
    }
    return compliance_of(*link.compliance);
  }

  assembly::BeamSection section_of(const LinkLines& link) const {
    const auto need = [&](const std::optional<Expression>& value, std::string_view key,
                          const Physical& wanted) -> double {
      if (value) return numbers_.positive(*value, wanted);
      throw InputError(link.place, link.key + " has no " + std::string(key),
                       "write E, G and diameter, or E, G, A, Iy, Iz and J, or compliance");
    };
    const double E = need(link.E, "E", kModulus);
    const double G = need(link.G, "G", kModulus);
    double area = 0.0, about_y = 0.0, about_z = 0.0, torsion = 0.0;
    if (link.diameter) {
      for (const auto* other : {&link.A, &link.Iy, &link.Iz, &link.J}) {
        if (!*other) continue;
        throw InputError((*other)->place, (*other)->key + " is given besides `diameter`", "remove one of them");
      }
      const double outer = numbers_.positive(*link.diameter, kLength);
      const double inner = link.bore ? numbers_.quantity(*link.bore, kLength) : 0.0;
      if (inner < 0.0 || inner >= outer) {
        throw InputError(link.bore->place, link.bore->key + " is not between 0 and the diameter",
                         "write the inner diameter, less than `diameter`");
      }
      area = std::numbers::pi / 4.0 * (outer * outer - inner * inner);
      about_y = about_z = std::numbers::pi / 64.0 * (std::pow(outer, 4) - std::pow(inner, 4));
      torsion = 2.0 * about_y;
    } else {
      if (link.bore) {
        throw InputError(link.bore->place, link.bore->key + " is given without `diameter`", "write diameter");
      }
      area = need(link.A, "A, and no diameter", kArea);
      about_y = need(link.Iy, "Iy", kAreaMoment);
      about_z = need(link.Iz, "Iz", kAreaMoment);
      torsion = need(link.J, "J", kAreaMoment);
    }
    assembly::BeamSection section{E * area, G * torsion, E * about_y, E * about_z, {}};
    if (link.shear) section.shear_stiffness = numbers_.positive(*link.shear, kNumber) * G * area;
    return section;
  }

  /// Throws if the axis of a joint between the ends of a link is not on the link's line, because the link would not
  /// stay straight when the joint moves.
  void check_between(const LinkLines& link, const assembly::Link& made, const Vector3& along, const Vector3& begin,
                     const Limb& limb) const {
    using At = assembly::LinkEnd::At;
    const std::size_t end = made.to.at == At::joint ? made.to.joint : limb.joints.size();
    std::size_t j = 0;
    if (made.from.at == At::joint) {
      const std::string& own = limb.joints[made.from.joint].name;
      j = made.from.joint;
      while (j < limb.joints.size() && limb.joints[j].name == own) ++j;
    }
    for (; j < end; ++j) {
      const Joint& joint = limb.joints[j];
      if (!joint.moves()) continue;
      const Vector3 beside = joint.at_home.p - begin - (joint.at_home.p - begin).dot(along) * along;
      if (parallel(joint.at_home.R.col(2), along) && beside.norm() <= kParallel * numbers_.reach()) continue;
      throw InputError(link.place,
                       link.key + " from '" + link.from->name + "' to '" + link.to->name + "' passes joint '" +
                           joint.name + "', whose axis is not on the line between them",
                       "write a link to that joint and one from it");
    }
  }

  const Numbers& numbers_;
};

}  // namespace

void add_stiffness(const Numbers& numbers, const LimbLines& lines, const Transform& turn,
                   const std::vector<assembly::Body>& bodies, Limb& limb) {
  Stiffness(numbers).add(lines, turn, bodies, limb);
}

assembly::Load load_of(const Numbers& numbers, const Mechanism& made) {
  const LoadLines& lines = numbers.file().load;
  assembly::Load load;
  if (lines.gravity) load.gravity = numbers.vector(*lines.gravity, kAcceleration);
  if (lines.force) load.force = numbers.vector(*lines.force, kForce);
  if (lines.moment) load.moment = numbers.vector(*lines.moment, kMoment);
  if (lines.body) load.body = body_of(numbers.file(), {}, lines.body, kPlatform, 0);
  if (load.body == kBase) {
    throw InputError(lines.body->place, lines.body->key + " is the base, which does not move",
                     "name the body on which the load acts");
  }
  if (lines.at) {
    load.at = numbers.point(*lines.at);
  } else if (load.body == kPlatform && made.tool) {
    load.at = *made.tool;
  }
  return load;
}

}  // namespace poesy::file
