#include "models/file/mechanism.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <stdexcept>

#include "engine/base/contract.h"
#include "engine/base/text.h"
#include "models/file/bodies.h"
#include "models/file/factors.h"
#include "models/file/numbers.h"
#include "models/file/stiffness.h"

namespace poesy::file {
namespace {

/// An elementary joint of a limb before its frame is known.
struct Element {
  const JointLines* lines;
  std::size_t position;  ///< index of this elementary joint among those of the joint as written
  Motion motion;
  Vector3 point;
  /// Axis; for a joint S it is set when the frames are made, from the points of other joints.
  Vector3 z = Vector3::Zero();
};

Motion motion_of(JointKind kind, std::size_t position) {
  switch (kind) {
    case JointKind::fixed:
      return Motion::fixed;
    case JointKind::prismatic:
      return Motion::prismatic;
    case JointKind::helical:
      return Motion::helical;
    case JointKind::cylindrical:
      return position == 0 ? Motion::revolute : Motion::prismatic;
    case JointKind::revolute:
    case JointKind::universal:
    case JointKind::spherical:
      return Motion::revolute;
  }
  throw std::logic_error("unknown kind of joint");
}

/// The name of a drive in the n-th copy of a limb (from 1): n replaces "*".
std::string of_copy(const std::string& drive, std::size_t n) {
  std::string name;
  for (const char letter : drive) name += letter == '*' ? std::to_string(n) : std::string(1, letter);
  return name;
}

/// Throws if a drive rotates one joint and moves another one along its axis, or if its name, which is a column of pose
/// files, is also the name of another column.
void check_drives(const Mechanism& mechanism) {
  const std::vector<const Joint*> joints = moving_joints(mechanism);
  const std::vector<JointDisplacement> displacements = displacement_names(mechanism);
  for (const Drive& drive : drives_of(mechanism)) {
    const Joint& first = *joints[drive.joints.front()];
    if (first.drive.empty()) continue;
    for (const std::size_t k : drive.joints) {
      if (displacements[k].dimension == displacements[drive.joints.front()].dimension) continue;
      throw InputError(
          joints[k]->place,
          "drive '" + drive.name + "' turns one of its joints and slides another, joint '" + joints[k]->name + "'",
          "give them drives of different names, because joints of one drive have one displacement");
    }
    const bool is_coordinate =
        std::ranges::find(mechanism.coordinates, drive.name, &Coordinate::name) != mechanism.coordinates.end();
    const bool is_joint = std::ranges::find(displacements, drive.name, &JointDisplacement::name) != displacements.end();
    if (!is_coordinate && !is_joint) continue;
    throw InputError(first.place,
                     "the drive of joint '" + first.name + "' has the name '" + drive.name + "' of a " +
                         (is_coordinate ? "coordinate" : "joint's displacement"),
                     "give it another name, because files of poses may have columns of both");
  }
}

class Builder {
 public:
  Builder(const MechanismFile& file, std::span<const double> values)
      : file_(file), values_(values), numbers_(file, values) {}

  Mechanism whole() {
    const PlatformLines& lines = file_.platform;
    Mechanism made{.name = file_.name,
                   .title = file_.title,
                   .platform = {lie::Matrix3<double>::Identity(), numbers_.point(*lines.origin)},
                   .rotation = lines.rotation,
                   .coordinates_place = lines.coordinates_place,
                   .reach = 0.0};
    platform_point_ = made.platform.p;
    std::vector<std::vector<Vector3>> points;
    for (const LimbLines& limb : file_.limbs) points.push_back(joint_points(limb));
    made.reach = reach_of(points);
    numbers_.set_reach(made.reach);
    if (lines.x) made.platform.R = numbers_.axes(*lines.x, *lines.z);
    made.bodies = bodies_of(numbers_, made.platform);
    for (std::size_t n = 0; n < file_.limbs.size(); ++n) add_limbs(file_.limbs[n], points[n], made);
    check_branches(file_, made);
    for (const CoordinateLines& coordinate : lines.coordinates) made.coordinates.push_back(coordinate_of(coordinate));
    check_drives(made);
    if (lines.tool) made.tool = numbers_.point(*lines.tool);
    for (const NamedPoint& named : lines.named) {
      const Vector3 place = numbers_.point(named.point);
      made.named.push_back({named.name, {place.x(), place.y(), place.z()}});
    }
    add_metric_points(made);
    made.load = load_of(numbers_, made);
    made.about = file_.about;
    made.errors_at_joints = file_.about == ErrorsAbout::joint && !file_.has_features();
    add_factors(numbers_, made);
    return made;
  }

