#include "models/file/structure.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <optional>
#include <utility>

namespace poesy::file {
namespace {

/// A number (component of a direction, or a length in mm, or an angle in deg) below this is shown as 0.
constexpr double kNothing = 5e-7;
constexpr double kMillimetres = 1e3;

std::string number_text(double value) { return fmt::format("{:.6g}", std::abs(value) < kNothing ? 0.0 : value); }

std::string_view motion_text(const Joint& joint) {
  switch (joint.motion) {
    case Motion::fixed:
      return "fixed";
    case Motion::revolute:
      return joint.actuated ? "R, actuated" : "R";
    case Motion::prismatic:
      return joint.actuated ? "P, actuated" : "P";
    case Motion::helical:
      return joint.actuated ? "H, actuated" : "H";
  }
  return {};
}

std::string frame_line(const std::string& place, const std::string& name, std::string_view motion,
                       const Transform& frame) {
  return fmt::format("  {:<8} {:<10} {:<12} {:<32} {:<32} {}\n", place, name, motion,
                     triple_text(kMillimetres * frame.p), triple_text(frame.R.col(2)), triple_text(frame.R.col(0)));
}

std::string counted(std::size_t count, std::string_view one, std::string_view more) {
  return fmt::format("{} {}", count, count == 1 ? one : more);
}

/// The difference in mobility between a pose and home, as text; empty if there is none.
std::string difference(const Mobility& home, const PoseMobility& at) {
  if (!at.reached()) return "out of reach: " + at.tracked.unreachable;
  const Mobility& found = at.mobility;
  if (found.rank != home.rank) return fmt::format("rank {}", found.rank);
  if (found.platform_freedoms != home.platform_freedoms) {
    return counted(found.platform_freedoms, "freedom of the platform", "freedoms of the platform");
  }
  return {};
}

std::string pose_text(std::span<const Coordinate> coordinates, std::span<const double> pose) {
  std::string text;
  for (std::size_t c = 0; c < pose.size(); ++c) {
    text +=
        (text.empty() ? "" : ", ") + coordinates[c].name + " = " + readable_text({pose[c], coordinates[c].dimension()});
  }
  return text;
}

SketchVector sketched(const Vector3& vector) { return {vector.x(), vector.y(), vector.z()}; }

/// Text with a line for each named drive.
std::string drive_lines(const Mechanism& mechanism) {
  std::string text;
  const std::vector<const Joint*> joints = moving_joints(mechanism);
  for (const Drive& drive : drives_of(mechanism)) {
    if (joints[drive.joints.front()]->drive.empty()) continue;
    text += fmt::format("  Drive {} moves {}{}.\n", drive.name, joints_text(mechanism, drive),
                        drive.is_shared() ? ", all by the same displacement from home" : "");
  }
  return text;
}

/// Returns true if the mechanism has errors in frames `first` to `last` of a limb.
bool has_errors(const Mechanism& mechanism, std::size_t limb, std::size_t first, std::size_t last) {
  const auto is_there = [&](const chain::ErrorTerm& term) {
    return term.limb == limb && term.frame >= first && term.frame <= last;
  };
  return std::ranges::any_of(mechanism.terms,
                             [&](const chain::ErrorTerms& terms) { return std::ranges::any_of(terms, is_there); });
}

/// Text with a line for each limb, if the mechanism is branched; else empty.
std::string limb_lines(const Mechanism& mechanism) {
  std::string text;
  if (!mechanism.is_branched()) return text;
  for (std::size_t i = 0; i < mechanism.limbs.size(); ++i) {
    const Limb& limb = mechanism.limbs[i];
    text += fmt::format("  Limb {}{} leads from {} to {}.\n", i + 1,
                        limb.label == std::to_string(i + 1) ? "" : ", " + limb.label + ",",
                        mechanism.bodies[limb.from].name, mechanism.bodies[limb.to].name);
  }
  return text;
}

/// The zones of a feature as text: "position 0.05 mm to A|B, perpendicularity 0.02 mm to A".
std::string zones_text(const Feature& feature) {
  std::vector<std::string> list;
  for (const std::optional<Zone>& zone : {feature.location, feature.orientation}) {
    if (!zone) continue;
    list.push_back(fmt::format("{} {:.6g} mm{}", zone->key, kMillimetres * zone->size,
                               zone->datums.empty() ? "" : " to " + zone->datums));
  }
  if (feature.clearance) list.push_back("clearance up to " + small_length_text(feature.clearance->most));
  return fmt::format("{}", fmt::join(list, ", "));
}

/// The outline of a feature as points in its own axes, m.
std::vector<Vector3> outline_of(const Feature& feature) {
  constexpr int kCorners = 16;  // number of corners that show a round face
  const double a = 0.5 * feature.size[0];
  const double b = 0.5 * feature.size[1];
  std::vector<Vector3> outline;
  switch (feature.kind) {
    case FeatureKind::axis:
      return {{0.0, 0.0, -a}, {0.0, 0.0, a}};
    case FeatureKind::rectangle:
      return {{-a, -b, 0.0}, {a, -b, 0.0}, {a, b, 0.0}, {-a, b, 0.0}};
    case FeatureKind::round:
      for (int k = 0; k < kCorners; ++k) {
        const double angle = 2.0 * std::numbers::pi * k / kCorners;
        outline.emplace_back(a * std::cos(angle), a * std::sin(angle), 0.0);
      }
      return outline;
    case FeatureKind::point:
    case FeatureKind::distance:
      break;
  }
  return {Vector3::Zero()};
}

SketchedFeature sketched_feature(const Mechanism& mechanism, std::size_t f) {
  const Feature& feature = mechanism.features[f];
  const std::size_t joints = mechanism.limbs[feature.limb - 1].joints.size();
  SketchedFeature sketch{.name = feature.label,
                         .zones = zones_text(feature),
                         .limb = feature.limb - 1,
                         .frame = feature.frame == joints ? joints + 1 : feature.frame,
                         .outline = {}};
  const Transform& place = mechanism.feature_places[f];
  for (const Vector3& point : outline_of(feature)) sketch.outline.push_back(sketched(place.R * point + place.p));
  return sketch;
}

}  // namespace

std::string triple_text(const Vector3& value) {
  return fmt::format("({}, {}, {})", number_text(value.x()), number_text(value.y()), number_text(value.z()));
}

std::string small_length_text(double metres) {
  const double millimetres = kMillimetres * metres;
  return millimetres < 0.01 ? fmt::format("{:.2g} um", 1e3 * millimetres) : fmt::format("{:.2g} mm", millimetres);
}

std::string coordinate_text(const Coordinate& coordinate) {
  const std::string axis(1, "xyz"[coordinate.component % 3]);
  if (coordinate.component < 3) return axis + " of the platform's origin in the base frame";
  return "r" + axis + ", a rotation of the platform from home";
}

Sketch sketch_of(const Mechanism& mechanism) {
  Sketch sketch{.limbs = {}, .platform = sketched(mechanism.platform.p), .tool = {}};
  if (mechanism.tool) sketch.tool.push_back(sketched(mechanism.platform.p + mechanism.platform.R * *mechanism.tool));
  for (std::size_t i = 0; i < mechanism.limbs.size(); ++i) {
    std::span<const Joint> joints = mechanism.limbs[i].joints;
    std::vector<SketchedJoint> limb;
    for (std::size_t j = 0; j < joints.size();) {
      std::size_t end = j + 1;
      while (end < joints.size() && joints[end].name == joints[j].name) ++end;
      const std::span<const Joint> one = joints.subspan(j, end - j);
      const bool actuated = std::ranges::any_of(one, &Joint::actuated);
      limb.push_back({one.front().name, letter(one.front().kind), actuated, sketched(one.front().at_home.p),
                      sketched(one.front().at_home.R.col(2)), has_errors(mechanism, i, j == 0 ? 0 : end, end), j + 1,
                      j + 1, one.front().drive});
      j = end;
    }
    sketch.limbs.push_back(std::move(limb));
    sketch.labels.push_back(mechanism.limbs[i].label);
  }
  for (std::size_t f = 0; f < mechanism.features.size(); ++f) sketch.features.push_back(sketched_feature(mechanism, f));
  if (!mechanism.is_branched()) return sketch;
  for (const Limb& limb : mechanism.limbs) sketch.ends.push_back({limb.from, limb.to});
  for (const assembly::Body& body : mechanism.bodies) sketch.bodies.push_back({body.name, sketched(body.home.p)});
  return sketch;
}

std::vector<std::string> home_outside(const Mechanism& mechanism) {
  const PlatformPose home = home_pose(mechanism);
  std::vector<std::string> list;
  for (const Coordinate& coordinate : mechanism.coordinates) {
    const double value = home[coordinate.component];
    if (value >= coordinate.lower && value <= coordinate.upper) continue;
    const auto text = [&](double si) { return readable_text({si, coordinate.dimension()}); };
    list.push_back(fmt::format("home has {} = {}, outside the workspace from {} to {} (coordinates are absolute)",
                               coordinate.name, text(value), text(coordinate.lower), text(coordinate.upper)));
  }
  return list;
}

std::vector<std::string> loads_without_effect(const Mechanism& mechanism) {
  if (mechanism.is_elastic() || !mechanism.load.acts_on(mechanism.bodies)) return {};
  return {"the load has no effect, because no joint, link or limb has stiffness"};
}

std::vector<std::string> odd_tool(const Mechanism& mechanism) {
  constexpr double kNear = 0.3;  // share of the distance between the base's origin and the platform's
  if (!mechanism.tool) return {};
  const Vector3& tool = *mechanism.tool;
  const Vector3& origin = mechanism.platform.p;
  const auto mm = [](const Vector3& point) { return triple_text(kMillimetres * point) + " mm"; };
  if (tool.norm() > mechanism.reach) {
    return {fmt::format("the tool is {} from the platform's origin, and the mechanism's reach is {}",
                        readable_text({tool.norm(), Dimension::length}),
                        readable_text({mechanism.reach, Dimension::length}, 4))};
  }
  if (origin.norm() > kNear * mechanism.reach && (tool - origin).norm() < kNear * origin.norm()) {
    return {
        fmt::format("the tool is at {} from the platform's origin, which is itself at {} in the base's frame (the "
                    "tool is stated in the platform's frame, not in the base's)",
                    mm(tool), mm(origin))};
  }
  return {};
}

std::vector<std::string> wide_turns(const Mechanism& mechanism) {
  constexpr double kFullTurn = 2.0 * std::numbers::pi * (1.0 + 1e-9);  // up to rounding
  std::vector<std::string> list;
  for (const Coordinate& coordinate : mechanism.coordinates) {
    if (coordinate.dimension() != Dimension::angle || coordinate.upper - coordinate.lower <= kFullTurn) continue;
    const auto text = [&](double value) { return readable_text({value, Dimension::angle}, 4); };
    list.push_back(fmt::format("the workspace has {} from {} to {}, more than a full turn", coordinate.name,
                               text(coordinate.lower), text(coordinate.upper)));
  }
  return list;
}

/// Returns true if the points of two joints are one point, up to the rounding of numbers in files.
static bool are_at_one_point(const Joint& a, const Joint& b, double reach) {
  constexpr double kRounding = 1e-6;  // share of the reach
  return (a.at_home.p - b.at_home.p).norm() <= kRounding * reach;
}

/// The first joint of type R, U or S in this range if it is U or S, and so the end of a leg; otherwise none. Joints
/// that slide are left out, because their points need not be ends of anything.
static const Joint* end_of_leg(auto first, auto last) {
  for (; first != last; ++first) {
    if (first->kind == JointKind::universal || first->kind == JointKind::spherical) return &*first;
    if (first->kind == JointKind::revolute) return nullptr;
  }
  return nullptr;
}

/// Returns true if another joint of the limb turns at the point of this universal joint. Both together may be a
/// spherical joint, in which any axis may lie along a leg.
static bool is_part_of_sphere(const Joint& universal, const Limb& limb, double reach) {
  return std::ranges::any_of(limb.joints, [&](const Joint& other) {
    return other.motion == Motion::revolute && other.name != universal.name &&
           are_at_one_point(other, universal, reach);
  });
}

/// The clause of axes_along_legs() about the axis `key` of a joint of this limb. end: joint at the other end of the
/// leg. Empty if `end` is null, or if the axis is at 20 deg or more to the leg.
static std::string along_leg_text(std::string_view key, const Joint& joint, const Joint* end, const Limb& limb) {
  constexpr double kAlong = 20.0;  // deg
  if (end == nullptr) return {};
  const Vector3 axis = joint.at_home.R.col(2);
  const Vector3 line = end->at_home.p - joint.at_home.p;
  const double angle = std::atan2(axis.cross(line).norm(), std::abs(axis.dot(line))) * 180.0 / std::numbers::pi;
  if (angle >= kAlong) return {};
  return fmt::format(
      "{} of joint {} of limb {} is at {:.3g} deg to the line to joint {}, so the leg can swing about the "
      "other axis only (the axis on the leg's side usually lies across the leg)",
      key, joint.name, limb.label, angle, end->name);
}

std::vector<std::string> axes_along_legs(const Mechanism& mechanism) {
  for (const Limb& limb : mechanism.limbs) {
    const std::span<const Joint> joints = limb.joints;
    for (std::size_t j = 0; j + 1 < joints.size(); ++j) {
      if (joints[j].kind != JointKind::universal || joints[j + 1].name != joints[j].name) continue;
      if (is_part_of_sphere(joints[j], limb, mechanism.reach)) continue;
      const std::span<const Joint> below = joints.first(j);
      const std::span<const Joint> above = joints.subspan(j + 2);
      const Joint* const before = end_of_leg(below.rbegin(), below.rend());
      const Joint* const after = end_of_leg(above.begin(), above.end());
      for (const std::string& text :
           {along_leg_text("axis", joints[j], before, limb), along_leg_text("axis2", joints[j + 1], after, limb)}) {
        if (!text.empty()) return {text};
      }
    }
  }
  return {};
}

std::string joints_text(const Mechanism& mechanism, const Drive& drive) {
  std::vector<std::string> list;
  std::size_t k = 0;
  for (std::size_t i = 0; i < mechanism.limbs.size(); ++i) {
    for (const Joint& joint : mechanism.limbs[i].joints) {
      if (!joint.moves()) continue;
      if (std::ranges::find(drive.joints, k++) == drive.joints.end()) continue;
      list.push_back(fmt::format("joint {} of limb {}", joint.name, mechanism.limbs[i].label));
    }
  }
  return fmt::format("{}", fmt::join(list, " and "));
}

std::vector<std::string> unlike_limbs(const Mechanism& mechanism) {
  std::vector<std::string> list;
  for (const EachLimb& each : mechanism.each) {
    if (!each.alike) list.push_back(each.text + ", and these limbs have other joints than each other");
  }
  return list;
}

std::vector<std::string> rounding_remarks(const Mechanism& mechanism, double mismatch) {
  if (!mechanism.precision.rounded()) return {};
  return {
      fmt::format("the file's numbers leave up to {} between the limbs at poses of the workspace; a pose is where "
                  "they fit each other best, and errors are counted from there",
                  small_length_text(mismatch))};
}

static std::string sliding_joints_note(const Mechanism& mechanism) {
  const bool has_one = std::ranges::any_of(mechanism.limbs, [](const Limb& limb) {
    return std::ranges::any_of(limb.joints, [](const Joint& joint) { return joint.motion == Motion::prismatic; });
  });
  return has_one
             ? "  The point of a P joint does not change how it slides, but errors of its frame turn about it, and its "
               "features\n  are there: give the joint or the feature the point (at) of the part that is meant.\n"
             : "";
}

std::string structure_text(const Mechanism& mechanism) {
  std::string text =
      fmt::format("  {:<8} {:<10} {:<12} {:<32} {:<32} {}\n", "frame", "joint", "type", "point (mm)", "z", "x");
  for (std::size_t i = 0; i < mechanism.limbs.size(); ++i) {
    const std::vector<Joint>& joints = mechanism.limbs[i].joints;
    for (std::size_t j = 0; j < joints.size(); ++j) {
      text += frame_line(fmt::format("{}_{}", i + 1, j + 1), joints[j].name, motion_text(joints[j]), joints[j].at_home);
    }
  }
  const auto on_platform = [&](const Vector3& place) {
    return mechanism.platform * Transform{lie::Matrix3<double>::Identity(), place};
  };
  text += frame_line("platform", "P", "", mechanism.platform);
  if (mechanism.tool) text += frame_line("tool", "tip", "", on_platform(*mechanism.tool));
  for (const NamedPlatformPoint& point : mechanism.named) {
    text += frame_line("point", point.name, "", on_platform({point.place[0], point.place[1], point.place[2]}));
  }
  for (std::size_t b = kPlatform + 1; b < mechanism.bodies.size(); ++b) {
    text += frame_line("body", mechanism.bodies[b].name, "", mechanism.bodies[b].home);
  }
  text += limb_lines(mechanism);
  text += drive_lines(mechanism);
  text +=
      "  Frame i_j is that of joint j of limb i, with z about or along the joint and x towards the next joint's\n"
      "  point, made perpendicular to z; S is three R, of which the first lies along the line from the joint "
      "before.\n";
  const char* end = mechanism.is_branched() ? "body at the limb's end" : "platform";
  text += fmt::format(
      "  An error of frame i_j moves frame i_(j+1) against frame i_j. One of the last frame moves it against "
      "the\n  {}, in the axes there: the {} goes the other way.\n",
      end, end);
  text += fmt::format("  Angles of a limb's first and last frame turn about the {}.\n",
                      mechanism.about == ErrorsAbout::joint ? "points of its first and last joint"
                      : mechanism.is_branched()             ? "origins of the bodies there"
                                                            : "origins of base and platform");
  text += sliding_joints_note(mechanism);
  for (const EachLimb& each : mechanism.each) text += "  " + each.text + ".\n";
  return text;
}

std::vector<std::string> mobility_lines(const Mechanism& mechanism, const Mobility& home,
                                        std::span<const PoseMobility> poses) {
  constexpr std::size_t kMostPoses = 3;
  std::vector<std::string> lines;
  const std::string by = home.drives == home.actuated ? "" : " by " + counted(home.drives, "drive", "drives");
  lines.push_back(fmt::format("{} ({} actuated{}), rank {} of {} loop equations: {}, {}",
                              counted(home.joints, "joint", "joints"), home.actuated, by, home.rank,
                              home.loop_equations, counted(home.freedoms, "freedom", "freedoms"),
                              counted(home.over_constraints, "over-constraint", "over-constraints")));
  const std::size_t locked = home.loop_equations - home.passive_rank;
  if (locked != home.over_constraints) {
    lines.back() += fmt::format(", {} with the drives locked", locked);
  }
  lines.push_back(
      fmt::format("the platform has {}, of which {} rotate; {}; locking the drives leaves {}",
                  counted(home.platform_freedoms, "freedom", "freedoms"), home.platform_rotates,
                  counted(home.idle, "idle freedom", "idle freedoms"),
                  home.left_when_locked == 0 ? std::string("none") : fmt::format("{} idle", home.left_when_locked)));
  const std::optional<double> below = home.below_gap();
  std::string gap = fmt::format("singular values on both sides of the rank, lengths in units of the reach: {} | {}",
                                home.rank > 0 ? fmt::format("{:.3g}", home.above_gap()) : "none",
                                below ? fmt::format("{:.1e}", *below) : "none");
  if (mechanism.precision.rounded()) {
    gap += fmt::format("; the file's numbers are rounded, so those below {:.1e} of the largest count as zero",
                       mechanism.precision.rank_threshold);
  }
  lines.push_back(std::move(gap));
  std::size_t different = 0;
  for (const PoseMobility& at : poses) {
    const std::string what = difference(home, at);
    if (what.empty()) continue;
    if (++different > kMostPoses) continue;
    lines.push_back(fmt::format("pose ({}): {}", pose_text(mechanism.coordinates, at.pose), what));
  }
  double turned = 0.0;
  double moved = 0.0;
  for (const PoseMobility& at : poses) {
    turned = std::max(turned, at.turned);
    moved = std::max(moved, at.moved);
  }
  lines.push_back(
      fmt::format("the same at {} of {} poses tried in the workspace", poses.size() - different, poses.size()));
  lines.push_back(fmt::format(
      "there, beside its coordinates, the platform moves by up to {} mm and turns by an angle of up to {} deg",
      number_text(kMillimetres * moved), number_text(turned * 180.0 / std::numbers::pi)));
  return lines;
}

}  // namespace poesy::file
