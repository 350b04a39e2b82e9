#include "models/file/mechanism_file.h"

#include <toml++/toml.h>

#include <algorithm>
#include <tuple>

#include "engine/base/text.h"
#include "models/file/mechanism.h"

namespace poesy::file {
namespace {

constexpr std::size_t kLongestLine = 16384;  ///< bytes; bounds the depth to which dotted keys nest tables
constexpr std::int64_t kMostCopies = 100;
constexpr std::array<std::string_view, 6> kCoordinates{"x", "y", "z", "rx", "ry", "rz"};
constexpr std::array<std::string_view, 3> kAxes{"x", "y", "z"};
constexpr std::array<std::string_view, 6> kComponents{"epsilon_x", "epsilon_y", "epsilon_z",
                                                      "delta_x",   "delta_y",   "delta_z"};

/// The scope of tables whose rows need the value alone.
struct Nothing {};

template <class Object, class Scope = Nothing>
using Row = Key<Object, Scope>;

/// A value that `read` makes of a StudyValue, in the member at this path.
template <class Read, class... Path>
auto kept(std::string type, Read read, Path... path) {
  using Object = OwnerOf<Path...>;
  return KeyValue<Object>{.type = std::move(type), .read = [=](const StudyValue& value, Object& object) {
                            detail::at(object, path...) = read(value);
                          }};
}

Expression expression(const StudyValue& value) {
  if (value.is_text()) return {value.text(), value.full_name(), value.place(), true};
  return {shortest(value.number()), value.full_name(), value.place(), false};
}

Triple point(const StudyValue& value) {
  const std::vector<StudyValue> list = value.list();
  if (list.size() != 3) {
    value.fail("has " + std::to_string(list.size()) + " values", "write three, e.g. [\"60 mm\", 0, 0]");
  }
  return {{expression(list[0]), expression(list[1]), expression(list[2])}, value.full_name(), value.place()};
}

/// "x", "-z", or three numbers or expressions.
Triple direction(const StudyValue& value) {
  if (!value.is_text()) return point(value);
  std::string word = value.text();
  const bool back = word.starts_with('-');
  if (back) word.erase(0, 1);
  const auto axis = std::ranges::find(kAxes, word);
  if (axis == kAxes.end()) {
    value.fail("is '" + printable(value.text()) + "'",
               "write \"x\", \"y\", \"z\", a minus before it, or [x, y, z] for a direction");
  }
  Triple triple{{}, value.full_name(), value.place()};
  triple.entries.fill({"0", value.full_name(), value.place(), false});
  triple.entries[static_cast<std::size_t>(axis - kAxes.begin())].text = back ? "-1" : "1";
  return triple;
}

Reference reference(const StudyValue& value) { return {value.text(), value.full_name(), value.place()}; }

std::vector<Reference> references(const StudyValue& value) {
  if (value.is_text()) return {reference(value)};
  std::vector<Reference> list;
  for (const StudyValue& element : value.list()) list.push_back(reference(element));
  return list;
}

void check_name(const Reference& reference) {
  const auto allowed = [](unsigned char c) { return c < 0x80 && (std::isalnum(c) != 0 || c == '_' || c == '-'); };
  if (!reference.name.empty() && std::ranges::all_of(reference.name, allowed)) return;
  throw InputError(reference.place, reference.key + " '" + printable(reference.name) + "' is no name",
                   "write letters, digits, _ and -");
}

/// Throws where the name is taken already.
template <class Named>
void check_new(const Reference& reference, const std::vector<Named>& taken, std::string_view whose) {
  check_name(reference);
  const auto same = [&](const Named& other) { return other.name == reference.name; };
  if (std::ranges::none_of(taken, same)) return;
  throw InputError(reference.place,
                   reference.key + " '" + reference.name + "' is the name of another " + std::string(whose),
                   "give it a name of its own");
}

std::string read_name(const StudyValue& value) {
  check_name(reference(value));
  return value.text();
}

/// The keys of a table whose names the file chooses, in the order of the file.
std::vector<Reference> keys_in_order(const StudySection& section) {
  std::vector<Reference> list;
  for (const std::string& key : section.keys()) {
    const Reference found{key, "", section.place()};
    check_name(found);
    const StudyValue value = *section.find(key);
    list.push_back({key, value.full_name(), value.place()});
  }
  std::ranges::sort(list, {}, [](const Reference& at) { return std::tuple(at.place.line, at.place.column); });
  return list;
}

std::vector<NamedPoint> points(const StudyValue& value) {
  const StudySection section = value.section();
  std::vector<NamedPoint> list;
  for (const Reference& name : keys_in_order(section)) list.push_back({name.name, point(*section.find(name.name))});
  return list;
}

// ---- joints and limbs

void read_at(const StudyValue& value, JointLines& joint, const Nothing&) {
  if (value.is_text()) {
    joint.at_point = reference(value);
  } else {
    joint.at = point(value);
  }
}

/// true for joints with one axis and for both of C; 1 or 2 for one of C or U.
void read_actuated(const StudyValue& value, JointLines& joint, const Nothing&) {
  const std::size_t axes = elements(joint.kind);
  if (const std::optional<bool> all = value.boolean()) {
    if (*all && joint.kind == JointKind::universal) value.fail("is true", "write 1 or 2, for its first or second axis");
    joint.actuated = {*all, *all && axes == 2};
    return;
  }
  if (axes == 1) value.fail("is no truth value", "write true or false");
  joint.actuated[static_cast<std::size_t>(value.whole_number(1, 2) - 1)] = true;
}

const Keys<JointLines, Nothing>& joint_keys() {
  using J = JointLines;
  static const Keys<J, Nothing> keys{
      .paths = {"limb.joints"},
      .meaning =
          "A joint, at home and in the base frame. Inside, every joint becomes revolute, prismatic and helical "
          "ones about or along their own z axes.",
      .chooser = "type",
      .rows = {Row<JointLines>{
                   .name = "type",
                   .value = word_at<JointKind>({{JointKind::revolute, "revolute"},
                                                {JointKind::prismatic, "prismatic"},
                                                {JointKind::helical, "helical: slides as it turns"},
                                                {JointKind::cylindrical, "cylindrical: R, then P on the same axis"},
                                                {JointKind::universal, "universal: two axes through one point"},
                                                {JointKind::spherical,
                                                 "spherical: three revolutes, the first along the "
                                                 "line from the joint before"},
                                                {JointKind::fixed, "no motion: a frame that has errors"}},
                                               &J::kind),
                   .missing = "write {}",
                   .example = "\"R\"",
                   .meaning = "What the joint does."},
               Row<JointLines>{.name = "name",
                               .value = kept("text", read_name, &J::name),
                               .missing = "write {}",
                               .example = "\"A\"",
                               .meaning = "Its name, once in a limb."},
               Row<JointLines>{.name = "at",
                               .value = {.type = "point"},
                               .usual = "the point `from` of P, H and C",
                               .meaning = "Where it stands: [x, y, z], or the name of a point of [points].",
                               .reader = read_at},
               Row<JointLines>{.name = "from",
                               .value = kept("text", reference, &J::from),
                               .only_for = {"R", "P", "H", "C", "U", "fixed"},
                               .meaning = "With `to`, its direction: from this joint or point."},
               Row<JointLines>{.name = "to",
                               .value = kept("text", reference, &J::to),
                               .only_for = {"R", "P", "H", "C", "U", "fixed"},
                               .meaning = "With `from`, its direction: to this joint or point."},
               Row<JointLines>{
                   .name = "axis",
                   .value = kept("direction", direction, &J::axis),
                   .only_for = {"R", "P", "H", "C", "U", "fixed"},
                   .meaning = "Its direction, without `from` and `to`: \"x\", \"-z\", or [x, y, z] of any length."},
               Row<JointLines>{.name = "axis2",
                               .value = kept("direction", direction, &J::axis2),
                               .missing = "write {}",
                               .example = "\"y\"",
                               .only_for = {"U"},
                               .meaning = "Its second axis, in the order from the base."},
               Row<JointLines>{.name = "x",
                               .value = kept("direction", direction, &J::x),
                               .usual = "towards the next joint's point",
                               .meaning = "The x axis of its first frame, made perpendicular to z."},
               Row<JointLines>{.name = "pitch",
                               .value = kept("length", expression, &J::pitch),
                               .missing = "write {}",
                               .example = "\"5 mm\"",
                               .only_for = {"H"},
                               .meaning = "By how much it slides in one turn; positive for a right-handed thread."},
               Row<JointLines>{
                   .name = "actuated",
                   .value = {.type = "true, 1 or 2"},
                   .usual = "`false`",
                   .only_for = {"R", "P", "H", "C", "U"},
                   .meaning =
                       "Whether a drive holds it; of U the axis that is held, of C the turn (1), the slide (2) or both "
                       "(true).",
                   .reader = read_actuated}}};
  return keys;
}

std::vector<JointLines> joints(const StudyValue& value) {
  std::vector<JointLines> list;
  for (const StudyValue& element : value.list()) {
    JointLines joint;
    joint.key = element.full_name();
    joint.place = element.place();
    const StudySection section = element.section();
    read_keys(joint_keys(), section, joint, Nothing{});
    check_new({joint.name, section.require("name").full_name(), section.require("name").place()}, list,
              "joint of this limb");
    list.push_back(std::move(joint));
  }
  if (list.empty()) value.fail("is empty", "write its joints from base to platform");
  return list;
}

const Keys<LimbLines, Nothing>& copies_keys() {
  static const Keys<LimbLines, Nothing> keys{
      .paths = {"limb.copies"},
      .meaning = "Limbs alike: limb k of them is the first turned by (k - 1) 360 deg / count.",
      .rows = {Row<LimbLines>{.name = "count",
                              .value = whole_at(1, kMostCopies, &LimbLines::copies),
                              .missing = "write {}",
                              .example = "3",
                              .meaning = "How many there are."},
               Row<LimbLines>{.name = "about",
                              .value = kept(
                                  "text", [](const StudyValue& value) { return value.word(kAxes); }, &LimbLines::about),
                              .missing = "write {}",
                              .example = "\"z\"",
                              .meaning = "About which axis of the base they are turned: x, y or z."}}};
  return keys;
}

const Keys<LimbLines, Nothing>& limb_keys() {
  static const Keys<LimbLines, Nothing> keys{
      .paths = {"limb"},
      .meaning = "A limb, [[limb]], between base and platform.",
      .rows = {
          Row<LimbLines>{
              .name = "copies",
              .value = {.type = "table"},
              .usual = "one",
              .meaning = "Limbs alike, turned about an axis of the base.",
              .reader = [](const StudyValue& value, LimbLines& limb,
                           const Nothing& nothing) { read_keys(copies_keys(), value.section(), limb, nothing); }},
          Row<LimbLines>{.name = "points",
                         .value = kept("table", points, &LimbLines::points),
                         .usual = "none",
                         .meaning = "Points of this limb alone, as in [points]."},
          Row<LimbLines>{.name = "joints",
                         .value = kept("list of tables", joints, &LimbLines::joints),
                         .missing = "write joints = [ { name = \"A\", type = \"R\", at = [0, 0, 0], axis = \"y\" } ]",
                         .meaning = "Its joints, from base to platform."}}};
  return keys;
}

std::vector<StudyValue> tables(const StudyValue& value) {
  if (value.is_section()) value.fail("is one table", "write double brackets: [[" + value.full_name() + "]]");
  return value.list();
}

std::vector<LimbLines> limbs(const StudyValue& value) {
  std::vector<LimbLines> list;
  std::size_t count = 0;
  for (const StudyValue& element : tables(value)) {
    LimbLines limb;
    read_keys(limb_keys(), element.section(), limb, Nothing{});
    for (const NamedPoint& named : limb.points) {
      check_new({named.name, named.point.key, named.point.place}, limb.joints, "joint of this limb");
    }
    count += limb.copies;
    list.push_back(std::move(limb));
  }
  if (count < 2) value.fail("is alone, so nothing closes a loop", "write two limbs or more, or copies");
  return list;
}

// ---- platform

void read_coordinates(const StudyValue& value, PlatformLines& platform, const Nothing&) {
  platform.coordinates_place = value.place();
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
    check_new({line.name, line.key, line.place}, platform.coordinates, "coordinate");
    if (std::ranges::find(platform.coordinates, line.component, &CoordinateLines::component) !=
        platform.coordinates.end()) {
      element.fail("is " + line.component + " a second time", "remove it");
    }
    platform.coordinates.push_back(std::move(line));
  }
  if (platform.coordinates.empty()) value.fail("is empty", "name as many as the platform has freedoms");
}

void read_workspace(const StudyValue& value, PlatformLines& platform, const Nothing&) {
  const StudySection section = value.section();
  section.allow(names(platform.coordinates), "coordinate");
  for (CoordinateLines& coordinate : platform.coordinates) {
    const StudyValue range = section.require(coordinate.name);
    const std::vector<StudyValue> ends = range.list();
    if (ends.size() != 2) range.fail("has " + std::to_string(ends.size()) + " values", "write [lowest, highest]");
    coordinate.lower = expression(ends[0]);
    coordinate.upper = expression(ends[1]);
  }
}

void read_metric_points(const StudyValue& value, PlatformLines& platform, const Nothing&) {
  platform.place = value.place();
  for (const StudyValue& element : value.list()) platform.points.push_back(point(element));
  if (platform.points.size() < 3) value.fail("has fewer than three points", "give three that are on no line");
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
          Row<PlatformLines>{.name = "origin",
                             .value = kept("point", point, &P::origin),
                             .missing = "write {}",
                             .example = "[0, 0, \"600 mm\"]",
                             .meaning = "Its origin P at home, in the base frame."},
          Row<PlatformLines>{.name = "x",
                             .value = kept("direction", direction, &P::x),
                             .usual = "the base's",
                             .meaning = "Its x axis at home; with `z`, to which it is made perpendicular."},
          Row<PlatformLines>{.name = "z",
                             .value = kept("direction", direction, &P::z),
                             .usual = "the base's",
                             .meaning = "Its z axis at home; with `x`."},
          Row<PlatformLines>{
              .name = "rotation", .value = word_at(rotations, &P::rotation), .meaning = "What rx, ry and rz mean."},
          Row<PlatformLines>{
              .name = "coordinates",
              .value = {.type = "list"},
              .missing = "write {}",
              .example = "[\"x\", \"y\", \"z\"]",
              .meaning =
                  "The independent ones among x, y, z (P in the base frame) and rx, ry, rz (from home), as many as "
                  "it has freedoms; { alpha = \"rx\" } renames one.",
              .reader = read_coordinates},
          Row<PlatformLines>{.name = "workspace",
                             .value = {.type = "table"},
                             .missing = "write workspace = { z = [\"500 mm\", \"700 mm\"] } with every coordinate",
                             .meaning = "The default workspace.",
                             .reader = read_workspace},
          Row<PlatformLines>{.name = "tool",
                             .value = kept("point", point, &P::tool),
                             .usual = "none",
                             .meaning = "A point of the platform frame whose displacement is reported in addition."},
          Row<PlatformLines>{.name = "points",
                             .value = {.type = "list of points"},
                             .usual = "the point of each limb's last joint that moves",
                             .meaning = "Points of the platform frame by which mismatch of limbs is weighed.",
                             .reader = read_metric_points}}};
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