 private:
  // ---- points

  /// The point with this name among those of the limb and of the file; null if there is none.
  const NamedPoint* named_point(const LimbLines& limb, const std::string& name) const {
    for (const std::vector<NamedPoint>* list : {&limb.points, &file_.points}) {
      const auto found = std::ranges::find(*list, name, &NamedPoint::name);
      if (found != list->end()) return &*found;
    }
    return nullptr;
  }

  Vector3 place_of(const LimbLines& limb, const Reference& reference, std::size_t depth) const {
    const auto joint = std::ranges::find(limb.joints, reference.name, &JointLines::name);
    if (joint != limb.joints.end()) return joint_point(limb, *joint, depth + 1);
    if (const NamedPoint* named = named_point(limb, reference.name)) return numbers_.point(named->point);
    std::vector<std::string_view> known = names(limb.joints);
    for (const NamedPoint& named : limb.points) known.push_back(named.name);
    for (const NamedPoint& named : file_.points) known.push_back(named.name);
    throw InputError(reference.place,
                     reference.key + " '" + printable(reference.name) + "' is neither a joint of this limb nor a point",
                     suggestion(reference.name, known));
  }

  /// The point of a joint (m), from the key `at`, or from the key `from` for joints P, H and C without `at`. depth:
  /// number of references followed so far.
  Vector3 joint_point(const LimbLines& limb, const JointLines& joint, std::size_t depth = 0) const {
    if (depth > limb.joints.size()) {
      throw InputError(joint.place, joint.key + " '" + joint.name + "' takes its point from itself",
                       named_point(limb, joint.name) != nullptr
                           ? "a point has the name of the joint: rename one of them"
                           : "write at = [x, y, z] for one of them");
    }
    if (joint.at) return numbers_.point(*joint.at);
    if (joint.at_point) return place_of(limb, *joint.at_point, depth);
    const bool slides =
        joint.kind == JointKind::prismatic || joint.kind == JointKind::helical || joint.kind == JointKind::cylindrical;
    if (slides && joint.from) return place_of(limb, *joint.from, depth);
    throw InputError(joint.place, joint.key + " '" + joint.name + "' has no point",
                     slides ? "write at = [x, y, z], or from = and to =" : "write at = [x, y, z]");
  }

  std::vector<Vector3> joint_points(const LimbLines& limb) const {
    std::vector<Vector3> points;
    for (const JointLines& joint : limb.joints) points.push_back(joint_point(limb, joint));
    return points;
  }

  double reach_of(const std::vector<std::vector<Vector3>>& limbs) const {
    std::vector<Vector3> all{platform_point_};
    for (const std::vector<Vector3>& points : limbs) all.insert(all.end(), points.begin(), points.end());
    double reach = 0.0;
    for (const Vector3& a : all) {
      for (const Vector3& b : all) reach = std::max(reach, (a - b).norm());
    }
    if (reach > 0.0) return reach;
    throw InputError(file_.platform.place, "all joints and the platform's origin are one point",
                     "write where they are at home");
  }

  // ---- axes and frames

  /// The axis of a joint other than S: as written, or the direction from one point to another.
  Vector3 axis_of(const LimbLines& limb, const JointLines& joint) const {
    if (joint.axis && joint.to) {
      throw InputError(joint.axis->place, joint.axis->key + " is given besides `to`", "remove one of them");
    }
    if (joint.axis) return numbers_.direction(*joint.axis);
    if (!joint.from || !joint.to) {
      throw InputError(joint.place, joint.key + " '" + joint.name + "' has no direction",
                       "write axis = \"z\", or from = and to = with names of joints or points");
    }
    const Vector3 from = place_of(limb, *joint.from, 0);
    const Vector3 to = place_of(limb, *joint.to, 0);
    if (!numbers_.same(from, to)) return (to - from).stableNormalized();
    throw InputError(joint.to->place,
                     joint.to->key + " '" + joint.to->name + "' and '" + joint.from->name +
                         "' are one point at home, so no direction goes from one to the other",
                     "write axis = instead, or move one of them");
  }

