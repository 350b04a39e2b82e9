#include "models/file/part_lines.h"

#include <algorithm>

#include "engine/base/text.h"
#include "models/file/file_rows.h"

namespace poesy::file {
namespace {

/// Names that bodies must not have.
constexpr std::array<std::string_view, 3> kReserved{"base", "platform", "tip"};

std::string read_body_name(const StudyValue& value) {
  if (std::ranges::find(kReserved, value.text()) != kReserved.end()) {
    value.fail("is '" + value.text() + "', which every mechanism has", "give the body another name");
  }
  return read_name(value);
}

const Keys<BodyLines, Nothing>& body_keys() {
  using B = BodyLines;
  static const Keys<B, Nothing> keys{
      .paths = {"body"},
      .meaning = "A rigid part besides the base and the platform, [[body]]: limbs begin and end at bodies.",
      .rows = {
          needed("name", kept("text", read_body_name, &B::name), "\"carriage\"",
                 "Its name; copies are NAME_1, NAME_2, ..."),
          needed("at", kept("point", point, &B::at), "[\"R\", 0, \"h\"]", "Its origin at home, in the base frame."),
          optional("x", kept("direction", direction, &B::x), "the base's",
                   "Its x axis at home; with `z`, to which it is made perpendicular."),
          optional("z", kept("direction", direction, &B::z), "the base's", "Its z axis at home; with `x`."),
          optional("copies", kept("table", read_copies, &B::copies), "one",
                   "Bodies alike, origin and axes turned about an axis of the base. Where a limb and a body that "
                   "it names both have copies, copy k goes with copy k."),
          optional("mass", kept("mass", expression, &B::mass), "none", "Its mass, on which gravity acts."),
          optional("centre", kept("point", point, &B::centre), "its origin", "Its centre of mass, in its frame.")}};
  return keys;
}

const Keys<StiffnessLines, Nothing>& stiffness_keys() {
  using S = StiffnessLines;
  const auto stiffness = [](auto member) { return kept("stiffness", expression, member); };
  constexpr std::string_view kAlong = "Along the axis of the joint's first frame, before its motion: \"60 N/um\".";
  constexpr std::string_view kAbout = "About that axis: \"15000 N m/rad\".";
  static const Keys<S, Nothing> keys{
      .paths = {"limb.joints.stiffness"},
      .meaning =
          "The stiffness of a joint's bearing and drive; without it a direction is rigid. Along its own freedom a "
          "passive joint has none; on a driven freedom it is the drive's.",
      .rows = {optional("x", stiffness(&S::x), "rigid", kAlong), optional("y", stiffness(&S::y), "rigid", kAlong),
               optional("z", stiffness(&S::z), "rigid", kAlong), optional("rx", stiffness(&S::rx), "rigid", kAbout),
               optional("ry", stiffness(&S::ry), "rigid", kAbout), optional("rz", stiffness(&S::rz), "rigid", kAbout)}};
  return keys;
}

const Keys<LinkLines, Nothing>& link_keys() {
  using L = LinkLines;
  static const Keys<L, Nothing> keys{
      .paths = {"limb.links"},
      .meaning =
          "A link of a limb that gives way: a straight beam between two joints, or between a body and a joint, "
          "or a part of given compliance.",
      .rows = {
          needed("from", kept("text", reference, &L::from), "\"B\"",
                 "Where it begins: a joint of the limb, or the body where the limb begins."),
          needed("to", kept("text", reference, &L::to), "\"C\"",
                 "Where it ends: a later joint, or the body where the limb ends."),
          optional("E", kept("modulus", expression, &L::E), "none", "Modulus of elasticity of a beam: \"210 GPa\"."),
          optional("G", kept("modulus", expression, &L::G), "none", "Shear modulus of a beam: \"80 GPa\"."),
          optional("diameter", kept("length", expression, &L::diameter), "none", "Outer diameter of a round section."),
          optional("bore", kept("length", expression, &L::bore), "`0`", "Inner diameter of a round section."),
          optional("A", kept("area", expression, &L::A), "none", "Area of any other section: \"900 mm^2\"."),
          optional("Iy", kept("area moment", expression, &L::Iy), "none", "Area moment about y: \"40000 mm^4\"."),
          optional("Iz", kept("area moment", expression, &L::Iz), "none", "Area moment about z."),
          optional("J", kept("area moment", expression, &L::J), "none", "Area moment of torsion."),
          optional("shear", kept("number", expression, &L::shear), "no shear deformation",
                   "The share of the area that carries shear, 5/6 of a rectangle."),
          optional("y", kept("direction", direction, &L::y), "any",
                   "Its y axis at home, made perpendicular to the line, where Iy and Iz differ."),
          optional("compliance", kept("list of lists", read_compliance, &L::compliance), "none",
                   "In the place of a section 6 x 6 bare SI numbers, [rotation; translation] from [moment; force] at "
                   "the end at `to`, with x along the line.")}};
  return keys;
}

const Keys<LoadLines, Nothing>& load_keys() {
  using L = LoadLines;
  static const Keys<L, Nothing> keys{
      .paths = {"load"},
      .meaning = "Dead loads, which act at nominal places where the mechanism has stiffness.",
      .rows = {
          optional("gravity", kept("vector", point, &L::gravity), "none",
                   "Acceleration on every mass, in the base's axes: [0, 0, \"-9.81 m/s^2\"]."),
          optional("body", kept("text", reference, &L::body), "`\"platform\"`",
                   "The body on which force and moment act."),
          optional("at", kept("point", point, &L::at), "the tool, or the body's origin",
                   "Where they act, in the body's frame."),
          optional("force", kept("vector", point, &L::force), "none", "In the base's axes: [\"3 N\", 0, \"-2 N\"]."),
          optional("moment", kept("vector", point, &L::moment), "none", "In the base's axes: [0, 0, \"0.5 N m\"].")}};
  return keys;
}

}  // namespace

std::vector<BodyLines> read_bodies(const StudyValue& value) {
  std::vector<BodyLines> list;
  std::unordered_set<std::string> names;
  for (const StudyValue& element : tables(value)) {
    BodyLines body;
    body.key = element.full_name();
    body.place = element.place();
    const StudySection section = element.section();
    read_keys(body_keys(), section, body, Nothing{});
    const StudyValue name = section.require("name");
    add_name({body.name, name.full_name(), name.place()}, names, "body");
    if (body.x.has_value() != body.z.has_value()) element.fail("has one of x and z", "give both, or neither");
    list.push_back(std::move(body));
  }
  return list;
}

StiffnessLines read_stiffness(const StudyValue& value) {
  StiffnessLines lines;
  lines.key = value.full_name();
  lines.place = value.place();
  read_keys(stiffness_keys(), value.section(), lines, Nothing{});
  if (std::ranges::none_of(lines.in_order(), [](const auto* entry) { return entry->has_value(); })) {
    value.fail("is empty", "write z = \"20 N/um\", for instance, or leave it out where the joint is rigid");
  }
  return lines;
}

ComplianceLines read_compliance(const StudyValue& value) {
  ComplianceLines lines{.entries = {}, .key = value.full_name(), .place = value.place()};
  const std::vector<StudyValue> rows = value.list();
  if (rows.size() != 6) value.fail("has " + std::to_string(rows.size()) + " rows", "write six lists of six numbers");
  auto entry = lines.entries.begin();
  for (const StudyValue& row : rows) {
    const std::vector<StudyValue> numbers = row.list();
    if (numbers.size() != 6) {
      row.fail("has " + std::to_string(numbers.size()) + " numbers", "write six lists of six numbers");
    }
    for (const StudyValue& number : numbers) *entry++ = number.number();
  }
  return lines;
}

std::vector<LinkLines> read_links(const StudyValue& value) {
  std::vector<LinkLines> list;
  for (const StudyValue& element : value.list()) {
    LinkLines link;
    link.key = element.full_name();
    link.place = element.place();
    read_keys(link_keys(), element.section(), link, Nothing{});
    list.push_back(std::move(link));
  }
  return list;
}

LoadLines read_load(const StudyValue& value) {
  LoadLines lines;
  read_keys(load_keys(), value.section(), lines, Nothing{});
  return lines;
}

std::string load_text(const LoadLines& load) {
  std::string text;
  const auto add = [&](std::string_view key, const std::optional<Triple>& triple) {
    if (!triple) return;
    std::vector<std::string> entries;
    for (const Expression& entry : triple->entries) {
      entries.push_back(entry.quoted ? in_quotes(entry.text) : entry.text);
    }
    text += std::string(key) + " = " + list_text(entries) + "\n";
  };
  add("gravity", load.gravity);
  if (load.body) text += "body = " + in_quotes(load.body->name) + "\n";
  add("at", load.at);
  add("force", load.force);
  add("moment", load.moment);
  return text;
}

StudyTables part_tables() {
  return {described(body_keys()), described(stiffness_keys()), described(link_keys()), described(load_keys())};
}

}  // namespace poesy::file