using ErrorRow = Row<ErrorLines, MechanismFile>;

void read_error_limb(const StudyValue& value, ErrorLines& error, const MechanismFile& file) {
  if (!value.is_text()) {
    const auto limbs = static_cast<std::int64_t>(frame_counts(file).size());
    error.limb = static_cast<std::size_t>(value.whole_number(1, limbs) - 1);
  } else if (value.text() != "each") {
    value.fail("is '" + printable(value.text()) + "'", "write a limb's number, or \"each\"");
  }
}

void read_error_frame(const StudyValue& value, ErrorLines& error, const MechanismFile& file) {
  const std::vector<std::size_t> counts = frame_counts(file);
  const std::size_t count = error.limb ? counts[*error.limb] : std::ranges::min(counts);
  error.frame = static_cast<std::size_t>(value.whole_number(0, static_cast<std::int64_t>(count) - 1));
}

void read_components(const StudyValue& value, ErrorLines& error, const MechanismFile&) {
  const bool one = value.is_text();
  for (const StudyValue& element : one ? std::vector{value} : value.list()) {
    const std::size_t component = element.word(kComponents);
    if (std::ranges::find(error.components, component) != error.components.end()) {
      element.fail("names a component a second time", "remove it");
    }
    if (!error.components.empty() && error.components.front() / 3 != component / 3) {
      element.fail("mixes lengths and angles in one vector", "write two [[error]]");
    }
    error.components.push_back(component);
  }
  if (error.components.empty()) value.fail("is empty", "write \"delta_z\", for instance");
}