  std::vector<Element> elements_of(const LimbLines& limb, const std::vector<Vector3>& points) const {
    std::vector<Element> list;
    for (std::size_t n = 0; n < limb.joints.size(); ++n) {
      const JointLines& joint = limb.joints[n];
      const Vector3 axis = joint.kind == JointKind::spherical ? Vector3::Zero() : axis_of(limb, joint);
      for (std::size_t k = 0; k < elements(joint.kind); ++k) {
        list.push_back({&joint, k, motion_of(joint.kind, k), points[n], axis});
      }
      if (joint.kind != JointKind::universal) continue;
      list.back().z = numbers_.direction(*joint.axis2);
      if (!parallel(axis, list.back().z)) continue;
      throw InputError(joint.axis2->place, joint.axis2->key + " is parallel to the first axis",
                       "a universal joint has two axes; one alone is a revolute joint, type = \"R\"");
    }
    return list;
  }

  /// The first axis of a joint S. It points along the line from the last preceding point that differs from the joint's
  /// own point. If all preceding points equal it, the axis points to the first following point that differs. The last
  /// of all points is the origin of the body at the limb's end. If no point differs, the axis is the base's z axis,
  /// turned with a copy of the limb.
  Vector3 first_axis_of_s(const std::vector<Element>& elements, std::size_t e, const Vector3& end) const {
    const Vector3& own = elements[e].point;
    for (std::size_t k = e; k-- > 0;) {
      if (!numbers_.same(elements[k].point, own)) return (own - elements[k].point).stableNormalized();
    }
    for (std::size_t k = e + 1; k < elements.size(); ++k) {
      if (!numbers_.same(elements[k].point, own)) return (elements[k].point - own).stableNormalized();
    }
    return numbers_.same(end, own) ? Vector3::UnitZ() : (end - own).stableNormalized();
  }

  /// The x axis of a joint: as given, or else towards the next point, or else the first base axis that is not parallel
  /// to z.
  Vector3 x_of(const Element& element, const Vector3& z, const Vector3& next) const {
    const JointLines& joint = *element.lines;
    if (joint.x && element.position == 0) {
      const Vector3 x = numbers_.direction(*joint.x);
      if (!parallel(x, z)) return perpendicular(x, z);
      throw InputError(joint.x->place, joint.x->key + " is parallel to the joint's axis", "give another direction");
    }
    if (!numbers_.same(next, element.point)) {
      const Vector3 towards = (next - element.point).stableNormalized();
      if (!parallel(towards, z)) return perpendicular(towards, z);
    }
    for (const Vector3& axis : {Vector3(1.0, 0.0, 0.0), Vector3(0.0, 1.0, 0.0)}) {
      if (!parallel(axis, z)) return perpendicular(axis, z);
    }
    return perpendicular(Vector3::UnitZ(), z);
  }

  /// The elementary joints of a limb. end: origin of the body at the limb's end (m).
  std::vector<Joint> joints_of(const LimbLines& limb, const std::vector<Vector3>& points, const Vector3& end) const {
    std::vector<Element> elements = elements_of(limb, points);
    std::vector<Joint> joints;
    for (std::size_t e = 0; e < elements.size(); ++e) {
      Element& element = elements[e];
      const JointLines& lines = *element.lines;
      if (lines.kind == JointKind::spherical) {
        const std::size_t k = element.position;  // the second axis is x of the first frame, the third is y = z cross x
        element.z = k == 0 ? first_axis_of_s(elements, e, end) : Vector3(joints[e - k].at_home.R.col(k == 1 ? 0 : 1));
      }
      const Vector3 next = e + 1 < elements.size() ? elements[e + 1].point : end;
      const Vector3 x = x_of(element, element.z, next);
      const bool actuated =
          element.motion != Motion::fixed && lines.kind != JointKind::spherical && lines.actuated[element.position];
      joints.push_back({lines.name,
                        lines.place,
                        lines.kind,
                        element.motion,
                        actuated,
                        pitch_of(lines),
                        {frame_of(x, element.z), element.point},
                        lines.drive ? lines.drive->name : "",
                        lines.reaction});
    }
    return joints;
  }

