#include "models/file/features.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <stdexcept>

#include "engine/base/text.h"
#include "engine/fits/fit.h"
#include "engine/model/feature_errors.h"
#include "models/file/factors.h"
#include "models/file/general.h"
#include "models/file/structure.h"

namespace poesy::file {
namespace {

using Matrix3 = lie::Matrix3<double>;
using Eigen::Index;

/// A component of a rotation or displacement counts as rounding if it is at most this share of the whole rotation or
/// displacement.
constexpr double kRounding = 1e-13;

constexpr std::string_view kAxisLetters = "xyz";
constexpr double kSameAxis = 1e-9;  ///< axes count as equal if they differ by less than this

constexpr double kSmallestSize = 1e-12;  ///< smallest size of a feature, m

/// The frame of a feature, in the base frame at home.
struct FeatureFrame {
  Matrix3 axes;    ///< axes x, y, z as columns
  Vector3 middle;  ///< middle of the feature, m
};

/// The frame of a limb that the errors of a feature displace.
struct FeaturePart {
  std::size_t frame;  ///< index of the frame in the limb
  Transform datum;    ///< base_T_part of the feature's part at home
  bool inverse;       ///< true if the error of the frame is the inverse of the feature's displacement
};

/// An error of a feature: the displacement of the feature's middle and the rotation of the feature, per metre of the
/// error and in the feature's axes.
struct FeatureError {
  FeatureDirection direction;  ///< direction that the name of the error states
  Vector3 turn;                ///< rotation, rad/m
  Vector3 shift;               ///< displacement of the middle, m/m
  bool is_tilt;                ///< true if the error rotates the feature
  Index axis;                  ///< axis of the feature that the name of the error states: 0, 1, 2 for x, y, z
  std::string text;            ///< description: "leans to x: its far end against its near end, 500 mm apart"
};

std::string millimetres(double metres) { return fmt::format("{:.6g} mm", 1e3 * metres); }

FeatureError shift(FeatureDirection direction, Index axis, std::string text) {
  return {direction, Vector3::Zero(), Vector3::Unit(axis), false, axis, std::move(text)};
}

/// All possible errors of a feature of this kind and size (m).
std::vector<FeatureError> all_errors(FeatureKind kind, const std::array<double, 2>& size) {
  const auto lean = [&](FeatureDirection direction, const Vector3& turn, Index axis) {
    return FeatureError{direction,
                        turn / size[0],
                        Vector3::Zero(),
                        true,
                        axis,
                        fmt::format("leans to {}: its far end against its near end, {} apart",
                                    kAxisLetters[static_cast<std::size_t>(axis)], millimetres(size[0]))};
  };
  const auto lift = [&](FeatureDirection direction, const Vector3& turn, Index axis) {
    const double across = size[static_cast<std::size_t>(axis)];
    return FeatureError{direction,
                        2.0 * turn / across,
                        Vector3::Zero(),
                        true,
                        axis,
                        fmt::format("lifts towards {}: the edge up, the other one, {} away, down by as much",
                                    kAxisLetters[static_cast<std::size_t>(axis)], millimetres(across))};
  };
  const Vector3 x = Vector3::UnitX();
  const Vector3 y = Vector3::UnitY();
  switch (kind) {
    case FeatureKind::axis:
      return {shift(FeatureDirection::x, 0, "its middle is off along x"),
              shift(FeatureDirection::y, 1, "its middle is off along y"), lean(FeatureDirection::lean_x, y, 0),
              lean(FeatureDirection::lean_y, -x, 1)};
    case FeatureKind::rectangle:
    case FeatureKind::round:
      return {shift(FeatureDirection::z, 2, "is off along its normal"), lift(FeatureDirection::lift_x, -y, 0),
              lift(FeatureDirection::lift_y, x, 1)};
    case FeatureKind::point:
      return {shift(FeatureDirection::x, 0, "is off along x"), shift(FeatureDirection::y, 1, "is off along y"),
              shift(FeatureDirection::z, 2, "is off along z")};
    case FeatureKind::distance:
      break;
  }
  return {shift(FeatureDirection::too_long, 0, "is too long")};
}

/// The text ", where y is (0, 0, -1) at home", which states an axis of a feature in the base frame. Empty if this axis
/// is the base's axis of the same name.
std::string axis_text(const FeatureError& error, const Matrix3& axes) {
  const Vector3 way = axes.col(error.axis);
  if (error.direction == FeatureDirection::too_long || (way - Vector3::Unit(error.axis)).norm() < kSameAxis) return {};
  const Vector3 shown = (way.array().abs() < kSameAxis).select(0.0, way);
  return fmt::format(", where {} is {} at home", kAxisLetters[static_cast<std::size_t>(error.axis)],
                     triple_text(shown));
}

/// The errors of a feature that its zones limit. If the zones lie between two parallel planes, these are only the
/// errors along the normal of the planes. If the feature has a tolerance of orientation but none of location, they are
/// only tilts.
std::vector<FeatureError> errors_of(const FeatureLines& lines, const Feature& feature) {
  std::vector<FeatureError> all = all_errors(feature.kind, feature.size);
  const bool only_turns = feature.orientation && !feature.location;
  std::erase_if(all, [&](const FeatureError& error) {
    const bool is_within_planes = feature.one_direction && !name(error.direction).ends_with(lines.along);
    return is_within_planes || (only_turns && !error.is_tilt);
  });
  return all;
}

class FeatureBuilder {
 public:
  FeatureBuilder(const Numbers& numbers, const LimbLines& limb, Mechanism& mechanism)
      : numbers_(numbers), limb_(limb), mechanism_(mechanism) {}