const Keys<ErrorLines, MechanismFile>& error_keys() {
  using E = ErrorLines;
  static const Keys<E, MechanismFile> keys{
      .paths = {"error"},
      .meaning = "An error with a name of its own, [[error]].",
      .rows = {ErrorRow{.name = "name",
                        .value = kept("text", reference, &E::name),
                        .missing = "write {}",
                        .example = "\"l\"",
                        .meaning = "Its name; \"each\" limb appends _1, _2, ..., and components of a vector _x, _y, _z "
                                   "before."},
               ErrorRow{.name = "limb",
                        .value = {.type = "integer or text"},
                        .missing = "write {}",
                        .example = "\"each\"",
                        .meaning = "The limb, counted from 1, or \"each\".",
                        .reader = read_error_limb},
               ErrorRow{.name = "frame",
                        .value = {.type = "integer", .bounds = "at least 0"},
                        .missing = "write {}",
                        .example = "0",
                        .meaning = "The fixed frame: 0 before the first joint, the last one to the platform.",
                        .reader = read_error_frame},
               ErrorRow{.name = "component",
                        .value = {.type = "text or list"},
                        .missing = "write {}",
                        .example = "\"delta_z\"",
                        .meaning = "delta_x, delta_y, delta_z (lengths) or epsilon_x, epsilon_y, epsilon_z (angles) of "
                                   "the frame; several make a vector.",
                        .reader = read_components},
               ErrorRow{.name = "scale",
                        .value = kept("number", expression, &E::scale),
                        .usual = "`1`",
                        .meaning = "The component is the error times this."},
               ErrorRow{.name = "description",
                        .value = text_at(&E::description),
                        .usual = "what the frame's own error says",
                        .meaning = "For people."}}};
  return keys;
}