  /// The pitch of a joint, m/rad.
  double pitch_of(const JointLines& joint) const {
    if (!joint.pitch) return 0.0;
    const double pitch = numbers_.length(*joint.pitch);
    if (pitch != 0.0) return pitch / (2.0 * std::numbers::pi);
    throw InputError(joint.pitch->place, joint.pitch->key + " is zero, so the joint does not slide",
                     "write type = \"R\", or its pitch");
  }

  void add_limbs(const LimbLines& lines, const std::vector<Vector3>& points, Mechanism& made) const {
    const std::size_t first_end = body_of(file_, lines, lines.to, kPlatform, 0);
    const std::vector<Joint> first = joints_of(lines, points, made.bodies[first_end].home.p);
    const bool holds_platform_alone = made.bodies.size() == 2;
    if (holds_platform_alone && std::ranges::none_of(first, &Joint::moves)) {
      throw InputError(lines.joints.front().place, lines.joints.front().key + ": no joint of this limb moves",
                       "add one");
    }
    for (std::size_t copy = 0; copy < lines.copies.count; ++copy) {
      const Transform turn = turned(lines.copies, copy);
      Limb limb{first, {}};
      limb.from = body_of(file_, lines, lines.from, kBase, copy);
      limb.to = body_of(file_, lines, lines.to, kPlatform, copy);
      limb.label = label_of(lines, copy, made.limbs.size());
      Transform before = made.bodies[limb.from].home;
      for (Joint& joint : limb.joints) {
        if (copy > 0) joint.at_home = turn * joint.at_home;
        joint.drive = of_copy(joint.drive, copy + 1);
        limb.home.push_back(before.inverse() * joint.at_home);
        before = joint.at_home;
      }
      limb.home.push_back(before.inverse() * made.bodies[limb.to].home);
      add_stiffness(numbers_, lines, turn, made.bodies, limb);
      made.limbs.push_back(std::move(limb));
    }
  }

  /// The label of a copy of a limb. before: number of limbs, including copies, that precede this limb in the file.
  static std::string label_of(const LimbLines& lines, std::size_t copy, std::size_t before) {
    if (lines.name.empty()) return std::to_string(before + 1);
    return lines.copies.count == 1 ? lines.name : lines.name + "_" + std::to_string(copy + 1);
  }

  // ---- platform

  Coordinate coordinate_of(const CoordinateLines& lines) const {
    constexpr std::array<std::string_view, 6> kNames{"x", "y", "z", "rx", "ry", "rz"};
    const auto component = static_cast<std::size_t>(std::ranges::find(kNames, lines.component) - kNames.begin());
    Coordinate made{lines.name, component, 0.0, 0.0};
    made.lower = evaluate(lines.lower, made.dimension(), file_.geometry, values_);
    made.upper = evaluate(lines.upper, made.dimension(), file_.geometry, values_);
    if (made.lower < made.upper) return made;
    throw InputError(lines.lower.place,
                     lines.lower.key + " '" + lines.lower.text + "' is not below '" + lines.upper.text + "'",
                     "write the lowest value first");
  }

  /// The point (m) of the joint nearest to the platform among the joints that move, or among all joints if none moves.
  /// The range of joints begins at the platform.
  template <class Iterator>
  static Vector3 last_moving(Iterator begin, Iterator end) {
    const auto found = std::find_if(begin, end, [](const Joint& joint) { return joint.moves(); });
    return found == end ? begin->at_home.p : found->at_home.p;
  }

  void add_metric_points(Mechanism& made) const {
    for (const Triple& triple : file_.platform.points) made.points.push_back(numbers_.point(triple));
    if (made.points.empty()) {
      for (const Limb& limb : made.limbs) {
        if (limb.to != kPlatform && limb.from != kPlatform) continue;
        const Vector3 at = limb.to == kPlatform ? last_moving(limb.joints.rbegin(), limb.joints.rend())
                                                : last_moving(limb.joints.begin(), limb.joints.end());
        made.points.push_back(made.platform.R.transpose() * (at - made.platform.p));
      }
    }
  }