  /// Adds to the mechanism the features of all copies of the limb. first: index of the first copy among the
  /// mechanism's limbs.
  void add(std::size_t first) {
    for (std::size_t copy = 0; copy < limb_.copies.count; ++copy) {
      for (const FeatureLines& lines : limb_.features) add_one(lines, described(lines), first, copy);
      for (const ClearanceLines& lines : limb_.clearances) add_one(lines.axis, loose(lines), first, copy);
    }
  }

 private:
  /// The index in the limb of the elementary joint to which a feature belongs, counted from 0.
  std::size_t joint_of(const FeatureLines& lines) const {
    std::size_t first = 0;
    for (const JointLines& joint : limb_.joints) {
      const std::size_t count = elements(joint.kind);
      if (joint.name != lines.joint->name) {
        first += count;
        continue;
      }
      if (lines.axis) {
        if (*lines.axis <= count) return first + *lines.axis - 1;
        throw InputError(lines.place,
                         fmt::format("{}.axis is {}, but joint '{}' has {}", lines.key, *lines.axis, joint.name,
                                     count == 1 ? "one axis" : fmt::format("{} axes", count)),
                         "write the number of one of its axes");
      }
      const bool takes_last = lines.part == PartSide::after && joint.kind != JointKind::universal;
      return takes_last ? first + count - 1 : first;
    }
    throw InputError(lines.joint->place,
                     lines.joint->key + " '" + printable(lines.joint->name) + "' is not a joint of this limb",
                     suggestion(lines.joint->name, names(limb_.joints)));
  }

  FeaturePart part_of(const FeatureLines& lines, const Limb& limb, std::size_t joint) const {
    const bool is_after = lines.part == PartSide::after;
    if (!is_after) {
      return {joint, joint == 0 ? mechanism_.bodies[limb.from].home : limb.joints[joint - 1].at_home, false};
    }
    const bool is_last = joint + 1 == limb.joints.size();
    return {joint + 1, is_last ? mechanism_.bodies[limb.to].home : limb.joints[joint].at_home, !is_last};
  }

  static bool slides(const Joint& joint) {
    return joint.kind == JointKind::prismatic || joint.kind == JointKind::helical ||
           joint.kind == JointKind::cylindrical;
  }

  /// The other end, at home, of the part on this side of a joint. It is the point of the next joint on this side that
  /// does not slide, because the point of a sliding joint does not show where a part ends. If no such joint follows, it
  /// is the origin of the body at the end of the limb; if none precedes, there is no value.
  std::optional<Vector3> other_end(PartSide side, const Limb& limb, std::size_t joint) const {
    if (side == PartSide::after) {
      for (std::size_t j = joint + 1; j < limb.joints.size(); ++j) {
        if (!slides(limb.joints[j])) return limb.joints[j].at_home.p;
      }
      return mechanism_.bodies[limb.to].home.p;
    }
    for (std::size_t j = joint; j-- > 0;) {
      if (!slides(limb.joints[j])) return limb.joints[j].at_home.p;
    }
    return {};
  }