void read_errors(const StudyValue& value, MechanismFile& file, const Nothing&) {
  for (const StudyValue& element : tables(value)) {
    ErrorLines error;
    read_keys(error_keys(), element.section(), error, file);
    check_name(error.name);
    file.errors.push_back(std::move(error));
  }
}

void read_frames(const StudyValue& value, MechanismFile& file, const Nothing&) {
  if (!value.is_text()) {
    file.frames = references(value);
  } else if (value.text() == "all") {
    file.all = true;
  } else {
    value.fail("is '" + printable(value.text()) + "'", "write \"all\", or a list of names and patterns");
  }
}

const Keys<MechanismFile, Nothing>& errors_keys() {
  static const Keys<MechanismFile, Nothing> keys{
      .paths = {"errors"},
      .meaning = "Errors of fixed frames: epsilon_i_j_x (an angle) and delta_i_j_x (a length) of frame j of limb i.",
      .rows = {Row<MechanismFile>{.name = "frames",
                                  .value = {.type = "\"all\" or list"},
                                  .usual = "`\"all\"`, or none where there is an [[error]]",
                                  .meaning = "All, or a list of names and patterns: \"delta_*_0_?\".",
                                  .reader = read_frames}}};
  return keys;
}

void read_sets(const StudyValue& value, MechanismFile& file, const Nothing&) {
  const StudySection section = value.section();
  for (const Reference& name : keys_in_order(section)) {
    const StudyValue patterns = *section.find(name.name);
    if (name.name == "all") patterns.fail("exists in any case", "remove it");
    file.sets.push_back({name, references(patterns)});
  }
}