  const MechanismFile& file_;
  std::span<const double> values_;
  Vector3 platform_point_ = Vector3::Zero();
  Numbers numbers_;
};

/// The axes of the three rotations, in the order of their product. Precondition: the rotation is not "vector".
std::array<int, 3> axes_of(Rotation rotation) {
  const std::string_view letters = name(rotation);
  return {letters[0] - 'x', letters[1] - 'x', letters[2] - 'x'};
}

}  // namespace

chain::Joint Joint::of_chain() const {
  const bool turns = motion == Motion::revolute || motion == Motion::helical;
  return {turns ? chain::JointType::revolute : chain::JointType::prismatic, actuated || !moves(),
          motion == Motion::helical ? pitch : 0.0, !moves()};
}

std::size_t Limb::moving() const { return static_cast<std::size_t>(std::ranges::count_if(joints, &Joint::moves)); }

bool Mechanism::is_elastic() const {
  return std::ranges::any_of(limbs, [](const Limb& limb) {
    return !limb.bearings.empty() || !limb.links.empty() || limb.compliance.has_value();
  });
}

std::size_t Mechanism::moving() const {
  std::size_t sum = 0;
  for (const Limb& limb : limbs) sum += limb.moving();
  return sum;
}

std::vector<double> default_geometry(const MechanismFile& file) {
  std::vector<double> values;
  for (const GeometryParameter& parameter : file.geometry) values.push_back(parameter.published);
  return values;
}

Mechanism mechanism(const MechanismFile& file, std::span<const double> geometry) {
  POESY_EXPECTS(geometry.size() == file.geometry.size());
  return Builder(file, geometry).whole();
}

Mechanism in_reaches(Mechanism mechanism) {
  const double unit = mechanism.reach;
  for (Limb& limb : mechanism.limbs) {
    for (Transform& home : limb.home) home.p /= unit;
    for (Joint& joint : limb.joints) {
      joint.at_home.p /= unit;
      joint.pitch /= unit;
    }
  }
  for (Coordinate& coordinate : mechanism.coordinates) {
    if (coordinate.component >= 3) continue;
    coordinate.lower /= unit;
    coordinate.upper /= unit;
  }
  for (assembly::Body& body : mechanism.bodies) body.home.p /= unit;
  for (Vector3& point : mechanism.points) point /= unit;
  if (mechanism.tool) *mechanism.tool /= unit;
  mechanism.platform.p /= unit;
  mechanism.reach = 1.0;
  return mechanism;
}

std::string limb_text(const Mechanism& mechanism, std::size_t limb) {
  const std::string number = std::to_string(limb + 1);
  const std::string& label = mechanism.limbs[limb].label;
  return "limb " + number + (label == number ? "" : " (" + label + ")");
}

std::vector<const Joint*> moving_joints(const Mechanism& mechanism) {
  std::vector<const Joint*> list;
  for (const Limb& limb : mechanism.limbs) {
    for (const Joint& joint : limb.joints) {
      if (joint.moves()) list.push_back(&joint);
    }
  }
  return list;
}

std::vector<Drive> drives_of(const Mechanism& mechanism) {
  const std::vector<const Joint*> joints = moving_joints(mechanism);
  const std::vector<JointDisplacement> displacements = displacement_names(mechanism);
  std::vector<Drive> drives;
  for (std::size_t k = 0; k < joints.size(); ++k) {
    if (!joints[k]->actuated) continue;
    const std::string& name = joints[k]->drive;
    const auto known = std::ranges::find_if(
        drives, [&](const Drive& drive) { return !name.empty() && joints[drive.joints.front()]->drive == name; });
    if (known != drives.end()) {
      known->joints.push_back(k);
    } else {
      drives.push_back({name.empty() ? displacements[k].name : name, {k}});
    }
  }
  return drives;
}

std::vector<JointDisplacement> displacement_names(const Mechanism& mechanism) {
  std::vector<JointDisplacement> list;
  for (std::size_t i = 0; i < mechanism.limbs.size(); ++i) {
    const std::vector<Joint>& joints = mechanism.limbs[i].joints;
    for (std::size_t j = 0; j < joints.size(); ++j) {
      if (!joints[j].moves()) continue;
      list.push_back({"q_" + std::to_string(i + 1) + "_" + std::to_string(j + 1),
                      joints[j].motion == Motion::prismatic ? Dimension::length : Dimension::angle,
                      joints[j].actuated});
    }
  }
  return list;
}

PlatformPose home_pose(const Mechanism& mechanism) { return home_pose(mechanism, kPlatform); }

PlatformPose home_pose(const Mechanism& mechanism, std::size_t body) {
  const Vector3& p = body == kPlatform ? mechanism.platform.p : mechanism.bodies[body].home.p;
  return {p.x(), p.y(), p.z(), 0.0, 0.0, 0.0};
}

Transform platform_transform(const Mechanism& mechanism, const PlatformPose& pose) {
  return body_transform(mechanism, kPlatform, pose);
}

Transform body_transform(const Mechanism& mechanism, std::size_t body, const PlatformPose& pose) {
  const bool is_platform = body == kPlatform;
  Transform made{is_platform ? mechanism.platform.R : mechanism.bodies[body].home.R, {pose[0], pose[1], pose[2]}};
  if (!is_platform || mechanism.rotation == Rotation::vector) {
    made.R = lie::exp<double>(Vector3(pose[3], pose[4], pose[5])) * made.R;
    return made;
  }
  const std::array<int, 3> axes = axes_of(mechanism.rotation);
  for (std::size_t k = 3; k-- > 0;) {
    const auto axis = static_cast<std::size_t>(axes[k]);
    made.R = lie::rotation<double>(static_cast<lie::Axis>(axis), pose[3 + axis]).R * made.R;
  }
  return made;
}

lie::Matrix6<double> platform_columns(const Mechanism& mechanism, const PlatformPose& pose) {
  return body_columns(mechanism, kPlatform, pose);
}

lie::Matrix6<double> body_columns(const Mechanism& mechanism, std::size_t body, const PlatformPose& pose) {
  lie::Matrix6<double> columns = lie::Matrix6<double>::Zero();
  columns.bottomLeftCorner<3, 3>().setIdentity();
  lie::Matrix3<double> turns;
  if (body != kPlatform || mechanism.rotation == Rotation::vector) {
    turns = lie::left_jacobian<double>(Vector3(pose[3], pose[4], pose[5]));
  } else {
    lie::Matrix3<double> before = lie::Matrix3<double>::Identity();
    for (const int axis : axes_of(mechanism.rotation)) {
      turns.col(axis) = before.col(axis);
      before = before * lie::rotation<double>(static_cast<lie::Axis>(axis), pose[3 + static_cast<std::size_t>(axis)]).R;
    }
  }
  const Vector3 p(pose[0], pose[1], pose[2]);
  columns.topRightCorner<3, 3>() = turns;
  columns.bottomRightCorner<3, 3>() = lie::hat<double>(p) * turns;
  return columns;
}

std::vector<std::size_t> placing_limbs(const Mechanism& mechanism) {
  return assembly::placing_limbs(mechanism.bodies.size(), mechanism.limbs);
}

Transform limb_transform(const Limb& limb, std::span<const double> displacements,
                         Eigen::Matrix<double, 6, Eigen::Dynamic>* columns, const Transform& from) {
  POESY_EXPECTS(displacements.size() == limb.moving());
  Transform g = from * limb.home.front();
  std::size_t k = 0;
  for (std::size_t j = 0; j < limb.joints.size(); ++j) {
    const Joint& joint = limb.joints[j];
    if (joint.moves()) {
      const chain::Joint moving = joint.of_chain();
      if (columns != nullptr) columns->col(static_cast<Eigen::Index>(k)) = chain::spatial_column(moving, g);
      chain::move_joint(moving, displacements[k], g);
      ++k;
    }
    g = g * limb.home[j + 1];
  }
  return g;
}

}  // namespace poesy::file
