#include "models/file/mechanism_file.h"

#include <algorithm>
#include <stdexcept>
#include <tuple>

#include "engine/base/text.h"
#include "engine/schema/own_response_keys.h"
#include "engine/schema/toml_text.h"
#include "models/file/file_rows.h"
#include "models/file/mechanism.h"

namespace poesy::file {
namespace {

/// The limits for all limbs of a mechanism together. The time of rank computations grows with the cube of the number of
/// moving axes, and the length of descriptions grows with the square of the number of frames.
/// @{
constexpr std::size_t kMostMovingAxes = 120;
constexpr std::size_t kMostFrames = 1000;
/// @}
constexpr std::array<std::string_view, 6> kCoordinates{"x", "y", "z", "rx", "ry", "rz"};
constexpr std::array<std::string_view, 6> kComponents{"epsilon_x", "epsilon_y", "epsilon_z",
                                                      "delta_x",   "delta_y",   "delta_z"};

std::vector<NamedPoint> points(const StudyValue& value) {
  const StudySection section = value.section();
  std::vector<NamedPoint> list;
  for (const Reference& name : keys_in_order(section)) list.push_back({name.name, point(*section.find(name.name))});
  return list;
}

// ---- joints and limbs

void read_at(const StudyValue& value, JointLines& joint) {
  if (value.is_text()) {
    joint.at_point = reference(value);
  } else {
    joint.at = point(value);
  }
}

/// Reads the name of a drive. In each copy of the limb, the number of the copy replaces "*" in this name.
void read_drive(const StudyValue& value, JointLines& joint) {
  if (elements(joint.kind) > 1) {
    value.fail("is a text, but a joint of type " + std::string(name(joint.kind)) + " has two axes",
               "write two joints of one axis each, of which the driven one names its drive");
  }
  Reference drive = reference(value);
  for (const std::string_view answer : {"true", "false", "yes", "no"}) {
    if (drive.name == answer) value.fail("is the text '" + drive.name + "'", "write true or false without quotes");
  }
  Reference of_copy = drive;
  std::ranges::replace(of_copy.name, '*', '1');
  check_name(of_copy);
  joint.drive = std::move(drive);
  joint.actuated[0] = true;
}

/// Reads `actuated`. Its value is true for joints with one axis or for both axes of C; 1 or 2 for one axis of C or U;
/// or, for joints with one axis, the name of a drive.
void read_actuated(const StudyValue& value, JointLines& joint) {
  if (value.is_text()) return read_drive(value, joint);
  const std::size_t axes = elements(joint.kind);
  if (const std::optional<bool> all = value.boolean()) {
    if (*all && joint.kind == JointKind::universal) value.fail("is true", "write 1 or 2, for its first or second axis");
    joint.actuated = {*all, *all && axes == 2};
    return;
  }
  if (axes == 1) value.fail("must be true, false or a name", "write true, false, or the name of its drive");
  joint.actuated[static_cast<std::size_t>(value.whole_number(1, 2) - 1)] = true;
}

/// The key `axis2`.
Row<JointLines> second_axis() {
  Row<JointLines> row = needed("axis2", kept("direction", direction, &JointLines::axis2), "\"y\"",
                               "Its second axis, in the order from the base, not parallel to `axis`. The axis on the "
                               "leg's side lies across the leg; at the platform's end of a leg it is `axis`.",
                               {"U"});
  row.missing = "write its second axis, across the leg, e.g. {}";
  return row;
}

const Keys<JointLines, Nothing>& joint_keys() {
  using J = JointLines;
  const std::vector<std::string_view> directed{"R", "P", "H", "C", "U", "fixed"};
  const auto kinds = word_at<JointKind>({{JointKind::revolute, "revolute"},
                                         {JointKind::prismatic, "prismatic"},
                                         {JointKind::helical, "helical: slides as it turns"},
                                         {JointKind::cylindrical, "cylindrical: R, then P on the same axis"},
                                         {JointKind::universal, "universal: two axes through one point"},
                                         {JointKind::spherical,
                                          "spherical: three revolutes, the first along the line "
                                          "from the joint before"},
                                         {JointKind::fixed, "no motion: a frame that has errors"}},
                                        &J::kind);
  static const Keys<J, Nothing> keys{
      .paths = {"limb.joints"},
      .meaning =
          "A joint, at home and in the base frame. poesy replaces each joint by a series of revolute, prismatic and "
          "helical joints, which act about or along their own z axes.",
      .chooser = "type",
      .rows = {
          needed("type", kinds, "\"R\"", "What the joint does."),
          needed("name", kept("text", read_name, &J::name), "\"A\"", "Its name, once in a limb."),
          optional("at", read_by("point", read_at), "the point `from` of P, H and C",
                   "Where it stands: [x, y, z], or the name of a point."),
          optional("from", kept("text", reference, &J::from), "", "With `to`, its direction: from this joint or point.",
                   directed),
          optional("to", kept("text", reference, &J::to), "", "With `from`, its direction: to this joint or point.",
                   directed),
          optional("axis", kept("direction", direction, &J::axis), "",
                   "Its direction, without `from` and `to`: \"x\", \"-z\", or [x, y, z] of any length.", directed),
          second_axis(),
          optional("x", kept("direction", direction, &J::x), "towards the next joint's point",
                   "The x axis of its first frame, made perpendicular to z."),
          needed("pitch", kept("length", expression, &J::pitch), "\"5 mm\"",
                 "By how much it slides in one turn; positive for a right-handed thread.", {"H"}),
          optional(
              "actuated", read_by("true, 1, 2 or text", read_actuated), "`false`",
              "Whether a drive holds it; of U the axis that is held, of C the turn (1), the slide (2) or both (true). "
              "Of R, P and H a text is the name of its drive: joints of one name, in any limbs, are moved by one "
              "drive, all by the same displacement from home. A * in the name is the number of the limb's copy; "
              "without it all copies have one drive.",
              {"R", "P", "H", "C", "U"}),
          optional("stiffness", kept("table", read_stiffness, &J::stiffness), "rigid",
                   "Of its bearing and drive, in its first frame before its motion."),
          optional("reaction",
                   kept(
                       "true or false", [](const StudyValue& value) { return value.yes_or_no(); }, &J::reaction),
                   "`false`",
                   "`true`: the force and the moment that the side of `from` exerts on that of `to` are responses "
                   "(needs stiffness).")}};
  return keys;
}

std::vector<JointLines> joints(const StudyValue& value) {
  std::vector<JointLines> list;
  std::unordered_set<std::string> names;
  for (const StudyValue& element : value.list()) {
    JointLines joint;
    joint.key = element.full_name();
    joint.place = element.place();
    const StudySection section = element.section();
    read_keys(joint_keys(), section, joint, Nothing{});
    const StudyValue name = section.require("name");
    add_name({joint.name, name.full_name(), name.place()}, names, "joint of this limb");
    list.push_back(std::move(joint));
  }
  if (list.empty()) value.fail("is empty", "write its joints from base to platform");
  return list;
}

/// The value of the key `limb` in [[error]] with which the error acts in all limbs.
constexpr std::string_view kEach = "each";

std::string read_limb_name(const StudyValue& value) {
  const auto is_letter = [](unsigned char c) { return std::isalpha(c) != 0; };
  const std::string name = read_name(value);
  if (std::ranges::none_of(name, is_letter)) {
    value.fail("is '" + name + "', which a number could be", "give it a name with a letter");
  }
  if (name == kEach) value.fail("is 'each', which means all limbs", "give the limb another name");
  return name;
}

const Keys<LimbLines, Nothing>& limb_keys() {
  static const Keys<LimbLines, Nothing> keys{
      .paths = {"limb"},
      .meaning = "A limb, [[limb]], between two bodies.",
      .rows = {
          optional("name", kept("text", read_limb_name, &LimbLines::name), "none",
                   "Its name, by which [[error]] may call it and its copies."),
          optional("from", kept("text", reference, &LimbLines::from), "`\"base\"`",
                   "The body where it begins; its frame 0 leads from that body's frame to the first joint."),
          optional("to", kept("text", reference, &LimbLines::to), "`\"platform\"`",
                   "The body where it ends. At every body at least one limb ends."),
          optional("copies", kept("table", read_copies, &LimbLines::copies), "one",
                   "Limbs alike, turned about an axis of the base."),
          optional("points", kept("table", points, &LimbLines::points), "none",
                   "Points of this limb alone, as in [points]."),
          needed(
              "joints", kept("list of tables", joints, &LimbLines::joints),
              "[ { name = \"A\", type = \"R\", at = [0, 0, 0], axis = \"y\" } ]",
              "Its joints, in the order from `from` to `to`. All limbs together have at most 120 moving axes and 1000 "
              "frames."),
          optional("links", kept("list of tables", read_links, &LimbLines::links), "rigid",
                   "Parts between its joints that give way."),
          optional("features", kept("list of tables", read_features, &LimbLines::features), "none",
                   "Bores, faces, points and distances of its parts, with the tolerances of their drawings."),
          optional("clearances", kept("list of tables", read_clearances, &LimbLines::clearances), "none",
                   "Clearances of its joints."),
          optional("compliance", kept("list of lists", read_compliance, &LimbLines::compliance), "none",
                   "Of the whole limb, besides joints and links: 6 x 6 bare SI numbers, [rotation; translation] from "
                   "[moment; force] in the frame of `to`.")}};
  return keys;
}

/// The numbers of limbs, moving axes and frames of a mechanism so far.
struct Extent {
  std::size_t limbs = 0;
  std::size_t axes = 0;    ///< number of axes that move
  std::size_t frames = 0;  ///< number of frames of joints