// ---- the file

/// A parameter of the geometry as written.
struct ParameterLines {
  std::optional<Expression> value;
  std::string description;
};

const Keys<ParameterLines, Nothing>& parameter_keys() {
  static const Keys<ParameterLines, Nothing> keys{
      .paths = {"geometry.PARAMETER"},
      .meaning = "A parameter with a description.",
      .rows = {Row<ParameterLines>{.name = "value",
                                   .value = kept("length or angle", expression, &ParameterLines::value),
                                   .missing = "write {}",
                                   .example = "\"250 mm\"",
                                   .meaning = "Its default."},
               Row<ParameterLines>{.name = "description",
                                   .value = text_at(&ParameterLines::description),
                                   .usual = "none",
                                   .meaning = "For people."}}};
  return keys;
}

void read_geometry(const StudyValue& value, MechanismFile& file, const Nothing& nothing) {
  const StudySection section = value.section();
  for (const std::string& key : section.keys()) {
    const std::string why = why_no_parameter(key);
    if (why.empty()) continue;
    throw InputError(section.place(), "geometry: '" + printable(key) + "' " + why, "give the parameter another name");
  }
  for (const Reference& key : keys_in_order(section)) {
    const StudyValue written = *section.find(key.name);
    ParameterLines lines;
    if (written.is_section()) {
      read_keys(parameter_keys(), written.section(), lines, nothing);
    } else {
      lines.value = expression(written);
    }
    const Value found = evaluate(*lines.value, {}, {});
    const bool is_length = found.length == 1 && found.angle == 0;
    if (!is_length && !(found.length == 0 && found.angle == 1)) {
      written.fail("is " + dimension_text(found), "a parameter is a length or an angle: give it a unit, e.g. \"1 mm\"");
    }
    file.geometry.push_back({key.name, is_length ? Dimension::length : Dimension::angle, found.si, lines.description});
  }
}

