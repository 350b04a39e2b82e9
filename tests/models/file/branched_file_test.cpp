#include <gtest/gtest.h>

#include <algorithm>

#include "models/file/model.h"
#include "tests/models/file/files.h"

// Wrong mechanism files with bodies, stiffness and loads. Each is refused with the place, the key, the rule and a
// remedy.
namespace poesy::file {
namespace {

/// A linear Delta with three carriages, six rods, and a head that hangs on the platform.
constexpr const char* kText = R"(format = "poesy-mechanism"
version = 1
name = "m"

[geometry]
R = "220 mm"
r = "60 mm"
w = "35 mm"
h = "500 mm"

[platform]
origin = [0, 0, "200 mm"]
coordinates = ["x", "y", "z"]
workspace = { x = ["-10 mm", "10 mm"], y = ["-10 mm", "10 mm"], z = ["190 mm", "210 mm"] }
mass = "0.4 kg"

[[body]]
name = "carriage"
copies = { count = 3, about = "z" }
at = ["R", 0, "h"]
mass = "0.25 kg"

[[body]]
name = "head"
at = [0, 0, "150 mm"]
x = "y"
z = "-z"

[[limb]]
name = "rail"
copies = { count = 3, about = "z" }
to = "carriage"
joints = [
  { name = "q", type = "P", at = ["R", 0, "h"], axis = "z", actuated = true, stiffness = { z = "2 N/um" } } ]

[[limb]]
name = "left"
copies = { count = 3, about = "z" }
from = "carriage"
joints = [
  { name = "B", type = "S", at = ["R", "w", "h"] },
  { name = "C", type = "S", at = ["r", "w", "200 mm"] } ]
links = [ { from = "B", to = "C", E = "130 GPa", G = "5 GPa", diameter = "8 mm", bore = "6 mm" } ]

[[limb]]
name = "right"
copies = { count = 3, about = "z" }
from = "carriage"
joints = [
  { name = "B", type = "S", at = ["R", "-w", "h"] },
  { name = "C", type = "S", at = ["r", "-w", "200 mm"] } ]

[[limb]]
name = "plate"
from = "platform"
to = "head"
joints = [ { name = "F", type = "fixed", at = ["5 mm", 0, "180 mm"], axis = "z", x = "x" } ]
links = [
  { from = "F", to = "head", E = "70 GPa", G = "26 GPa", A = "90 mm^2", Iy = "400 mm^4", Iz = "900 mm^4", J = "800 mm^4", y = "y" } ]
compliance = [
  [1e-5, 0, 0, 0, 0, 0], [0, 1e-5, 0, 0, 0, 0], [0, 0, 1e-5, 0, 0, 0],
  [0, 0, 0, 1e-8, 0, 0], [0, 0, 0, 0, 1e-8, 0], [0, 0, 0, 0, 0, 1e-8] ]

[load]
gravity = [0, 0, "-9.81 m/s^2"]
body = "head"
at = [0, 0, "20 mm"]
force = ["3 N", 0, 0]
moment = [0, 0, "0.5 N m"]

[[error]]
name = "rod"
limb = "left"
frame = "B"
component = "delta_x"
)";

/// A wrong file: in the valid file, `from` is replaced by `to`; it must be refused with `message`.
struct Wrong {
  std::string from;
  std::string to;
  std::string message;
};

/// The message with which the text is refused. "read" if it is accepted.
std::string problem_of(const std::string& text) {
  try {
    catalog_entry(text, "m.toml");
  } catch (const InputError& error) {
    return error.what();
  }
  return "read";
}

void expect_refused(const std::string& text, const std::vector<Wrong>& list) {
  EXPECT_EQ(problem_of(text), "read");
  for (const Wrong& wrong : list) {
    const std::size_t at = text.find(wrong.from);
    ASSERT_NE(at, std::string::npos) << wrong.from;
    const std::string problem = problem_of(std::string(text).replace(at, wrong.from.size(), wrong.to));
    EXPECT_EQ(problem, wrong.message) << wrong.to;
    EXPECT_NE(problem.find("; "), std::string::npos) << "no remedy: " << problem;
  }
}

TEST(BranchedFile, RefusesWhatIsWrongWithBodies) {
  expect_refused(
      kText,
      {
          {"name = \"carriage\"\ncopies", "name = \"base\"\ncopies",
           "m.toml:18:8: body[0].name is 'base', which every mechanism has; give the body another name"},
          {"name = \"carriage\"\ncopies", "name = \"platform\"\ncopies",
           "m.toml:18:8: body[0].name is 'platform', which every mechanism has; give the body another name"},
          {"name = \"carriage\"\ncopies", "name = \"tip\"\ncopies",
           "m.toml:18:8: body[0].name is 'tip', which every mechanism has; give the body another name"},
          {"name = \"carriage\"\ncopies", "name = \"two words\"\ncopies",
           "m.toml:18:8: body[0].name 'two words' is not a name; write letters, digits, _ and -, and do not begin with "
           "-"},
          {"name = \"carriage\"\ncopies", "copies",
           "m.toml:17:1: key 'name' is missing in [body[0]]; write name = \"carriage\""},
          {"name = \"carriage\"\ncopies", "nmae = \"carriage\"\ncopies",
           "m.toml:18:1: unknown key 'nmae' in [body[0]]; did you mean 'name'?"},
          {"name = \"head\"\nat", "name = \"carriage\"\nat",
           "m.toml:24:8: body[1].name 'carriage' is the name of another body; give it a name of its own"},
          {"name = \"head\"\nat", "name = \"carriage_2\"\nat",
           "m.toml:23:1: body[1] makes a second body 'carriage_2'; give it a name of its own"},
          {"at = [\"R\", 0, \"h\"]\n", "",
           "m.toml:17:1: key 'at' is missing in [body[0]]; write at = [\"R\", 0, \"h\"]"},
          {"at = [\"R\", 0, \"h\"]\nmass", "at = [\"R\", 0]\nmass",
           "m.toml:20:6: body[0].at has 2 values; write three, e.g. [\"60 mm\", 0, 0]"},
          {"at = [\"R\", 0, \"h\"]\nmass", "at = [\"R\", 0, 500]\nmass",
           "m.toml:20:15: body[0].at[2] '500' is a number, but must be a length; give it a unit, e.g. \"1 mm\""},
          {"at = [\"R\", 0, \"h\"]\nmass", "place = [\"R\", 0, \"h\"]\nmass",
           "m.toml:20:1: unknown key 'place' in [body[0]]; known: name, at, x, z, copies, mass, centre"},
          {"x = \"y\"\nz = \"-z\"", "x = \"y\"", "m.toml:23:1: body[1] has one of x and z; give both, or neither"},
          {"x = \"y\"\nz = \"-z\"", "z = \"-z\"", "m.toml:23:1: body[1] has one of x and z; give both, or neither"},
          {"x = \"y\"\nz = \"-z\"", "x = \"z\"\nz = \"-z\"",
           "m.toml:26:5: body[1].x is parallel to body[1].z; give another direction"},
          {"x = \"y\"\nz = \"-z\"", "x = [0, 0, 0]\nz = \"-z\"",
           "m.toml:26:5: body[1].x is zero and has no direction; give it a length, e.g. [0, 0, 1]"},
          {"x = \"y\"\nz = \"-z\"", "x = \"up\"\nz = \"-z\"",
           "m.toml:26:5: body[1].x is 'up'; write \"x\", \"y\", \"z\", a minus before it, or [x, y, z] for a "
           "direction"},
          {"\"0.25 kg\"", "\"0 kg\"",
           "m.toml:21:8: body[0].mass '0 kg' is not greater than 0; write a value greater than 0"},
          {"\"0.25 kg\"", "\"-0.25 kg\"",
           "m.toml:21:8: body[0].mass '-0.25 kg' is not greater than 0; write a value greater than 0"},
          {"\"0.25 kg\"", "\"0.25 N\"",
           "m.toml:21:8: body[0].mass '0.25 N' is a force, but must be a mass (kg); write it like \"0.25 kg\""},
          {"\"0.25 kg\"", "0.25",
           "m.toml:21:8: body[0].mass '0.25' is a number, but must be a mass (kg); give it a unit, e.g. \"0.25 kg\""},
          {"\"0.4 kg\"", "\"0.4 mm\"",
           "m.toml:15:8: platform.mass '0.4 mm' is a length, but must be a mass (kg); write it like \"0.25 kg\""},
          {"mass = \"0.25 kg\"", "mass = \"0.25 kg\"\ncentre = [0, 0, \"1 deg\"]",
           "m.toml:22:17: body[0].centre[2] '1 deg' is an angle, but must be a length; correct the expression or its "
           "unit"},
          {"copies = { count = 3, about = \"z\" }\nat", "copies = { count = 0, about = \"z\" }\nat",
           "m.toml:19:20: body[0].copies.count is 0; it must be at least 1"},
          {"copies = { count = 3, about = \"z\" }\nat", "copies = { count = 3 }\nat",
           "m.toml:19:10: key 'about' is missing in [body[0].copies]; write about = \"z\""},
          {"copies = { count = 3, about = \"z\" }\nat", "copies = 3\nat",
           "m.toml:19:10: body[0].copies is the whole number 3; write a section [body[0].copies] or { key = value }"},
          {"[[body]]\nname = \"carriage\"\ncopies = { count = 3, about = \"z\" }\nat = [\"R\", 0, \"h\"]\nmass = "
           "\"0.25 kg\"\n\n[[body]]",
           "[body]", "m.toml:17:1: body is one table; write double brackets: [[body]]"},
      });
}

TEST(BranchedFile, RefusesWhatIsWrongWithLimbsBetweenBodies) {
  expect_refused(
      kText,
      {
          {"to = \"carriage\"\n", "to = \"carriage_1\"\n",
           "m.toml:17:1: body 'carriage_2' is where no limb ends; write to = \"carriage_2\" in one"},
          {"[[body]]\nname = \"head\"", "[[body]]\nname = \"lamp\"\nat = [0, 0, 0]\n\n[[body]]\nname = \"head\"",
           "m.toml:23:1: body 'lamp' is where no limb ends; write to = \"lamp\" in one"},
          {"name = \"right\"\n", "name = \"right\"\nto = \"base\"\n",
           "m.toml:47:6: limb[2].to is the base, where no limb ends; let the limb begin at the base: exchange from and "
           "to, and the order of its joints"},
          {"name = \"right\"\n", "name = \"right\"\nto = \"carriage\"\n",
           "m.toml:45:1: limb[2] ends at the body where it begins, 'carriage_1'; name two bodies in from and to"},
          {"from = \"platform\"\nto = \"head\"", "from = \"platform\"\nto = \"haed\"",
           "m.toml:56:6: limb[3].to 'haed' names no body; did you mean 'head'?"},
          {"from = \"platform\"\nto = \"head\"", "from = \"platform\"\nto = \"nut\"",
           "m.toml:56:6: limb[3].to 'nut' names no body; known: base, platform, carriage, carriage_1, carriage_2, "
           "carriage_3, "
           "head"},
          {"from = \"platform\"\nto = \"head\"", "from = \"carriage\"\nto = \"head\"",
           "m.toml:55:8: limb[3].from 'carriage' has copies, 3 about z, and the limb has none; name one of them, "
           "\"carriage_1\""},
          {"from = \"platform\"\nto = \"head\"", "from = \"carriage_4\"\nto = \"head\"",
           "m.toml:55:8: limb[3].from 'carriage_4' names no body; did you mean 'carriage_1'?"},
          {"copies = { count = 3, about = \"z\" }\nfrom", "copies = { count = 2, about = \"z\" }\nfrom",
           "m.toml:39:8: limb[1].from 'carriage' has copies, 3 about z, and the limb has others, 2 about z; copy k of "
           "the limb goes with copy k of the body, so give both the same copies, or name one of them, \"carriage_1\""},
          {"copies = { count = 3, about = \"z\" }\nfrom", "copies = { count = 3, about = \"x\" }\nfrom",
           "m.toml:39:8: limb[1].from 'carriage' has copies, 3 about z, and the limb has others, 3 about x; copy k of "
           "the limb goes with copy k of the body, so give both the same copies, or name one of them, \"carriage_1\""},
          {"to = \"carriage\"\njoints", "from = \"platform\"\nto = \"carriage\"\njoints",
           "m.toml:11:1: body 'platform' is not reached from the base, because limbs lead to it in a circle; turn a "
           "limb round: exchange its from and to, and the order of its joints"},
          {"from = \"platform\"\nto = \"head\"", "from = \"platform\"\nto = 4",
           "m.toml:56:6: limb[3].to is the whole number 4; write a text in quotes"},
          {"name = \"rail\"", "name = \"1\"",
           "m.toml:30:8: limb[0].name is '1', which a number could be; give it a name with a letter"},
          {"name = \"rail\"", "name = \"\"",
           "m.toml:30:8: limb[0].name '' is not a name; write letters, digits, _ and -, and do not begin with -"},
          {"name = \"right\"", "name = \"left\"",
           "m.toml:46:8: limb[2].name 'left' is the name of another limb; give it a name of its own"},
          {"name = \"plate\"", "name = \"left_2\"",
           "m.toml:53:1: limb[3] makes a second limb 'left_2'; give it a name of its own"},
          {"name = \"plate\"", "name = \"each\"",
           "m.toml:54:8: limb[3].name is 'each', which means all limbs; give the limb another name"},
          {"[[limb]]\nname = \"plate\"",
           "[[body]]\nname = \"theta\"\nat = [0, 0, \"1 m\"]\n\n[[limb]]\nname = \"mast\"\nto = \"theta\"\njoints = [ "
           "{ name = \"O\", type = \"fixed\", at = [0, 0, \"1 m\"], axis = \"z\" } ]\n\n[[limb]]\nname = \"plate\"",
           "m.toml:13:15: 'theta_x' is the name of two responses: rotation vector of the platform about the base's x, "
           "and displacement of theta's origin along the base's x; give the body, limb or joint another name"},
      });
}

TEST(BranchedFile, RefusesFramesThatAreNotThere) {
  expect_refused(kText,
                 {
                     {"frame = \"B\"", "frame = \"A\"",
                      "m.toml:74:9: error[0].frame is 'A', which no joint of limb 4 (left_1) is named; known: B, C"},
                     {"frame = \"B\"", "frame = \"D\"",
                      "m.toml:74:9: error[0].frame is 'D', which no joint of limb 4 (left_1) is named; known: B, C"},
                     {"limb = \"left\"\nframe", "limb = [\"left\", \"rail\"]\nframe",
                      "m.toml:74:9: error[0].frame is 'B', which no joint of limb 1 (rail_1) is named; known: q"},
                     {"limb = \"left\"\nframe", "limb = \"each\"\nframe",
                      "m.toml:74:9: error[0].frame is 'B', which no joint of limb 1 (rail_1) is named; known: q"},
                     {"limb = \"left\"\nframe", "limb = \"lefd\"\nframe",
                      "m.toml:73:8: error[0].limb is 'lefd', which no limb is named; write a limb's number, its name, "
                      "a list of these, or \"each\""},
                     {"limb = \"left\"\nframe", "limb = [\"left\", 4]\nframe",
                      "m.toml:73:17: error[0].limb[1] names limb 4 (left_1) a second time; remove it"},
                     {"limb = \"left\"\nframe = \"B\"", "limb = \"left\"\nframe = 8",
                      "m.toml:74:9: error[0].frame is 8; the last frame of limb 4 (left_1) is 6"},
                 });
}

TEST(BranchedFile, RefusesStiffnessThatIsNone) {
  expect_refused(
      kText,
      {
          {"stiffness = { z = \"2 N/um\" }", "stiffness = { z = \"0 N/um\" }",
           "m.toml:34:96: limb[0].joints[0].stiffness.z '0 N/um' is not greater than 0; write a value greater than 0"},
          {"stiffness = { z = \"2 N/um\" }", "stiffness = { z = \"-2 N/um\" }",
           "m.toml:34:96: limb[0].joints[0].stiffness.z '-2 N/um' is not greater than 0; write a value greater than 0"},
          {"stiffness = { z = \"2 N/um\" }", "stiffness = { z = 2 }",
           "m.toml:34:96: limb[0].joints[0].stiffness.z '2' is a number, but must be a stiffness (N/m); give it a "
           "unit, e.g. \"20 N/um\""},
          {"stiffness = { z = \"2 N/um\" }", "stiffness = { z = \"2 N m/rad\" }",
           "m.toml:34:96: limb[0].joints[0].stiffness.z '2 N m/rad' is a rotational stiffness, but must be a stiffness "
           "(N/m); write it like \"20 N/um\""},
          {"stiffness = { z = \"2 N/um\" }", "stiffness = { rx = \"2 N/m\" }",
           "m.toml:34:97: limb[0].joints[0].stiffness.rx '2 N/m' is a stiffness, but must be a rotational stiffness (N "
           "m/rad); write it like \"9000 N m/rad\""},
          {"stiffness = { z = \"2 N/um\" }", "stiffness = { z = \"2 N/furlong\" }",
           "m.toml:34:101: limb[0].joints[0].stiffness.z '2 N/furlong' has an unknown parameter 'furlong'; known: R, "
           "r, w, h, sqrt, sin, cos, tan, atan, atan2, pi"},
          {"stiffness = { z = \"2 N/um\" }", "stiffness = { w = \"2 N/um\" }",
           "m.toml:34:92: unknown key 'w' in [limb[0].joints[0].stiffness]; known: x, y, z, rx, ry, rz"},
          {"stiffness = { z = \"2 N/um\" }", "stiffness = { zz = \"2 N/um\" }",
           "m.toml:34:92: unknown key 'zz' in [limb[0].joints[0].stiffness]; did you mean 'z'?"},
          {"stiffness = { z = \"2 N/um\" }", "stiffness = \"2 N/um\"",
           "m.toml:34:90: limb[0].joints[0].stiffness is the text '2 N/um'; write a section "
           "[limb[0].joints[0].stiffness] or { key = value }"},
          {"stiffness = { z = \"2 N/um\" }", "stiffness = { z = \"R\" }",
           "m.toml:34:96: limb[0].joints[0].stiffness.z 'R' is a length, but must be a stiffness (N/m); write it like "
           "\"20 N/um\""},
          {"stiffness = { z = \"2 N/um\" }", "reaction = \"yes\"",
           "m.toml:34:89: limb[0].joints[0].reaction is the text 'yes'; write true or false, without quotes"},
          {"stiffness = { z = \"2 N/um\" }", "stiffness = { }",
           "m.toml:34:90: limb[0].joints[0].stiffness is empty; write z = \"20 N/um\", for instance, or leave it out "
           "where the joint is rigid"},
          {"stiffness = { z = \"2 N/um\" }", "stiffness = { z = \"1e400 N/m\" }",
           "m.toml:34:97: limb[0].joints[0].stiffness.z '1e400 N/m' has a number that is out of range; write one "
           "between 1e-307 and 1e307, or 0"},
          {"stiffness = { z = \"2 N/um\" }", "stiffness = { z = \"1e300 * 1e300 N/m\" }",
           "m.toml:34:97: limb[0].joints[0].stiffness.z '1e300 * 1e300 N/m' is not finite; look for a division by zero "
           "or the root of a negative number"},
      });
}

TEST(BranchedFile, RefusesStiffnessAlongFreedoms) {
  expect_refused(
      kText,
      {
          {"{ name = \"q\", type = \"P\", at = [\"R\", 0, \"h\"], axis = \"z\", actuated = true, stiffness = { z = \"2 "
           "N/um\" } }",
           "{ name = \"q\", type = \"R\", at = [\"R\", 0, \"h\"], axis = \"z\", stiffness = { rz = \"2 N m/rad\" } }",
           "m.toml:34:80: limb[0].joints[0].stiffness.rz is along the joint's own freedom, where it has no stiffness; "
           "remove rz, or write actuated = true if a drive holds it"},
          {"{ name = \"q\", type = \"P\", at = [\"R\", 0, \"h\"], axis = \"z\", actuated = true, stiffness = { z = \"2 "
           "N/um\" } }",
           "{ name = \"q\", type = \"P\", at = [\"R\", 0, \"h\"], axis = \"z\", stiffness = { z = \"2 N/um\" } }",
           "m.toml:34:79: limb[0].joints[0].stiffness.z is along the joint's own freedom, where it has no stiffness; "
           "remove z, or write actuated = true if a drive holds it"},
          {"{ name = \"q\", type = \"P\", at = [\"R\", 0, \"h\"], axis = \"z\", actuated = true, stiffness = { z = \"2 "
           "N/um\" } }",
           "{ name = \"q\", type = \"H\", at = [\"R\", 0, \"h\"], axis = \"z\", pitch = \"5 mm\", stiffness = { z = "
           "\"2 N/um\" } }",
           "m.toml:34:95: limb[0].joints[0].stiffness.z is along the joint's own freedom, where it has no stiffness; "
           "remove z, or write actuated = true if a drive holds it"},
          {"{ name = \"q\", type = \"P\", at = [\"R\", 0, \"h\"], axis = \"z\", actuated = true, stiffness = { z = \"2 "
           "N/um\" } }",
           "{ name = \"q\", type = \"H\", at = [\"R\", 0, \"h\"], axis = \"z\", pitch = \"5 mm\", stiffness = { rz = "
           "\"2 N m/rad\" } }",
           "m.toml:34:96: limb[0].joints[0].stiffness.rz is along the joint's own freedom, where it has no stiffness; "
           "remove rz, or write actuated = true if a drive holds it"},
          {"{ name = \"q\", type = \"P\", at = [\"R\", 0, \"h\"], axis = \"z\", actuated = true, stiffness = { z = \"2 "
           "N/um\" } }",
           "{ name = \"q\", type = \"C\", at = [\"R\", 0, \"h\"], axis = \"z\", stiffness = { rz = \"2 N m/rad\" } }",
           "m.toml:34:80: limb[0].joints[0].stiffness.rz is along the joint's own freedom, where it has no stiffness; "
           "remove rz, or write actuated = 1 if a drive holds it"},
          {"{ name = \"q\", type = \"P\", at = [\"R\", 0, \"h\"], axis = \"z\", actuated = true, stiffness = { z = \"2 "
           "N/um\" } }",
           "{ name = \"q\", type = \"C\", at = [\"R\", 0, \"h\"], axis = \"z\", actuated = 1, stiffness = { z = \"2 "
           "N/um\" } }",
           "m.toml:34:93: limb[0].joints[0].stiffness.z is along the joint's own freedom, where it has no stiffness; "
           "remove z, or write actuated = true if a drive holds it"},
          {"{ name = \"q\", type = \"P\", at = [\"R\", 0, \"h\"], axis = \"z\", actuated = true, stiffness = { z = \"2 "
           "N/um\" } }",
           "{ name = \"q\", type = \"C\", at = [\"R\", 0, \"h\"], axis = \"z\", actuated = 2, stiffness = { rz = \"2 N "
           "m/rad\" } }",
           "m.toml:34:94: limb[0].joints[0].stiffness.rz is along the joint's own freedom, where it has no stiffness; "
           "remove rz, or write actuated = true if a drive holds it"},
          {"{ name = \"q\", type = \"P\", at = [\"R\", 0, \"h\"], axis = \"z\", actuated = true, stiffness = { z = \"2 "
           "N/um\" } }",
           "{ name = \"q\", type = \"U\", at = [\"R\", 0, \"h\"], axis = \"z\", axis2 = \"x\", actuated = 1, stiffness "
           "= { rx = \"2 N m/rad\" } }",
           "m.toml:34:107: limb[0].joints[0].stiffness.rx is along the joint's own freedom, where it has no stiffness; "
           "remove rx"},
          {"{ name = \"q\", type = \"P\", at = [\"R\", 0, \"h\"], axis = \"z\", actuated = true, stiffness = { z = \"2 "
           "N/um\" } }",
           "{ name = \"q\", type = \"U\", at = [\"R\", 0, \"h\"], axis = \"z\", axis2 = \"x\", actuated = 1, stiffness "
           "= { ry = \"2 N m/rad\" } }",
           "m.toml:34:107: limb[0].joints[0].stiffness.ry is along the joint's own freedom, where it has no stiffness; "
           "remove ry"},
          {"{ name = \"q\", type = \"P\", at = [\"R\", 0, \"h\"], axis = \"z\", actuated = true, stiffness = { z = \"2 "
           "N/um\" } }",
           "{ name = \"q\", type = \"U\", at = [\"R\", 0, \"h\"], axis = \"z\", axis2 = \"x\", actuated = 2, stiffness "
           "= { rz = \"2 N m/rad\" } }",
           "m.toml:34:107: limb[0].joints[0].stiffness.rz is along the joint's own freedom, where it has no stiffness; "
           "remove rz, or write actuated = 1 if a drive holds it"},
          {"at = [\"R\", \"w\", \"h\"] }", "at = [\"R\", \"w\", \"h\"], stiffness = { rx = \"2 N m/rad\" } }",
           "m.toml:41:70: limb[1].joints[0].stiffness.rx is along the joint's own freedom, where it has no stiffness; "
           "remove rx"},
          {"at = [\"R\", \"w\", \"h\"] }", "at = [\"R\", \"w\", \"h\"], stiffness = { ry = \"2 N m/rad\" } }",
           "m.toml:41:70: limb[1].joints[0].stiffness.ry is along the joint's own freedom, where it has no stiffness; "
           "remove ry"},
          {"at = [\"R\", \"w\", \"h\"] }", "at = [\"R\", \"w\", \"h\"], stiffness = { rz = \"2 N m/rad\" } }",
           "m.toml:41:70: limb[1].joints[0].stiffness.rz is along the joint's own freedom, where it has no stiffness; "
           "remove rz"},
      });
}

TEST(BranchedFile, RefusesWhatIsWrongWithLinks) {
  expect_refused(
      kText,
      {
          {"{ from = \"B\", to = \"C\"", "{ from = \"A\", to = \"C\"",
           "m.toml:43:20: limb[1].links[0].from 'A' is not a joint of this limb, and not the body 'carriage' where it "
           "begins; known: B, C, carriage"},
          {"{ from = \"B\", to = \"C\"", "{ from = \"B\", to = \"Cc\"",
           "m.toml:43:30: limb[1].links[0].to 'Cc' is not a joint of this limb, and not the body 'platform' where it "
           "ends; did you mean 'C'?"},
          {"{ from = \"B\", to = \"C\"", "{ from = \"base\", to = \"C\"",
           "m.toml:43:20: limb[1].links[0].from 'base' is not a joint of this limb, and not the body 'carriage' where "
           "it "
           "begins; known: B, C, carriage"},
          {"{ from = \"B\", to = \"C\"", "{ from = \"platform\", to = \"C\"",
           "m.toml:43:20: limb[1].links[0].from 'platform' is not a joint of this limb, and not the body 'carriage' "
           "where "
           "it begins; known: B, C, carriage"},
          {"{ from = \"B\", to = \"C\"", "{ from = \"B\", to = \"carriage\"",
           "m.toml:43:30: limb[1].links[0].to 'carriage' is not a joint of this limb, and not the body 'platform' "
           "where "
           "it ends; known: B, C, platform"},
          {"{ from = \"B\", to = \"C\"", "{ from = \"C\", to = \"B\"",
           "m.toml:43:11: limb[1].links[0] from 'C' to 'B' goes backwards; write the joint first that is first in the "
           "limb"},
          {"{ from = \"B\", to = \"C\"", "{ from = \"B\", to = \"B\"",
           "m.toml:43:11: limb[1].links[0] from 'B' to 'B' ends where it begins; name two joints, or a body and a "
           "joint"},
          {"{ from = \"B\", to = \"C\"", "{ to = \"C\"",
           "m.toml:43:11: key 'from' is missing in [limb[1].links[0]]; write from = \"B\""},
          {"{ from = \"B\", to = \"C\"", "{ from = \"carriage\", to = \"C\"",
           "m.toml:43:11: limb[1].links[0] from 'carriage' to 'C' passes joint 'B', whose axis is not on the line "
           "between them; write a link to that joint and one from it"},
          {"at = [\"r\", \"w\", \"200 mm\"] } ]", "at = [\"R\", \"w\", \"h\"] } ]",
           "m.toml:43:11: limb[1].links[0] from 'B' to 'C' has no length, because both are one point at home; correct "
           "its ends"},
          {"E = \"130 GPa\", ", "",
           "m.toml:43:11: limb[1].links[0] has no E; write E, G and diameter, or E, G, A, Iy, Iz and J, or compliance"},
          {"G = \"5 GPa\", ", "",
           "m.toml:43:11: limb[1].links[0] has no G; write E, G and diameter, or E, G, A, Iy, Iz and J, or compliance"},
          {", diameter = \"8 mm\", bore = \"6 mm\"", "",
           "m.toml:43:11: limb[1].links[0] has no A, and no diameter; write E, G and diameter, or E, G, A, Iy, Iz and "
           "J, or compliance"},
          {"diameter = \"8 mm\", bore = \"6 mm\"", "A = \"50 mm^2\", Iy = \"200 mm^4\", Iz = \"200 mm^4\"",
           "m.toml:43:11: limb[1].links[0] has no J; write E, G and diameter, or E, G, A, Iy, Iz and J, or compliance"},
          {"diameter = \"8 mm\", bore = \"6 mm\"", "bore = \"6 mm\"",
           "m.toml:43:70: limb[1].links[0].bore is given without `diameter`; write diameter"},
          {"bore = \"6 mm\"", "A = \"50 mm^2\"",
           "m.toml:43:86: limb[1].links[0].A is given besides `diameter`; remove one of them"},
          {"bore = \"6 mm\"", "bore = \"8 mm\"",
           "m.toml:43:89: limb[1].links[0].bore is not between 0 and the diameter; write the inner diameter, less than "
           "`diameter`"},
          {"bore = \"6 mm\"", "bore = \"-1 mm\"",
           "m.toml:43:89: limb[1].links[0].bore is not between 0 and the diameter; write the inner diameter, less than "
           "`diameter`"},
          {"bore = \"6 mm\"", "bore = \"6 deg\"",
           "m.toml:43:89: limb[1].links[0].bore '6 deg' is an angle, but must be a length; correct the expression or "
           "its unit"},
          {"bore = \"6 mm\"", "shear = 0",
           "m.toml:43:90: limb[1].links[0].shear '0' is not greater than 0; write a value greater than 0"},
          {"bore = \"6 mm\"", "shear = \"1 mm\"",
           "m.toml:43:90: limb[1].links[0].shear '1 mm' is a length, but must be a number; correct the expression or "
           "its unit"},
          {"bore = \"6 mm\"", "wall = \"1 mm\"",
           "m.toml:43:82: unknown key 'wall' in [limb[1].links[0]]; known: from, to, E, G, diameter, bore, A, Iy, Iz, "
           "J, shear, y, ... (13 in all)"},
          {"\"130 GPa\"", "\"-130 GPa\"",
           "m.toml:43:39: limb[1].links[0].E '-130 GPa' is not greater than 0; write a value greater than 0"},
          {"\"130 GPa\"", "\"130 N/mm\"",
           "m.toml:43:39: limb[1].links[0].E '130 N/mm' is a stiffness, but must be a modulus (Pa); write it like "
           "\"210 GPa\""},
          {"\"130 GPa\"", "130e9",
           "m.toml:43:39: limb[1].links[0].E '1.3e+11' is a number, but must be a modulus (Pa); give it a unit, e.g. "
           "\"210 GPa\""},
          {"G = \"5 GPa\"", "G = \"5 N m\"",
           "m.toml:43:54: limb[1].links[0].G '5 N m' is a moment, but must be a modulus (Pa); write it like \"210 "
           "GPa\""},
          {"diameter = \"8 mm\"", "diameter = \"8 mm^2\"",
           "m.toml:43:74: limb[1].links[0].diameter '8 mm^2' is length^2, but must be a length; correct the expression "
           "or its unit"},
          {"diameter = \"8 mm\"", "diameter = 0",
           "m.toml:43:74: limb[1].links[0].diameter '0' is not greater than 0; write a value greater than 0"},
          {"A = \"90 mm^2\"", "A = \"90 mm\"",
           "m.toml:59:62: limb[3].links[0].A '90 mm' is a length, but must be an area (mm^2); write it like \"50 "
           "mm^2\""},
          {"Iy = \"400 mm^4\"", "Iy = \"400 mm^2\"",
           "m.toml:59:78: limb[3].links[0].Iy '400 mm^2' is length^2, but must be an area moment (mm^4); write it like "
           "\"2000 mm^4\""},
          {"J = \"800 mm^4\", ", "",
           "m.toml:59:3: limb[3].links[0] has no J; write E, G and diameter, or E, G, A, Iy, Iz and J, or compliance"},
          {", y = \"y\"", "",
           "m.toml:59:3: limb[3].links[0] from 'F' to 'head' has no y, but its Iy and Iz differ; write y = a direction "
           "at home"},
          {"y = \"y\" }", "y = [\"-5 mm\", 0, \"-30 mm\"] }",
           "m.toml:59:127: limb[3].links[0].y is along the link; give another direction"},
          {"y = \"y\" }", "y = [0, 0, 0] }",
           "m.toml:59:127: limb[3].links[0].y is zero and has no direction; give it a length, e.g. [0, 0, 1]"},
          {"y = \"y\" }", "y = \"y\", compliance = [] }",
           "m.toml:59:145: limb[3].links[0].compliance has 0 rows; write six lists of six numbers"},
          {"y = \"y\" }",
           "y = \"y\", compliance = "
           "[[1,0,0,0,0,0],[0,1,0,0,0,0],[0,0,1,0,0,0],[0,0,0,1,0,0],[0,0,0,0,1,0],[0,0,0,0,0,1]] }",
           "m.toml:59:34: limb[3].links[0].E is given besides `compliance`; remove one of them"},
          {"E = \"130 GPa\", G = \"5 GPa\", diameter = \"8 mm\", bore = \"6 mm\"",
           "compliance = [[1,0,0,0,0,0],[0,1,0,0,0,0],[0,0,1,0,0,0],[0,0,0,1,0,0],[0,0,0,0,1,0],[0,0,0,0,0,1]]",
           "m.toml:43:11: limb[1].links[0] from 'B' to 'C' has no y, which is an axis of its compliance; write y = a "
           "direction at home"},
          {"links = [ { from = \"B\", to = \"C\", E = \"130 GPa\", G = \"5 GPa\", diameter = \"8 mm\", bore = \"6 mm\" "
           "} ]",
           "links = [ { from = \"B\", to = \"C\" } ]",
           "m.toml:43:11: limb[1].links[0] has no E; write E, G and diameter, or E, G, A, Iy, Iz and J, or compliance"},
          {"links = [ { from = \"B\", to = \"C\", E = \"130 GPa\", G = \"5 GPa\", diameter = \"8 mm\", bore = \"6 mm\" "
           "} ]",
           "links = { from = \"B\", to = \"C\" }", "m.toml:43:9: limb[1].links is a section; write a list in [ ]"},
      });
}

TEST(BranchedFile, RefusesWhatIsNoCompliance) {
  expect_refused(
      kText, {
                 {" [0, 0, 0, 0, 1e-8, 0],", "",
                  "m.toml:60:14: limb[3].compliance has 5 rows; write six lists of six numbers"},
                 {"[0, 0, 0, 0, 1e-8, 0]", "[0, 0, 0, 0, 1e-8]",
                  "m.toml:62:26: limb[3].compliance[4] has 5 numbers; write six lists of six numbers"},
                 {"[0, 0, 0, 0, 1e-8, 0]", "[0, 0, 0, 0, \"1e-8\", 0]",
                  "m.toml:62:39: limb[3].compliance[4][4] is the text '1e-8'; write a number without a unit"},
                 {"[0, 0, 0, 0, 1e-8, 0]", "[0, 0, 0, 0, \"1e-8 m/N\", 0]",
                  "m.toml:62:39: limb[3].compliance[4][4] is the text '1e-8 m/N'; write a number without a unit"},
                 {"[0, 0, 0, 0, 1e-8, 0]", "[0, 0, 0, 1e-9, 1e-8, 0]",
                  "m.toml:60:14: limb[3].compliance is not symmetric: row 5, column 4 is 1e-09, and row 4, column 5 is "
                  "0; write the compliance as rows of six numbers, [rotation; translation] from [moment; force]"},
                 {"[0, 0, 0, 0, 1e-8, 0]", "[0, 0, 1e-9, 0, 1e-8, 0]",
                  "m.toml:60:14: limb[3].compliance is not symmetric: row 5, column 3 is 1e-09, and row 3, column 5 is "
                  "0; write the compliance as rows of six numbers, [rotation; translation] from [moment; force]"},
                 {"[0, 0, 0, 0, 1e-8, 0]", "[0, 0, 0, 0, -1e-8, 0]",
                  "m.toml:60:14: limb[3].compliance has a negative eigenvalue, so a load would do work; write the "
                  "compliance as rows of six numbers, [rotation; translation] from [moment; force]"},
                 {"[0, 0, 0, 0, 1e-8, 0]", "[0, 0, 0, 0, inf, 0]",
                  "m.toml:62:39: limb[3].compliance[4][4] is not finite; write a finite number"},
                 {"[0, 0, 0, 0, 1e-8, 0]", "[0, 0, 0, 0, nan, 0]",
                  "m.toml:62:39: limb[3].compliance[4][4] is not finite; write a finite number"},
                 {"[0, 0, 0, 0, 1e-8, 0]", "5",
                  "m.toml:62:26: limb[3].compliance[4] is the whole number 5; write a list in [ ]"},
             });
}

TEST(BranchedFile, RefusesWhatIsWrongWithLoads) {
  expect_refused(
      kText,
      {
          {"body = \"head\"\nat", "body = \"base\"\nat",
           "m.toml:66:8: load.body is the base, which does not move; name the body on which the load acts"},
          {"body = \"head\"\nat", "body = \"haed\"\nat",
           "m.toml:66:8: load.body 'haed' names no body; did you mean 'head'?"},
          {"body = \"head\"\nat", "body = \"carriage\"\nat",
           "m.toml:66:8: load.body 'carriage' has copies, 3 about z; name one of them, "
           "\"carriage_1\""},
          {"body = \"head\"\nat", "body = 2\nat",
           "m.toml:66:8: load.body is the whole number 2; write a text in quotes"},
          {"\"-9.81 m/s^2\"", "\"-9.81 N\"",
           "m.toml:65:18: load.gravity[2] '-9.81 N' is a force, but must be an acceleration (m/s^2); write it like "
           "\"9.81 m/s^2\""},
          {"\"-9.81 m/s^2\"", "-9.81",
           "m.toml:65:18: load.gravity[2] '-9.81' is a number, but must be an acceleration (m/s^2); give it a unit, "
           "e.g. \"9.81 m/s^2\""},
          {"\"-9.81 m/s^2\"", "\"-9.81 m/s\"",
           "m.toml:65:27: load.gravity[2] '-9.81 m/s' has an unknown parameter 's'; known: R, r, w, h, sqrt, sin, cos, "
           "tan, atan, atan2, pi"},
          {"\"3 N\"", "\"3 kg\"",
           "m.toml:68:10: load.force[0] '3 kg' is a mass, but must be a force (N); write it like \"5 N\""},
          {"\"3 N\"", "\"3 N m\"",
           "m.toml:68:10: load.force[0] '3 N m' is a moment, but must be a force (N); write it like \"5 N\""},
          {"\"0.5 N m\"", "\"0.5 N\"",
           "m.toml:69:17: load.moment[2] '0.5 N' is a force, but must be a moment (N m); write it like \"0.5 N m\""},
          {"\"20 mm\"]\nforce", "\"20 deg\"]\nforce",
           "m.toml:67:13: load.at[2] '20 deg' is an angle, but must be a length; correct the expression or its unit"},
          {"force = [\"3 N\", 0, 0]", "force = [\"3 N\", 0]",
           "m.toml:68:9: load.force has 2 values; write three, e.g. [\"60 mm\", 0, 0]"},
          {"force = [\"3 N\", 0, 0]", "force = \"3 N\"",
           "m.toml:68:9: load.force is the text '3 N'; write a list in [ ]"},
          {"force = [\"3 N\", 0, 0]", "torque = [\"3 N m\", 0, 0]",
           "m.toml:68:1: unknown key 'torque' in [load]; known: gravity, body, at, force, moment"},
          {"[load]", "[[load]]", "m.toml:64:1: load is a list; write a section [load] or { key = value }"},
          {"[load]", "[load]\ngravity = [0, 0, 0]\n\n[load]",
           "m.toml:67:1: this is not TOML: parsing table header: cannot redefine existing table 'load'; correct this "
           "line; names of parameters and expressions stand in quotes"},
      });
}

TEST(BranchedFile, NamesBodiesThatNothingHolds) {
  expect_refused(
      kText, {
                 {"type = \"fixed\", at = [\"5 mm\", 0, \"180 mm\"]", "type = \"R\", at = [\"5 mm\", 0, \"180 mm\"]",
                  "m.toml:57:12: the drives do not hold body 'head': joint 'F' of limb 10 (plate) is loose, and body "
                  "'head' turns about (0, 0, 1); fix or drive that joint, or hold body 'head' by another limb"},
                 {"type = \"fixed\", at = [\"5 mm\", 0, \"180 mm\"]", "type = \"P\", at = [\"5 mm\", 0, \"180 mm\"]",
                  "m.toml:57:12: the drives do not hold body 'head': joint 'F' of limb 10 (plate) is loose, and body "
                  "'head' slides along (0, 0, -1); fix or drive that joint, or hold body 'head' by another limb"},
                 {"{ name = \"q\", type = \"P\", at = [\"R\", 0, \"h\"], axis = \"z\", actuated = true, stiffness = { "
                  "z = \"2 N/um\" } }",
                  "{ name = \"q\", type = \"P\", at = [\"R\", 0, \"h\"], axis = \"z\" }, { name = \"t\", type = \"R\", "
                  "at = [\"R\", 0, \"h\"], axis = \"z\", actuated = true }",
                  "m.toml:34:3: the drives do not hold the platform, which has 6 freedoms and 3 drives: joint 'q' of "
                  "limb 1 (rail_1) is loose, and the platform slides along (0, 0, -1); write actuated = true at one "
                  "more joint, or correct the axes"},
             });
}

/// The text with every `from` replaced by `to`.
std::string with_all(std::string text, const std::string& from, const std::string& to) {
  for (std::size_t at = text.find(from); at != std::string::npos; at = text.find(from, at + to.size())) {
    text.replace(at, from.size(), to);
  }
  return text;
}

TEST(BranchedFile, NamesRigidLimbsThatOverConstrainEachOther) {
  const std::string table = text_of("lift-table");
  const std::string drive = ", stiffness = { z = \"90 N/um\" }";
  // One elastic leg of four is enough, but not if it is elastic only sideways.
  const std::size_t first = table.find(drive) + drive.size();
  const std::string one = table.substr(0, first) + with_all(table.substr(first), drive, "");
  EXPECT_EQ(problem_of(one), "read");
  for (const std::string& sideways : {with_all(one, "z = \"90", "x = \"90"), with_all(table, "z = \"90", "x = \"90")}) {
    EXPECT_EQ(problem_of(sideways),
              "m.toml:25:3: limbs 1, 2, 3 and 4 are rigid in some directions, in which they over-constrain each other; "
              "give links or joints stiffness, because rigid parts do not tell how large their forces are");
  }
  // The rigid rods of a parallelogram are named as a pair of limbs.
  const std::string links = text_of("delta-parallelogram");
  EXPECT_EQ(problem_of(with_all(with_all(links, "links  = [ { from = \"foot\"", "#"), "{ from = \"B\"", "#")),
            "m.toml:44:3: limbs left_1 and right_1 are rigid and over-constrain each other; give links or joints "
            "stiffness, because rigid parts do not tell how large their forces are");
}

TEST(BranchedFile, AJointWithTwoDrivesHasAForceOfEach) {
  std::string text = with_all(kText, "type = \"P\", at = [\"R\", 0, \"h\"]", "type = \"C\", at = [0, 0, \"h\"]");
  text = with_all(text, R"(["x", "y", "z"])", R"(["x", "y", "z", "rx", "ry", "rz"])");
  text = with_all(text, "\"210 mm\"] }",
                  R"("210 mm"], rx = ["-1 deg", "1 deg"], ry = ["-1 deg", "1 deg"], rz = ["-1 deg", "1 deg"] })");
  EXPECT_EQ(problem_of(text), "read");
  const std::vector<Response> responses = catalog_entry(text, "m.toml").description.responses;
  for (const char* name : {"actuator_q_rz_rail_2", "actuator_q_z_rail_2"}) {
    EXPECT_EQ(std::ranges::count(responses, name, &Response::name), 1) << name;
  }
}

}  // namespace
}  // namespace poesy::file