  /// The text that says how an error along the direction of a distance changes the part. It makes the part longer if
  /// the direction leads from the other end of the part to the joint, and shorter if it leads from the joint to that
  /// end. Otherwise the text only states that the error is along the direction, as for a part of the base and for a
  /// joint that slides.
  std::string distance_text(const FeatureLines& lines, const FeatureFrame& at, const Limb& limb,
                            std::size_t joint) const {
    constexpr double kMostlyAlong = 0.966;  // cosine of 15 deg, the largest angle from the line to the other end
    const std::string off = "is off along its direction";
    const auto end = slides(limb.joints[joint]) ? std::nullopt : other_end(lines.part, limb, joint);
    if (!end) return off;
    const Vector3 across = *end - at.middle;
    if (across.norm() <= kRounding) return off;
    const double along = at.axes.col(0).dot(across);
    if (along > kMostlyAlong * across.norm()) return off + ", which makes its part shorter";
    return along < -kMostlyAlong * across.norm() ? "is too long" : off;
  }

  Vector3 middle_of(const FeatureLines& lines, const Limb& first, std::size_t joint) const {
    if (lines.at) return numbers_.point(*lines.at);
    if (!lines.at_point) return first.joints[joint].at_home.p;
    const Reference& name = *lines.at_point;
    const auto other = std::ranges::find(first.joints, name.name, &Joint::name);
    if (other != first.joints.end()) return other->at_home.p;
    std::vector<std::string_view> known = names(limb_.joints);
    for (const std::vector<NamedPoint>* list : {&limb_.points, &numbers_.file().points}) {
      const auto found = std::ranges::find(*list, name.name, &NamedPoint::name);
      if (found != list->end()) return numbers_.point(found->point);
      for (const NamedPoint& one : *list) known.push_back(one.name);
    }
    throw InputError(name.place,
                     name.key + " '" + printable(name.name) + "' is neither a joint of this limb nor a point",
                     suggestion(name.name, known));
  }

  FeatureFrame frame_in_first(const FeatureLines& lines, const Limb& first, std::size_t joint) const {
    const Matrix3& of_joint = first.joints[joint].at_home.R;
    const Vector3 middle = middle_of(lines, first, joint);
    if (lines.direction) {
      const Vector3 x = numbers_.direction(*lines.direction);
      const Vector3 other = parallel(x, Vector3::UnitZ()) ? Vector3::UnitX() : Vector3::UnitZ();
      return {frame_of(x, perpendicular(other, x)), middle};
    }
    const Vector3 z = lines.z ? numbers_.direction(*lines.z) : Vector3(of_joint.col(2));
    const Vector3 x = lines.x ? numbers_.direction(*lines.x) : Vector3(of_joint.col(0));
    if (!parallel(x, z)) return {frame_of(perpendicular(x, z), z), middle};
    throw InputError(lines.x ? lines.x->place : lines.z->place, lines.key + " '" + lines.name + "' has x parallel to z",
                     "write another x");
  }

  /// A positive size, zone or clearance (m). It must not be so small that slopes or standard deviations derived from it
  /// leave the range of doubles.
  double size(const Expression& expression) const {
    const double value = numbers_.positive(expression, kLength);
    if (value >= kSmallestSize) return value;
    throw InputError(expression.place, expression.key + " '" + expression.text + "' is below 1e-09 mm",
                     "write a size that a drawing may have");
  }

  /// The sizes and zones of a feature, before its limb and frame are known.
  Feature described(const FeatureLines& lines) const {
    Feature feature{.name = {}, .label = lines.name, .limb = 0, .frame = 0, .kind = kind_of(lines)};
    feature.one_direction = lines.shape == ZoneShape::planes;
    if (lines.length) feature.size[0] = size(*lines.length);
    if (lines.nominal_size) feature.size[0] = size(*lines.nominal_size);
    if (lines.diameter) feature.size.fill(size(*lines.diameter));
    for (std::size_t k = 0; k < lines.size.size(); ++k) feature.size[k] = size(lines.size[k]);
    for (const ZoneLines& zone : lines.zones) {
      const double width = zone.is_general() ? general_size(zone, feature, numbers_.file().general) : size(zone.size);
      const Zone made{zone.key, width, zone.datums};
      const bool turns_only = zone_class(zone.key, feature.kind) == ZoneClass::orientation;
      (turns_only ? feature.orientation : feature.location) = made;
    }
    return feature;
  }