void read_format(const StudyValue& value, MechanismFile&, const Nothing&) {
  if (value.text() == "poesy-mechanism") return;
  value.fail("is '" + printable(value.text()) + "'", "a mechanism has format = \"poesy-mechanism\"");
}

void read_version(const StudyValue& value, MechanismFile&, const Nothing&) {
  const std::int64_t number = value.whole_number(1);
  if (number > 1)
    value.fail("is " + std::to_string(number) + ", but this poesy knows version 1 only", "use a newer poesy");
}

const Keys<MechanismFile, Nothing>& file_keys() {
  using F = MechanismFile;
  static const Keys<F, Nothing> keys{
      .paths = {""},
      .meaning = "A mechanism: everything stands in one base frame, at the home pose, as on a drawing.",
      .rows = {Row<MechanismFile>{.name = "format",
                                  .value = {.type = "text"},
                                  .missing = "write format = \"poesy-mechanism\"",
                                  .meaning = "\"poesy-mechanism\".",
                                  .reader = read_format},
               Row<MechanismFile>{.name = "version",
                                  .value = {.type = "integer"},
                                  .missing = "write version = 1",
                                  .meaning = "1.",
                                  .reader = read_version},
               Row<MechanismFile>{.name = "name",
                                  .value = kept("text", read_name, &F::name),
                                  .missing = "write {}",
                                  .example = "\"rps3\"",
                                  .meaning = "Its name: letters, digits, _ and -."},
               Row<MechanismFile>{
                   .name = "title", .value = text_at(&F::title), .usual = "the name", .meaning = "For people."},
               Row<MechanismFile>{.name = "geometry",
                                  .value = {.type = "table"},
                                  .usual = "none",
                                  .meaning = "Lengths and angles that expressions name; a study may change each.",
                                  .reader = read_geometry},
               Row<MechanismFile>{.name = "points",
                                  .value = kept("table", points, &F::points),
                                  .usual = "none",
                                  .meaning = "Points of the base frame, at home, that joints may name."},
               Row<MechanismFile>{.name = "platform",
                                  .value = kept("table", platform, &F::platform),
                                  .missing = "write [platform] with origin, coordinates and workspace",
                                  .meaning = "What the limbs hold."},
               Row<MechanismFile>{.name = "limb",
                                  .value = kept("tables", limbs, &F::limbs),
                                  .missing = "write [[limb]] with its joints, for each limb",
                                  .meaning = "The limbs."},
               Row<MechanismFile>{.name = "error",
                                  .value = {.type = "tables"},
                                  .usual = "none",
                                  .meaning = "Errors with names of their own.",
                                  .reader = read_errors},
               Row<MechanismFile>{
                   .name = "errors",
                   .value = {.type = "table"},
                   .usual = "`{}`",
                   .meaning = "Errors of fixed frames.",
                   .reader = [](const StudyValue& value, F& file,
                                const Nothing& nothing) { read_keys(errors_keys(), value.section(), file, nothing); }},
               Row<MechanismFile>{.name = "sets",
                                  .value = {.type = "table"},
                                  .usual = "none besides `all`",
                                  .meaning = "Sets of errors that a study may name.",
                                  .reader = read_sets}}};
  return keys;
}