  void add(const LimbLines& limb) {
    limbs += limb.copies.count;
    for (const JointLines& joint : limb.joints) {
      const std::size_t count = limb.copies.count * elements(joint.kind);
      frames += count;
      if (joint.kind != JointKind::fixed) axes += count;
    }
  }
};

/// Throws InputError if the limbs up to this one exceed the limits of a mechanism.
void check_extent(const Extent& extent, const StudyValue& limb) {
  const auto check = [&](std::string_view what, std::size_t count, std::size_t most) {
    if (count <= most) return;
    limb.fail("brings the " + std::string(what) + " of all limbs to " + std::to_string(count),
              "a mechanism may have " + std::to_string(most) + "; take fewer joints or copies");
  };
  check("moving axes", extent.axes, kMostMovingAxes);
  check("frames", extent.frames, kMostFrames);
}

/// Throws InputError if a point of the limb has the name of one of the limb's joints.
void check_names_of_points(const LimbLines& limb) {
  std::unordered_set<std::string> names;
  for (const JointLines& joint : limb.joints) names.insert(joint.name);
  for (const NamedPoint& named : limb.points) {
    add_name({named.name, named.point.key, named.point.place}, names, "joint of this limb");
  }
}

std::vector<LimbLines> limbs(const StudyValue& value) {
  std::vector<LimbLines> list;
  std::unordered_set<std::string> names;
  Extent extent;
  for (const StudyValue& element : tables(value)) {
    LimbLines limb;
    limb.key = element.full_name();
    limb.place = element.place();
    read_keys(limb_keys(), element.section(), limb, Nothing{});
    check_names_of_points(limb);
    if (!limb.name.empty()) {
      const StudyValue name = element.section().require("name");
      add_name({limb.name, name.full_name(), name.place()}, names, "limb");
    }
    extent.add(limb);
    check_extent(extent, element);
    list.push_back(std::move(limb));
  }
  if (extent.limbs < 2) value.fail("is alone, so nothing closes a loop", "write two limbs or more, or copies");
  return list;
}

// ---- platform

void read_coordinates(const StudyValue& value, PlatformLines& platform) {
  platform.coordinates_place = value.place();
  std::unordered_set<std::string> names;
  for (const StudyValue& element : value.list()) {
    CoordinateLines line;
    line.key = element.full_name();
    line.place = element.place();
    if (element.is_section()) {
      const StudySection section = element.section();
      const std::vector<std::string> keys = section.keys();
      if (keys.size() != 1) element.fail("has " + std::to_string(keys.size()) + " names", "write { alpha = \"rx\" }");
      line.name = keys.front();
      line.component = kCoordinates[section.find(line.name)->word(kCoordinates)];
    } else {
      line.name = line.component = kCoordinates[element.word(kCoordinates)];
    }
    add_name({line.name, line.key, line.place}, names, "coordinate");
    if (std::ranges::find(platform.coordinates, line.component, &CoordinateLines::component) !=
        platform.coordinates.end()) {
      element.fail("is " + line.component + " a second time", "remove it");
    }
    platform.coordinates.push_back(std::move(line));
  }
  if (platform.coordinates.empty()) value.fail("is empty", "name as many as the platform has freedoms");
}

void read_workspace(const StudyValue& value, PlatformLines& platform) {
  const StudySection section = value.section();
  section.allow(names(platform.coordinates), "coordinate");
  for (CoordinateLines& coordinate : platform.coordinates) {
    const bool length = coordinate.component.size() == 1;
    const StudyValue range =
        section.require(coordinate.name, "write " + coordinate.name +
                                             (length ? " = [\"500 mm\", \"600 mm\"]" : " = [\"-20 deg\", \"20 deg\"]"));
    const std::vector<StudyValue> ends = range.list();
    if (ends.size() != 2) range.fail("has " + std::to_string(ends.size()) + " values", "write [lowest, highest]");
    coordinate.lower = expression(ends[0]);
    coordinate.upper = expression(ends[1]);
  }
}

/// Names that points of the platform must not have, because other points or bodies have them.
constexpr std::array<std::string_view, 4> kOtherPoints{"base", "origin", "platform", "tip"};

std::vector<NamedPoint> platform_points(const StudyValue& value) {
  std::vector<NamedPoint> list = points(value);
  for (const NamedPoint& named : list) {
    if (std::ranges::find(kOtherPoints, named.name) == kOtherPoints.end()) continue;
    throw InputError(named.point.place, named.point.key + " has the name of another point",
                     named.name == "tip" ? "give it another name, or write it as tool" : "give it another name");
  }
  return list;
}

void read_metric_points(const StudyValue& value, PlatformLines& platform) {
  if (!platform.points.empty()) value.fail("is a second list of the metric's points", "remove one of them");
  platform.place = value.place();
  for (const StudyValue& element : value.list()) platform.points.push_back(point(element));
  if (platform.points.size() < 3) value.fail("has fewer than three points", "give three that are not on one line");
}

/// Reads named points from a table, or the metric's points from a list.
void read_points(const StudyValue& value, PlatformLines& platform) {
  if (!value.is_section()) return read_metric_points(value, platform);
  platform.named = platform_points(value);
}

const Keys<PlatformLines, Nothing>& platform_keys() {
  using P = PlatformLines;
  std::vector<WordFor<Rotation>> rotations{{Rotation::vector, "the rotation vector"}};
  for (const Rotation order :
       {Rotation::xyz, Rotation::xzy, Rotation::yxz, Rotation::yzx, Rotation::zxy, Rotation::zyx}) {
    rotations.push_back({order, "the product of rotations about these axes, in this order"});
  }
  static const Keys<P, Nothing> keys{
      .paths = {"platform"},
      .meaning = "What the limbs hold.",
      .rows = {
          needed("origin", kept("point", point, &P::origin), "[0, 0, \"600 mm\"]",
                 "Its origin P at home, in the base frame."),
          optional("x", kept("direction", direction, &P::x), "the base's",
                   "Its x axis at home; with `z`, to which it is made perpendicular."),
          optional("z", kept("direction", direction, &P::z), "the base's", "Its z axis at home; with `x`."),
          optional("rotation", word_at(rotations, &P::rotation), "`\"vector\"`", "What rx, ry and rz mean."),
          needed(
              "coordinates", read_by("list", read_coordinates), "[\"x\", \"y\", \"z\"]",
              "The independent ones among x, y, z (P in the base frame) and rx, ry, rz (from home), as many as it has "
              "freedoms; { alpha = \"rx\" } renames one."),
          needed("workspace", read_by("table", read_workspace), "{ z = [\"500 mm\", \"700 mm\"] }",
                 "The default workspace, with every coordinate."),
          optional("tool", kept("point", point, &P::tool), "none",
                   "A point of the platform frame whose displacement is reported in addition."),
          optional("points", read_by("table or list of points", read_points), "none",
                   "Named points of the platform frame, [platform.points], whose displacements are reported behind the "
                   "tool's; a list of points is read as `metric_points`."),
          optional(
              "metric_points", read_by("list of points", read_metric_points),
              "the point of each limb's last joint that moves",
              "Points of the platform frame by which mismatch of limbs is weighed, and for which corrections of the "
              "drives (`calibrated = true`, removable shares) are best: the root mean square of their "
              "displacements is smallest."),
          optional("mass", kept("mass", expression, &P::mass), "none", "Its mass, on which gravity acts: \"3 kg\"."),
          optional("centre", kept("point", point, &P::centre), "its origin", "Its centre of mass, in its frame.")}};
  return keys;
}

PlatformLines platform(const StudyValue& value) {
  PlatformLines lines;
  lines.place = value.place();
  read_keys(platform_keys(), value.section(), lines, Nothing{});
  if (lines.x.has_value() != lines.z.has_value()) value.fail("has one of x and z", "give both, or neither");
  return lines;
}

// ---- errors

std::vector<std::size_t> components(const StudyValue& value) {
  std::vector<std::size_t> list;
  for (const StudyValue& element : value.is_text() ? std::vector{value} : value.list()) {
    const std::size_t component = element.word(kComponents);
    if (std::ranges::find(list, component) != list.end()) element.fail("is a component a second time", "remove it");
    if (!list.empty() && list.front() / 3 != component / 3) {
      element.fail("mixes lengths and angles in one vector", "write two [[error]]");
    }
    list.push_back(component);
  }
  if (list.empty()) value.fail("is empty", "write \"delta_z\", for instance");
  return list;
}

ComponentLines component(const Reference& name, const StudyValue& value) {
  const auto known = std::ranges::find(kComponents, name.name);
  if (known == kComponents.end()) {
    value.fail("is of a component that no frame has",
               "write delta_x, delta_y, delta_z, epsilon_x, epsilon_y or "
               "epsilon_z = its share of the error");
  }
  return {static_cast<std::size_t>(known - kComponents.begin()), expression(value)};
}

/// Reads a combination of components, such as `components = { delta_x = -0.6, epsilon_y = "2 / L" }`.
std::vector<ComponentLines> combination(const StudyValue& value) {
  const StudySection section = value.section();
  std::vector<ComponentLines> list;
  for (const Reference& name : keys_in_order(section)) list.push_back(component(name, *section.find(name.name)));
  if (list.empty()) value.fail("is empty", "write { delta_z = 1 }, for instance");
  return list;
}

/// A place of an error as written, before the program knows which limbs it names.
struct WrittenPlace {
  std::optional<std::size_t> component;
  Expression scale{"1", "scale", {}, true};
  std::vector<ComponentLines> combination;
};

const Keys<WrittenPlace, Nothing>& place_keys() {
  using P = WrittenPlace;
  static const Keys<P, Nothing> keys{
      .paths = {"error.places"},
      .meaning = "A place of an error that has several: one number, drawn once, acts in all of them.",
      .rows = {
          needed<P>("limb", {.type = "integer, text or list"}, "\"each\"",
                    "As in [[error]], but all are places of one error."),
          needed<P>("frame", {.type = "integer or text"}, "0", "As in [[error]]."),
          optional("component",
                   kept(
                       "text", [](const StudyValue& value) { return value.word(kComponents); }, &P::component),
                   "", "delta_x, ..., epsilon_z of the frame."),
          optional("scale", kept("number", expression, &P::scale), "`1`", "The component is the error times this."),
          optional("components", kept("table", combination, &P::combination), "",
                   "Without `component`: several, as in [[error]].")}};
  return keys;
}

const Keys<ErrorLines, Nothing>& error_keys() {
  using E = ErrorLines;
  static const Keys<E, Nothing> keys{
      .paths = {"error"},
      .meaning = "An error with a name of its own, [[error]].",
      .rows = {
          needed("name", kept("text", reference, &E::name), "\"l\"",
                 "Its name; components of a vector append _x, _y, _z, and an error of several limbs _1, _2, ... behind "
                 "that: the copy's number where the limb is named, else the limb's."),
          optional<E>(
              "limb", {.type = "integer, text or list"}, "required without `places`",
              "The limb: its number, counted from 1, or its name, which also means its copies; a list of numbers "
              "and names; or \"each\", where all limbs have the frame. Each limb has an error of its own."),
          optional<E>(
              "frame", {.type = "integer or text"}, "required without `places`",
              "The fixed frame: 0 before the first joint, the last one to the body where the limb ends; or the name of "
              "a joint: the frame behind it. An error acts in the axes of the joint before it, and its angles turn "
              "about that joint's point; in the first frame the axes are those of the body where the limb begins, in "
              "the last one those of the body where it ends. About what angles turn there, `about` in [errors] says."),
          optional(
              "component", kept("text or list", components, &E::components),
              "required without `components` and `places`",
              "delta_x, delta_y, delta_z (lengths) or epsilon_x, epsilon_y, epsilon_z (angles) of the frame; several "
              "make a vector."),
          optional("scale", kept("number", expression, &E::scale), "`1`", "The component is the error times this."),
          optional("components", kept("table", combination, &E::combination), "",
                   "Without `component`: components that make one error together, each with its share of it: "
                   "{ delta_x = -0.6, epsilon_y = \"2 / L\" }. The shares say whether the error is a length (delta: "
                   "numbers, epsilon: 1/length) or an angle (delta: lengths, epsilon: numbers)."),
          optional<E>("places", {.type = "list of tables"}, "",
                      "Without `limb`, `frame` and `component`: the places where one error acts, of one number: "
                      "[{ limb = 1, frame = 3, component = \"delta_z\" }, ...]."),
          optional(
              "grows_with", kept("text", reference, &E::grows_with), "",
              "A joint of the limb, of type R, P or H: what the error changes is the error times the nominal "
              "displacement of this joint at the pose. The error is a number, such as that of a lead, a scale or a "
              "gear ratio: \"0.1 %\", \"50 um/m\". Where an angle grows with a length, scale = \"1 / (1 m)\" makes it "
              "one in rad/m."),
          optional("from", kept("quantity", expression, &E::from), "`0`, home",
                   "With `grows_with`: the displacement of the joint from home where the error is zero."),
          optional("description", text_at(&E::description), "what the frame's own error says", "For people.")}};
  return keys;
}

/// A limb, or a copy of a limb, to which an error may refer.
struct NamedLimb {
  const LimbLines* lines;
  std::size_t copy;  ///< number of the copy, counted from 1