  chain::ErrorTerms terms(const FeatureError& error, const FeatureFrame& at, const FeaturePart& part,
                          std::size_t limb) const {
    const Transform inside = part.datum.inverse() * Transform{at.axes, at.middle};
    const Vector3 turn = inside.R * error.turn;
    const Vector3 arm = inside.p.cross(turn);
    const Vector3 shift = inside.R * error.shift + arm;
    const double shift_size = std::max(error.shift.norm(), inside.p.norm() * turn.norm());
    chain::ErrorTerms list;
    for (std::size_t component = 0; component < 6; ++component) {
      const auto axis = static_cast<Index>(component % 3);
      const double entry = component < 3 ? turn[axis] : shift[axis];
      const double size = component < 3 ? turn.norm() : shift_size;
      if (std::abs(entry) <= kRounding * size) continue;
      list.push_back({limb, part.frame, component, part.inverse ? -entry : entry});
    }
    return list;
  }

  /// The clearance of a named fit. Every fit that fit() accepts has a clearance.
  static Clearance by_fit(const ClearanceLines& lines) {
    try {
      const Fit found = fit(lines.fit);
      return {found.most, found.mean * found.mean + found.variance};
    } catch (const std::invalid_argument& error) {
      throw InputError(lines.fit_place, lines.axis.key + ".fit " + error.what(),
                       "write the size and both classes, e.g. \"8 H7/g6\", or least = and most =");
    }
  }

  Clearance by_ends(const ClearanceLines& lines) const {
    const double least = numbers_.length(*lines.least);
    const double most = size(*lines.most);
    if (least < 0.0 || least > most) {
      throw InputError(lines.least->place, lines.least->key + " '" + lines.least->text + "' is not between 0 and most",
                       "write the smaller clearance first; a pin that is pressed in has none");
    }
    const double mean = 0.5 * (least + most);
    const double sigma = (most - least) / 6.0;
    return {most, mean * mean + sigma * sigma};
  }

  /// The feature for the axis of a joint with clearance. The diameters of a fit, or the clearance between `least` and
  /// `most`, are normally distributed; half the range between their limits is three standard deviations.
  Feature loose(const ClearanceLines& lines) const {
    Feature feature = described(lines.axis);
    feature.clearance = lines.fit.empty() ? by_ends(lines) : by_fit(lines);
    feature.clearance->touches = lines.contact == Contact::boundary;
    return feature;
  }

  void add_one(const FeatureLines& lines, Feature feature, std::size_t first, std::size_t copy) {
    const Limb& limb = mechanism_.limbs[first + copy];
    const std::size_t joint = joint_of(lines);
    FeatureFrame at = frame_in_first(lines, mechanism_.limbs[first], joint);
    const Transform turn = turned(limb_.copies, copy);
    at = {turn.R * at.axes, turn.R * at.middle};
    const FeaturePart part = part_of(lines, limb, joint);
    const std::string number = std::to_string(first + copy + 1);
    feature.name = lines.name + "_" + number;
    feature.limb = first + copy + 1;
    feature.frame = part.frame;
    for (const FeatureError& error : errors_of(lines, feature)) {
      const std::string text =
          lines.direction ? distance_text(lines, at, limb, joint) : error.text + axis_text(error, at.axes);
      (error.is_tilt ? feature.tilt : feature.middle).emplace_back(mechanism_.factors.size());
      Factor factor{feature_error_name(lines.name, name(error.direction), feature.limb), Dimension::length,
                    feature.limb, part.frame, fmt::format("{} of limb {} {}", lines.name, limb.label, text)};
      add_error(std::move(factor), terms(error, at, part, first + copy), {lines.name, lines.key, lines.place},
                mechanism_);
    }
    mechanism_.features.push_back(std::move(feature));
    mechanism_.feature_places.push_back(part.datum.inverse() * Transform{at.axes, at.middle});
  }

  const Numbers& numbers_;
  const LimbLines& limb_;
  Mechanism& mechanism_;
};

}  // namespace

void add_features(const Numbers& numbers, Mechanism& mechanism) {
  std::size_t first = 0;
  for (const LimbLines& limb : numbers.file().limbs) {
    FeatureBuilder(numbers, limb, mechanism).add(first);
    first += limb.copies.count;
  }
}

}  // namespace poesy::file