/// A table whose keys are names that the file chooses.
StudyTable of_names(std::vector<std::string_view> paths, std::string_view name, std::string type,
                    std::string_view meaning, std::string missing = {}, std::string example = {}) {
  return {.paths = std::move(paths),
          .meaning = std::string(meaning),
          .keys = {{.name = name,
                    .type = std::move(type),
                    .missing = std::move(missing),
                    .example = std::move(example),
                    .meaning = meaning}}};
}

toml::table parse(const std::string& text, const std::string& path) {
  std::size_t line = 1;
  for (std::size_t begin = 0; begin < text.size(); ++line) {
    const std::size_t end = std::min(text.find('\n', begin), text.size());
    if (end - begin > kLongestLine) {
      throw InputError({path, line, 1}, "the line is longer than " + std::to_string(kLongestLine) + " bytes",
                       "break it into several lines");
    }
    begin = end + 1;
  }
  try {
    return toml::parse(text);
  } catch (const toml::parse_error& error) {
    throw InputError({path, error.source().begin.line, error.source().begin.column},
                     "this is not TOML: " + printable(error.description(), 120), "correct this line");
  }
}

}  // namespace

std::string_view name(JointKind kind) {
  constexpr std::array<std::string_view, 7> kNames{"fixed", "R", "P", "H", "C", "U", "S"};
  return kNames[static_cast<std::size_t>(kind)];
}

std::size_t elements(JointKind kind) {
  constexpr std::array<std::size_t, 7> kElements{1, 1, 1, 1, 2, 2, 3};
  return kElements[static_cast<std::size_t>(kind)];
}

std::string_view name(Rotation rotation) {
  constexpr std::array<std::string_view, 7> kNames{"vector", "xyz", "xzy", "yxz", "yzx", "zxy", "zyx"};
  return kNames[static_cast<std::size_t>(rotation)];
}

const StudyTables& mechanism_file_tables() {
  static const StudyTables tables{
      described(file_keys()),
      of_names({"geometry"}, "PARAMETER", "length or angle, or table", "A parameter: its default, or a table with it."),
      described(parameter_keys()),
      of_names({"points", "limb.points"}, "POINT", "point", "A point: [x, y, z]."),
      described(platform_keys()),
      of_names({"platform.coordinates"}, "COORDINATE", "text", "A coordinate's name, and which it is: x, ..., rz."),
      of_names({"platform.workspace"}, "COORDINATE", "list", "The lowest and the highest value of a coordinate.",
               "write {}", "[\"-20 deg\", \"20 deg\"]"),
      described(limb_keys()),
      described(copies_keys()),
      described(joint_keys()),
      described(errors_keys()),
      described(error_keys()),
      of_names({"sets"}, "SET", "list", "A set: names or patterns of errors.")};
  return tables;
}

std::vector<std::size_t> frame_counts(const MechanismFile& file) {
  std::vector<std::size_t> counts;
  for (const LimbLines& limb : file.limbs) {
    std::size_t frames = 1;
    for (const JointLines& joint : limb.joints) frames += elements(joint.kind);
    counts.insert(counts.end(), limb.copies, frames);
  }
  return counts;
}

MechanismFile read_mechanism_file(const std::string& text, const std::string& path) {
  const toml::table table = parse(text, path);
  const StudySection root(table, "", {path, 1, 1}, mechanism_file_tables());
  MechanismFile file;
  file.path = path;
  read_keys(file_keys(), root, file, Nothing{});
  if (file.title.empty()) file.title = file.name;
  static_cast<void>(mechanism(file, default_geometry(file)));
  return file;
}

}  // namespace poesy::file