  /// The index in the limb of the frame behind the joint of this name. Behind means towards the end of the limb.
  /// None if there is no such joint.
  std::optional<std::size_t> frame_behind(std::string_view joint) const {
    std::size_t frame = 0;
    for (const JointLines& one : lines->joints) {
      frame += elements(one.kind);
      if (one.name == joint) return frame;
    }
    return std::nullopt;
  }

  /// The label of the limb, for example "left_1"; empty if the limb has no name.
  std::string label() const {
    return lines->name.empty() || lines->copies.count == 1 ? lines->name : lines->name + "_" + std::to_string(copy);
  }

  /// The limb as text for messages: "limb 4", or with a name "limb 4 (left_1)". position: index of the limb, counted
  /// from 0.
  std::string text(std::size_t position) const {
    const std::string number = "limb " + std::to_string(position + 1);
    return lines->name.empty() ? number : number + " (" + label() + ")";
  }

  /// The index of the last frame, before the body at which the limb ends.
  std::size_t last_frame() const { return *frame_behind(lines->joints.back().name); }
};

std::vector<NamedLimb> named_limbs(const MechanismFile& file) {
  std::vector<NamedLimb> list;
  for (const LimbLines& limb : file.limbs) {
    for (std::size_t copy = 1; copy <= limb.copies.count; ++copy) list.push_back({&limb, copy});
  }
  return list;
}

/// Limbs as text for messages: "limb 4", "limbs 1, 2 and 3", counted from 1.
std::string limbs_text(const std::vector<std::size_t>& limbs) {
  std::string text = limbs.size() == 1 ? "limb " : "limbs ";
  for (std::size_t k = 0; k < limbs.size(); ++k) {
    if (k > 0) text += k + 1 == limbs.size() ? " and " : ", ";
    text += std::to_string(limbs[k] + 1);
  }
  return text;
}

/// Adds to `slot` (limbs and frames of an error) all limbs with this number or name.
void add_limbs(const StudyValue& value, const std::vector<NamedLimb>& known, SlotLines& slot) {
  const auto add = [&](std::size_t limb) {
    if (std::ranges::find(slot.limbs, limb) != slot.limbs.end()) {
      value.fail("names " + known[limb].text(limb) + " a second time", "remove it");
    }
    slot.limbs.push_back(limb);
  };
  if (!value.is_text()) {
    return add(static_cast<std::size_t>(value.whole_number(1, static_cast<std::int64_t>(known.size())) - 1));
  }
  const std::string name = value.text();
  const std::size_t before = slot.limbs.size();
  for (std::size_t i = 0; i < known.size(); ++i) {
    if (!name.empty() && (known[i].lines->name == name || known[i].label() == name)) add(i);
  }
  if (slot.limbs.size() > before) return;
  value.fail("is '" + printable(name) + "', which no limb is named",
             "write a limb's number, its name, a list of these, or \"each\"");
}

void read_limbs(const StudyValue& value, const std::vector<NamedLimb>& known, SlotLines& slot) {
  bool by_copy = false;
  if (value.is_text() && value.text() == kEach) {
    for (std::size_t i = 0; i < known.size(); ++i) slot.limbs.push_back(i);
    slot.each = true;
  } else if (value.is_list()) {
    for (const StudyValue& element : value.list()) add_limbs(element, known, slot);
    if (slot.limbs.empty()) value.fail("is empty", "write the limbs' numbers, e.g. [1, 2, 3]");
  } else {
    add_limbs(value, known, slot);
    by_copy = true;
  }
  const bool alone = by_copy && slot.limbs.size() == 1;
  for (const std::size_t i : slot.limbs) slot.numbers.push_back(alone ? 0 : by_copy ? known[i].copy : i + 1);
}

/// Reads the name of a joint. In each limb of `slot`, the frame of the error is the one behind the joint of this name.
void read_frame_by_name(const StudyValue& frame, const std::vector<NamedLimb>& known, SlotLines& slot) {
  for (const std::size_t i : slot.limbs) {
    const std::optional<std::size_t> behind = known[i].frame_behind(frame.text());
    if (!behind) {
      frame.fail("is '" + printable(frame.text()) + "', which no joint of " + known[i].text(i) + " is named",
                 suggestion(frame.text(), names(known[i].lines->joints)));
    }
    slot.frames.push_back(*behind);
  }
}

/// Reads the limbs of an error, and a frame that exists in all of them.
void read_slot(const StudySection& section, const std::vector<NamedLimb>& known, SlotLines& slot) {
  read_limbs(section.require("limb", "write limb = \"each\""), known, slot);
  const StudyValue frame = section.require("frame", "write frame = 0");
  if (frame.is_text()) return read_frame_by_name(frame, known, slot);
  const auto number = static_cast<std::size_t>(frame.whole_number(0));
  slot.frames.assign(slot.limbs.size(), number);
  std::vector<std::size_t> with;
  std::vector<std::size_t> without;
  for (const std::size_t i : slot.limbs) (number <= known[i].last_frame() ? with : without).push_back(i);
  if (without.empty()) return;
  const std::string last = std::to_string(known[without.front()].last_frame());
  if (slot.each && !with.empty()) {
    std::string list;
    for (const std::size_t i : with) list += (list.empty() ? "" : ", ") + std::to_string(i + 1);
    frame.fail("is " + std::to_string(number) + ", which " + limbs_text(with) + " have, and " + limbs_text(without) +
                   " not: the last frame of limb " + std::to_string(without.front() + 1) + " is " + last,
               "name the limbs that are meant: limb = [" + list + "]");
  }
  frame.fail("is " + std::to_string(number),
             "the last frame of " + known[without.front()].text(without.front()) + " is " + last);
}

/// Throws InputError unless the table has exactly one of the keys `one` and `other`, and no key `scale` together with
/// `other`.
void need_one_of(const StudySection& section, std::string_view one, std::string_view other) {
  if (section.find(one)) {
    section.refuse(other, "an error with " + std::string(one));
  } else if (!section.find(other)) {
    static_cast<void>(section.require(one, "write component = \"delta_z\", or components = { delta_z = 1 }"));
  } else {
    section.refuse("scale", "an error with components, each of which has its share");
  }
}

PlaceLines read_place(const StudySection& section, const std::vector<NamedLimb>& known) {
  WrittenPlace written;
  read_keys(place_keys(), section, written, Nothing{});
  need_one_of(section, "component", "components");
  PlaceLines place{{}, std::move(written.combination)};
  if (const auto value = section.find("component")) {
    if (!section.find("scale")) written.scale = {"1", value->full_name(), value->place(), true};
    place.components.push_back({*written.component, std::move(written.scale)});
  }
  read_slot(section, known, place.slot);
  return place;
}

/// Reads the places in which an error acts and the components that it changes: either one place in each limb, or
/// several places together.
void read_where(const StudySection& section, const std::vector<NamedLimb>& known, ErrorLines& error) {
  const std::optional<StudyValue> places = section.find("places");
  if (!places) {
    need_one_of(section, "component", "components");
    return read_slot(section, known, error.slot);
  }
  for (const std::string_view key : {"limb", "frame", "component", "components", "scale"}) {
    section.refuse(key, "an error with places, each of which says it");
  }
  for (const StudyValue& element : places->list()) error.places.push_back(read_place(element.section(), known));
  if (error.places.empty()) places->fail("is empty", "write [{ limb =, frame =, component = }]");
}

void read_named_errors(const StudyValue& value, MechanismFile& file) {
  const std::vector<NamedLimb> limbs = named_limbs(file);
  for (const StudyValue& element : tables(value)) {
    ErrorLines error;
    read_keys(error_keys(), element.section(), error, Nothing{});
    check_name(error.name);
    if (const auto from = element.section().find("from"); from && !error.grows_with) {
      from->fail("is set without grows_with", "name the joint, e.g. grows_with = \"q\", or remove it");
    }
    read_where(element.section(), limbs, error);
    file.errors.push_back(std::move(error));
  }
}

void read_frames(const StudyValue& value, MechanismFile& file) {
  file.all = value.is_text() && value.text() == "all";
  if (file.all) return;
  if (value.is_text())
    value.fail("is '" + printable(value.text()) + "'", "write \"all\", or a list of names and patterns");
  file.frames = references(value);
}

const Keys<MechanismFile, Nothing>& errors_keys() {
  static const Keys<MechanismFile, Nothing> keys{
      .paths = {"errors"},
      .meaning = "Errors of fixed frames: epsilon_i_j_x (an angle) and delta_i_j_x (a length) of frame j of limb i.",
      .rows = {
          optional("frames", read_by("\"all\" or list", read_frames), "`\"all\"`, or none where there is an [[error]]",
                   "All, or a list of names and patterns: \"delta_*_0_?\"."),
          optional("about",
                   word_at<ErrorsAbout>({{ErrorsAbout::joint, "the point of the limb's first or last joint"},
                                         {ErrorsAbout::frame, "the base's origin, or the platform's"}},
                                        &MechanismFile::about),
                   "`\"joint\"`",
                   "About what angles of a limb's first and of its last frame turn, named errors too; their axes "
                   "are the base's and the platform's. By \"frame\" they, and their rank, depend on where the "
                   "base's frame stands.")}};
  return keys;
}

void read_errors(const StudyValue& value, MechanismFile& file) {
  read_keys(errors_keys(), value.section(), file, Nothing{});
}

void read_sets(const StudyValue& value, MechanismFile& file) {
  const StudySection section = value.section();
  for (const Reference& name : keys_in_order(section)) {
    const StudyValue patterns = *section.find(name.name);
    if (name.name == "all") patterns.fail("exists in any case", "remove it");
    file.sets.push_back({name, references(patterns)});
  }
}

// ---- the file

/// A parameter of the geometry, as written.
struct ParameterLines {
  std::optional<Expression> value;
  std::string description;
};

const Keys<ParameterLines, Nothing>& parameter_keys() {
  using P = ParameterLines;
  static const Keys<P, Nothing> keys{
      .paths = {"geometry.PARAMETER"},
      .meaning = "A parameter with a description.",
      .rows = {needed("value", kept("length or angle", expression, &P::value), "\"250 mm\"", "Its default."),
               optional("description", text_at(&P::description), "none", "For people.")}};
  return keys;
}

GeometryParameter parameter(const std::string& name, const StudyValue& written) {
  ParameterLines lines;
  if (written.is_section()) {
    read_keys(parameter_keys(), written.section(), lines, Nothing{});
  } else {
    lines.value = expression(written);
  }
  const Value found = evaluate(*lines.value, {}, {});
  for (const Dimension dimension : {Dimension::length, Dimension::angle}) {
    if (found.any || !found.like(of_dimension(0.0, dimension))) continue;
    return {name, dimension, found.si, lines.description};
  }
  written.fail("is " + dimension_text(found), "a parameter is a length or an angle: give it a unit, e.g. \"1 mm\"");
}

void read_geometry(const StudyValue& value, MechanismFile& file) {
  const StudySection section = value.section();
  for (const Reference& key : keys_in_order(section)) {
    const StudyValue written = *section.find(key.name);
    const std::string why = why_no_parameter(key.name);
    if (!why.empty()) written.fail(why, "give the parameter another name");
    file.geometry.push_back(parameter(key.name, written));
  }
}

void read_format(const StudyValue& value, MechanismFile&) {
  if (value.text() == "poesy-mechanism") return;
  value.fail("is '" + printable(value.text()) + "'", "a mechanism has format = \"poesy-mechanism\"");
}

void read_version(const StudyValue& value, MechanismFile&) {
  const std::int64_t number = value.whole_number(1);
  if (number > 1)
    value.fail("is " + std::to_string(number) + ", but this poesy knows version 1 only", "use a newer poesy");
}

const Keys<MechanismFile, Nothing>& file_keys() {
  using F = MechanismFile;
  static const Keys<F, Nothing> keys{
      .paths = {""},
      .meaning = "A mechanism: everything stands in one base frame, at the home pose, as on a drawing.",
      .rows = {
          needed("format", read_by("text", read_format), "\"poesy-mechanism\"", "\"poesy-mechanism\"."),
          needed("version", read_by("integer", read_version), "1", "1."),
          needed("name", kept("text", read_name, &F::name), "\"rps3\"",
                 "Its name: letters, digits, _ and -; it does not begin with -."),
          optional("title", text_at(&F::title), "the name", "For people."),
          optional("geometry", read_by("table", read_geometry), "none",
                   "Lengths and angles that expressions name; a study may change each."),
          optional("points", kept("table", points, &F::points), "none",
                   "Points of the base frame, at home, that joints may name; those of a limb go before."),
          needed("platform", kept("table", platform, &F::platform), "{ origin =, coordinates =, workspace = }",
                 "What the limbs hold."),
          optional("body", kept("tables", read_bodies, &F::bodies), "none", "Rigid parts besides base and platform."),
          needed("limb", kept("tables", limbs, &F::limbs), "[{ joints = }], or [[limb]] for each", "The limbs."),
          optional("drawing", kept("table", read_drawing, &F::general), "none", "General tolerances of the drawing."),
          optional("load", kept("table", read_load, &F::load), "none",
                   "Loads, which act where the mechanism has stiffness; [mechanism.load] of a study replaces them."),
          optional<F>("response", {.type = "tables"}, "none",
                      "Responses of one's own, [[response]], with the keys that they have in a study."),
          optional("error", read_by("tables", read_named_errors), "none", "Errors with names of their own."),
          optional("errors", read_by("table", read_errors), "`{}`", "Errors of fixed frames."),
          optional("sets", read_by("table", read_sets), "none besides `all`",
                   "Sets of errors that a study may name.")}};
  return keys;
}

/// The description of a table in which the file chooses the names of the keys.
StudyTable of_names(std::vector<std::string_view> paths, std::string_view name, std::string type,
                    std::string_view meaning, std::string missing = {}, std::string example = {}) {
  return {.paths = std::move(paths),
          .meaning = meaning,
          .keys = {{.name = name,
                    .type = std::move(type),
                    .missing = std::move(missing),
                    .example = std::move(example),
                    .meaning = meaning}}};
}

/// The properties of a type of joint: name in files, letter in sketches, number of elementary joints.
struct JointTraits {
  std::string_view name;
  char letter;
  std::size_t elements;  ///< number of elementary joints
};

JointTraits traits_of(JointKind kind) {
  switch (kind) {
    case JointKind::fixed:
      return {"fixed", 'F', 1};
    case JointKind::revolute:
      return {"R", 'R', 1};
    case JointKind::prismatic:
      return {"P", 'P', 1};
    case JointKind::helical:
      return {"H", 'H', 1};
    case JointKind::cylindrical:
      return {"C", 'C', 2};
    case JointKind::universal:
      return {"U", 'U', 2};
    case JointKind::spherical:
      return {"S", 'S', 3};
  }
  throw std::logic_error("unknown kind of joint");
}

}  // namespace

std::string_view name(JointKind kind) { return traits_of(kind).name; }

char letter(JointKind kind) { return traits_of(kind).letter; }

std::size_t elements(JointKind kind) { return traits_of(kind).elements; }

std::string_view name(Rotation rotation) {
  constexpr std::array<std::string_view, 7> kNames{"vector", "xyz", "xzy", "yxz", "yzx", "zxy", "zyx"};
  return kNames[static_cast<std::size_t>(rotation)];
}

std::string_view name(ErrorsAbout about) { return about == ErrorsAbout::joint ? "joint" : "frame"; }

bool MechanismFile::has_features() const {
  return std::ranges::any_of(limbs,
                             [](const LimbLines& limb) { return !limb.features.empty() || !limb.clearances.empty(); });
}

const StudyTables& mechanism_file_tables() {
  static const StudyTables tables = [] {
    StudyTables list{
        described(file_keys()),
        of_names({"geometry"}, "PARAMETER", "length or angle, or table",
                 "A parameter: its default, or a table with it."),
        described(parameter_keys()),
        of_names({"points", "limb.points"}, "POINT", "point", "A point: [x, y, z]."),
        described(platform_keys()),
        of_names({"platform.points"}, "POINT", "point",
                 "A point of the platform frame, [x, y, z]: its displacement is reported as POINT_x, POINT_y, POINT_z "
                 "and POINT_position."),
        of_names({"platform.coordinates"}, "COORDINATE", "text", "A coordinate's name, and which it is: x, ..., rz."),
        of_names({"platform.workspace"}, "COORDINATE", "list", "The lowest and the highest value of a coordinate.",
                 "write {}", "[\"-20 deg\", \"20 deg\"]"),
        described(limb_keys()),
        copies_table(),
        described(joint_keys()),
        described(errors_keys()),
        described(error_keys()),
        described(place_keys()),
        of_names({"error.components", "error.places.components"}, "COMPONENT", "number or expression",
                 "A component of the frame's error, delta_x, ..., epsilon_z, and its share of the error."),
        of_names({"sets"}, "SET", "list", "A set: names or patterns of errors.")};
    for (StudyTable& part : part_tables()) list.push_back(std::move(part));
    for (StudyTable& one : feature_tables()) list.push_back(std::move(one));
    list.push_back(drawing_keys_table());
    for (StudyTable& own : own_response_tables()) list.push_back(std::move(own));
    return list;
  }();
  return tables;
}

namespace {

toml::table parsed(const std::string& text, const std::string& path) {
  return parse_toml(text, path, "correct this line; names of parameters and expressions stand in quotes");
}

/// Throws InputError if the file is a study. The advice names the mechanism of that study.
void refuse_study(const toml::table& table, const std::string& path) {
  if (table["format"].value_or(std::string()) != "poesy-study" || !table.contains("mechanism")) return;
  const auto beside = table.at_path("mechanism.file").value<std::string>();
  const auto name = table.at_path("mechanism.model").value<std::string>();
  std::string remedy = "give the file of the study's mechanism";
  if (beside) {
    const std::string folder = beside->starts_with('/') ? "" : path.substr(0, path.find_last_of('/') + 1);
    remedy += " instead: " + printable(folder + *beside);
  }
  if (!beside && name) remedy = "give the study's mechanism instead: " + printable(*name);
  throw InputError({path, 1, 1}, "is a study, not a mechanism", remedy);
}

}  // namespace

std::vector<OwnResponse> read_own_responses(const std::string& text, const std::string& path,
                                            const ModelDescription& model) {
  const toml::table table = parsed(text, path);
  const auto value = StudySection(table, "", {path, 1, 1}, mechanism_file_tables()).find("response");
  if (!value) return {};
  return poesy::read_own_responses(*value, model, PoseBefore::unknown);
}

MechanismFile read_mechanism_file(const std::string& text, const std::string& path) {
  const toml::table table = parsed(text, path);
  refuse_study(table, path);
  const StudySection root(table, "", {path, 1, 1}, mechanism_file_tables());
  MechanismFile file;
  file.path = path;
  read_keys(file_keys(), root, file, Nothing{});
  if (file.title.empty()) file.title = file.name;
  static_cast<void>(mechanism(file, default_geometry(file)));
  return file;
}

}  // namespace poesy::file
