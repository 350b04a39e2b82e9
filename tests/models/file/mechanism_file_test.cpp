#include "models/file/mechanism_file.h"

#include <gtest/gtest.h>

#include "models/file/mobility.h"
#include "tests/models/file/files.h"
#include "tests/models/file/wrong.h"

namespace poesy::file {
namespace {

/// In the name of a drive, * is replaced by the number of the limb's copy. A name without * is one drive for all
/// copies, and for joints of other limbs with this name.
TEST(MechanismFile, DrivesAreNamed) {
  const Mechanism delta = from_file("delta6");
  const std::vector<Drive> drives = drives_of(delta);
  ASSERT_EQ(drives.size(), 3u);
  for (std::size_t k = 0; k < 3; ++k) {
    EXPECT_EQ(drives[k].name, "motor_" + std::to_string(k + 1));
    EXPECT_EQ(drives[k].joints, (std::vector<std::size_t>{7 * k, 7 * (k + 3)}));
  }
  std::string text = replaced(text_of("rps3"), {"actuated = true", "actuated = \"belt\""});
  text = replaced(text, {"[\"rx\", \"ry\", \"z\"]", "[\"z\"]"});
  text = replaced(text, {"rx = [\"-20 deg\", \"20 deg\"], ry = [\"-20 deg\", \"20 deg\"], ", ""});
  EXPECT_EQ(problem_of(text), "read") << "three jacks on one belt";
  const MechanismFile file = read_mechanism_file(text, "m.toml");
  const std::vector<Drive> belt = drives_of(mechanism(file, default_geometry(file)));
  ASSERT_EQ(belt.size(), 1u);
  EXPECT_EQ(belt[0].joints, (std::vector<std::size_t>{1, 6, 11}));
  EXPECT_EQ(drives_of(from_file("rps3")).size(), 3u) << "those without a name are one for each joint";
}

TEST(MechanismFile, RefusesWhatIsWrongInRps3) {
  expect_refused(
      "rps3",
      {
          {"poesy-mechanism", "poesy-study",
           "m.toml:1:11: format is 'poesy-study'; a mechanism has format = \"poesy-mechanism\""},
          {"version = 1", "version = 2",
           "m.toml:2:11: version is 2, but this poesy knows version 1 only; use a newer poesy"},
          {"version = 1", "version = \"1\"", "m.toml:2:11: version is the text '1'; write a whole number"},
          {"version = 1", "versoin = 1", "m.toml:2:1: unknown key 'versoin'; did you mean 'version'?"},
          {"name    = \"rps3\"", "name    = \"3 rps\"",
           "m.toml:3:11: name '3 rps' is not a name; write letters, digits, _ and -, and do not begin with -"},
          {"name    = \"rps3\"", "name    = \"-rps3\"",
           "m.toml:3:11: name '-rps3' is not a name; write letters, digits, _ and -, and do not begin with -"},
          {"name    = \"rps3\"", "", "m.toml:1:1: key 'name' is missing; write name = \"rps3\""},
          {"[geometry]", "[geometri]", "m.toml:6:2: unknown key 'geometri'; did you mean 'geometry'?"},
          {"\"250 mm\"", "250",
           "m.toml:7:5: geometry.a is a number; a parameter is a length or an angle: give it a unit, e.g. \"1 mm\""},
          {"\"250 mm\"", "0",
           "m.toml:7:5: geometry.a is a number; a parameter is a length or an angle: give it a unit, e.g. \"1 mm\""},
          {"\"250 mm\"", "\"250\"",
           "m.toml:7:5: geometry.a is a number; a parameter is a length or an angle: give it a unit, e.g. \"1 mm\""},
          {"\"250 mm\"", "\"250 mn\"",
           "m.toml:7:20: geometry.a.value '250 mn' has an unknown unit 'mn'; known: m, cm, mm, um, in, mil, thou, rad, "
           "mrad, deg, "
           "arcmin, arcsec; write * to multiply"},
          {"\"250 mm\"", "\"250 mm^2\"",
           "m.toml:7:5: geometry.a is length^2; a parameter is a length or an angle: give it a unit, e.g. \"1 mm\""},
          {"\"250 mm\"", "\"250 mm = 1\"",
           "m.toml:7:23: geometry.a.value '250 mm = 1' cannot be read at '= 1'; write numbers with units, parameters, "
           "+ "
           "- * / ^ ( ), sqrt, sin, cos, tan, atan, atan2 and pi, e.g. \"a + 20 mm\""},
          {"\"250 mm\"", "\"h / 2\"",
           "m.toml:7:16: geometry.a.value 'h / 2' has an unknown parameter 'h'; values in [geometry] are numbers; "
           "write the expression where it is used"},
          {"c = {", "mm = {", "m.toml:8:6: geometry.mm is a unit; give the parameter another name"},
          {"c = {", std::string(49, 'c') + " = {",
           "m.toml:8:53: geometry." + std::string(49, 'c') + " '" + std::string(49, 'c') +
               "' is too long; write at most 48 letters"},
          {"c = {", "sin = {",
           "m.toml:8:7: geometry.sin has a meaning in expressions; give the parameter another name"},
          {"origin      = [0, 0, \"h\"]", "origin      = [0, 0, \"h + 3 deg\"]",
           "m.toml:12:25: platform.origin[2] 'h + 3 deg' adds a length and an angle; both must have one dimension; a "
           "bare number other than 0 has none, so give it a unit"},
          {"origin      = [0, 0, \"h\"]", "origin      = [0, 0, 600]",
           "m.toml:12:22: platform.origin[2] '600' is a number, but must be a length; give it a unit, e.g. \"1 mm\""},
          {"origin      = [0, 0, \"h\"]", "origin      = [0, \"h\"]",
           "m.toml:12:15: platform.origin has 2 values; write three, e.g. [\"60 mm\", 0, 0]"},
          {"origin      = [0, 0, \"h\"]", "orign      = [0, 0, \"h\"]",
           "m.toml:12:1: unknown key 'orign' in [platform]; did you mean 'origin'?"},
          {"\"vector\"", "\"xyx\"", "m.toml:13:15: platform.rotation is 'xyx', which is unknown; did you mean 'xyz'?"},
          {"[\"rx\", \"ry\", \"z\"]", "[\"rx\", \"ry\", \"zz\"]",
           "m.toml:14:28: platform.coordinates[2] is 'zz', which is unknown; did you mean 'z'?"},
          {"[\"rx\", \"ry\", \"z\"]", "[\"rx\", \"rx\", \"z\"]",
           "m.toml:14:22: platform.coordinates[1] 'rx' is the name of another coordinate; give it a name of its own"},
          {"[\"rx\", \"ry\", \"z\"]", "[\"rx\", { rx = \"ry\" }, \"z\"]",
           "m.toml:14:22: platform.coordinates[1] 'rx' is the name of another coordinate; give it a name of its own"},
          {"[\"rx\", \"ry\", \"z\"]", "[\"rx\", { beta = \"ry\", g = \"z\" }]",
           "m.toml:14:22: platform.coordinates[1] has 2 names; write { alpha = \"rx\" }"},
          {"[\"rx\", \"ry\", \"z\"]", "[\"rx\", \"ry\"]",
           "m.toml:15:73: unknown coordinate 'z' in [platform.workspace]; known: rx, ry"},
          {"z = [\"500 mm\", \"700 mm\"] }", "z = [\"700 mm\", \"500 mm\"] }",
           "m.toml:15:78: platform.workspace.z[0] '700 mm' is not below '500 mm'; write the lowest value first"},
          {"z = [\"500 mm\", \"700 mm\"] }", "z = [\"500 mm\"] }",
           "m.toml:15:77: platform.workspace.z has 1 values; write [lowest, highest]"},
          {"z = [\"500 mm\", \"700 mm\"] }", "z = [\"5 deg\", \"7 deg\"] }",
           "m.toml:15:78: platform.workspace.z[0] '5 deg' is an angle, but must be a length; correct the expression or "
           "its unit"},
          {", z = [\"500 mm\", \"700 mm\"] }", " }",
           "m.toml:15:15: key 'z' is missing in [platform.workspace]; write z = [\"500 mm\", \"600 mm\"]"},
          {"workspace ", "workspac", "m.toml:15:1: unknown key 'workspac' in [platform]; did you mean 'workspace'?"},
          {"tool        = [0, 0, \"100 mm\"]", "tool = [0, 0, \"100 mm\"]\nx = \"y\"",
           "m.toml:11:1: platform has one of x and z; give both, or neither"},
          {"tool        = [0, 0, \"100 mm\"]", "x = \"-z\"\nz = \"z\"",
           "m.toml:16:5: platform.x is parallel to platform.z; give another direction"},
          {"tool        = [0, 0, \"100 mm\"]", "points = [[0, 0, 0], [0, 0, \"h\"], [0, 0, \"a\"]]",
           "m.toml:16:10: the metric has no meaning: the points are on one line, about which the platform may turn "
           "unseen; write in [platform] three or more of its points that are not on one line, e.g. metric_points = "
           "[[\"100 mm\", 0, 0], [0, \"100 mm\", 0], [0, 0, \"100 mm\"]]"},
          {"tool        = [0, 0, \"100 mm\"]", "points = [[0, 0, 0], [0, 0, \"h\"]]",
           "m.toml:16:10: platform.points has fewer than three points; give three that are not on one line"},
          {"[[limb]]", "[limb]", "m.toml:18:1: limb is one table; write double brackets: [[limb]]"},
          {"count = 3", "count = 0", "m.toml:19:20: limb[0].copies.count is 0; it must be at least 1"},
          {"count = 3", "count = 2.5", "m.toml:19:20: limb[0].copies.count is the number 2.5; write a whole number"},
          {"count = 3", "count = 100",
           "m.toml:18:1: limb[0] brings the moving axes of all limbs to 500; a mechanism may have 120; take fewer "
           "joints "
           "or copies"},
          {"count = 3", "count = 1",
           "m.toml:18:1: limb is alone, so nothing closes a loop; write two limbs or more, or copies"},
          {"about = \"z\"", "about = \"w\"",
           "m.toml:19:31: limb[0].copies.about is 'w', which is unknown; known: x, y, z"},
          {", about = \"z\"", "", "m.toml:19:10: key 'about' is missing in [limb[0].copies]; write about = \"z\""},
          {"copies = { count = 3", "copies = { cuont = 3",
           "m.toml:19:12: unknown key 'cuont' in [limb[0].copies]; did you mean 'count'?"},
          {"{ name = \"A\", type = \"R\"", "{ name = \"A\", type = \"Q\"",
           "m.toml:21:24: limb[0].joints[0].type is 'Q', which is unknown; known: R, P, H, C, U, S, fixed"},
          {"{ name = \"A\", type = \"R\"", "{ name = \"A\", tpye = \"R\"",
           "m.toml:21:17: unknown key 'tpye' in [limb[0].joints[0]]; did you mean 'type'?"},
          {"{ name = \"A\", type = \"R\"", "{ name = \"A\"",
           "m.toml:21:3: key 'type' is missing in [limb[0].joints[0]]; write type = \"R\""},
          {"{ name = \"A\", type = \"R\"", "{ type = \"R\"",
           "m.toml:21:3: key 'name' is missing in [limb[0].joints[0]]; write name = \"A\""},
          {"{ name = \"A\", type = \"R\"", "{ name = \"S\", type = \"R\"",
           "m.toml:23:12: limb[0].joints[2].name 'S' is the name of another joint of this limb; give it a name of its "
           "own"},
          {"{ name = \"A\", type = \"R\"", "{ name = \"A\", type = \"R\", pitch = \"5 mm\"",
           "m.toml:21:29: limb[0].joints[0].pitch does not belong to type = \"R\"; remove it"},
          {"{ name = \"A\", type = \"R\"", "{ name = \"A\", type = \"R\", axis2 = \"x\"",
           "m.toml:21:29: limb[0].joints[0].axis2 does not belong to type = \"R\"; remove it"},
          {"{ name = \"A\", type = \"R\"", "{ name = \"A\", type = \"H\"",
           "m.toml:21:3: key 'pitch' is missing in [limb[0].joints[0]]; write pitch = \"5 mm\""},
          {"{ name = \"A\", type = \"R\"", "{ name = \"A\", type = \"H\", pitch = 0",
           "m.toml:21:37: limb[0].joints[0].pitch is zero, so the joint does not slide; write type = \"R\", or its "
           "pitch"},
          {"{ name = \"A\", type = \"R\"", "{ name = \"A\", type = \"H\", pitch = 5",
           "m.toml:21:37: limb[0].joints[0].pitch '5' is a number, but must be a length; give it a unit, e.g. \"1 "
           "mm\""},
          {"{ name = \"A\", type = \"R\"", "{ name = \"A\", type = \"U\", axis2 = [0, -2, 0]",
           "m.toml:21:37: limb[0].joints[0].axis2 is parallel to the first axis; a universal joint has two axes; one "
           "alone is a revolute joint, type = \"R\""},
          {"{ name = \"A\", type = \"R\"", "{ name = \"A\", type = \"R\", x = \"-y\"",
           "m.toml:21:33: limb[0].joints[0].x is parallel to the joint's axis; give another direction"},
          {"{ name = \"A\", type = \"R\"", "{ name = \"A\", type = \"R\", actuated = 2",
           "m.toml:21:40: limb[0].joints[0].actuated must be true, false or a name; write true, false, or the name of "
           "its drive"},
          {"{ name = \"A\", type = \"R\"", "{ name = \"A\", type = \"C\", actuated = \"motor\"",
           "m.toml:21:40: limb[0].joints[0].actuated is a text, but a joint of type C has two axes; write two joints "
           "of "
           "one axis each, of which the driven one names its drive"},
          {"{ name = \"A\", type = \"R\"", "{ name = \"A\", type = \"U\", axis2 = \"x\", actuated = true",
           "m.toml:21:53: limb[0].joints[0].actuated is true; write 1 or 2, for its first or second axis"},
          {"at = [\"a\", 0, 0], axis = \"y\"", "axis = \"y\"",
           "m.toml:21:3: limb[0].joints[0] 'A' has no point; write at = [x, y, z]"},
          {"at = [\"a\", 0, 0], axis = \"y\"", "at = [\"a\", 0, 0]",
           "m.toml:21:3: limb[0].joints[0] 'A' has no direction; write axis = \"z\", or from = and to = with names of "
           "joints or points"},
          {"at = [\"a\", 0, 0], axis = \"y\"", "at = [\"a\", 0, 0], axis = \"q\"",
           "m.toml:21:54: limb[0].joints[0].axis is 'q'; write \"x\", \"y\", \"z\", a minus before it, or [x, y, z] "
           "for a direction"},
          {"at = [\"a\", 0, 0], axis = \"y\"", "at = [\"a\", 0, 0], axis = [0, 0, 0]",
           "m.toml:21:54: limb[0].joints[0].axis is zero and has no direction; give it a length, e.g. [0, 0, 1]"},
          {"at = [\"a\", 0, 0], axis = \"y\"", "at = [\"a\", 0, 0], axis = [0, \"a\", 1]",
           "m.toml:21:63: limb[0].joints[0].axis mixes a length and a number; the entries of a direction must have one "
           "dimension"},
          {"at = [\"a\", 0, 0], axis = \"y\"", "at = [\"b\", 0, 0], axis = \"y\"",
           "m.toml:21:36: limb[0].joints[0].at[0] 'b' has an unknown parameter 'b'; known: a, c, h, sqrt, sin, cos, "
           "tan, atan, atan2, pi"},
          {"at = [\"a\", 0, 0], axis = \"y\"", "at = \"corner\", axis = \"y\"",
           "m.toml:21:34: limb[0].joints[0].at 'corner' is neither a joint of this limb nor a point; known: A, q, S"},
          {"at = [\"a\", 0, 0], axis = \"y\"", "at = \"A\", axis = \"y\"",
           "m.toml:21:3: limb[0].joints[0] 'A' takes its point from itself; write at = [x, y, z] for one of them"},
          {"from = \"A\"", "from = \"B\"",
           "m.toml:22:36: limb[0].joints[1].from 'B' is neither a joint of this limb nor a point; known: A, q, S"},
          {"from = \"A\"", "from = \"S\"",
           "m.toml:22:46: limb[0].joints[1].to 'S' and 'S' are one point at home, so no direction goes from one to the "
           "other; write axis = instead, or move one of them"},
          {"from = \"A\"", "from = \"q\"",
           "m.toml:22:3: limb[0].joints[1] 'q' takes its point from itself; write at = [x, y, z] for one of them"},
          {"to = \"S\"", "to = \"S\", axis = \"z\"",
           "m.toml:22:58: limb[0].joints[1].axis is given besides `to`; remove one of them"},
          {"to = \"S\", actuated", "to = \"S\", aktuated",
           "m.toml:22:51: unknown key 'aktuated' in [limb[0].joints[1]]; did you mean 'actuated'?"},
          {"actuated = true", "actuated = \"yes\"",
           "m.toml:22:62: limb[0].joints[1].actuated is the text 'yes'; write true or false without quotes"},
          {"actuated = true", "actuated = \"motor 1\"",
           "m.toml:22:62: limb[0].joints[1].actuated 'motor 1' is not a name; write letters, digits, _ and -, and do "
           "not "
           "begin with -"},
          {"actuated = true", "actuated = \"z\"",
           "m.toml:22:3: the drive of joint 'q' has the name 'z' of a coordinate; give it another name, because files "
           "of poses may have columns of both"},
          {"actuated = true", "actuated = \"q_2_1\"",
           "m.toml:22:3: the drive of joint 'q' has the name 'q_2_1' of a joint's displacement; give it another name, "
           "because files of poses may have columns of both"},
          {"actuated = true", "actuated = \"motor\"",
           "m.toml:14:15: platform.coordinates are not independent: rx follows from the others, and the platform has 1 "
           "freedom; remove it, take another, correct the axes of the joints, or let fewer joints share a drive"},
          {"type = \"R\", at = [\"a\", 0, 0], axis = \"y\" }",
           "type = \"R\", at = [\"a\", 0, 0], axis = \"y\", actuated = \"m\" }, { name = \"p\", type = \"P\", from = "
           "\"A\", to = \"S\", actuated = \"m\" }",
           "m.toml:21:77: drive 'm' turns one of its joints and slides another, joint 'p'; give them drives of "
           "different names, because joints of one drive have one displacement"},
          {"\"S\", at = [\"c\", 0, \"h\"] }", "\"S\", at = [\"c\", 0, \"h\"], axis = \"z\" }",
           "m.toml:23:49: limb[0].joints[2].axis does not belong to type = \"S\"; remove it"},
          {"\"S\", at = [\"c\", 0, \"h\"] }", "\"S\", at = [\"c\", 0, \"h\"], actuated = true }",
           "m.toml:23:49: limb[0].joints[2].actuated does not belong to type = \"S\"; remove it"},
          {"joints = [", "joints = []\nx = [",
           "m.toml:21:1: unknown key 'x' in [limb[0]]; known: name, from, to, copies, points, joints, links, features, "
           "clearances, "
           "compliance"},
          {"frames = \"all\"", "frames = \"none\"",
           "m.toml:27:10: errors.frames is 'none'; write \"all\", or a list of names and patterns"},
          {"frames = \"all\"", "frames = [\"epsilon_1_0_x\", \"epsilon_1_9_x\"]",
           "m.toml:27:28: errors.frames[1] 'epsilon_1_9_x' fits no error; did you mean 'epsilon_1_0_x'?"},
          {"frames = \"all\"", "frames = [\"epsilon_1_0_*\", \"epsilon_?_0_x\"]",
           "m.toml:27:28: errors.frames[1] 'epsilon_?_0_x' names epsilon_1_0_x a second time; remove it, or write a "
           "narrower pattern"},
          {"frames = \"all\"", "frame = \"all\"",
           "m.toml:27:1: unknown key 'frame' in [errors]; did you mean 'frames'?"},
          {"frames = \"all\"", "frames = \"all\"\n[sets]\nall = [\"*\"]",
           "m.toml:29:7: sets.all exists in any case; remove it"},
          {"frames = \"all\"", "frames = \"all\"\n[sets]\nfew = []",
           "m.toml:29:7: sets.few is empty; name its errors, or remove it"},
          {"frames = \"all\"", "frames = \"all\"\n[sets]\nfew = [\"gamma_*\"]",
           "m.toml:29:8: sets.few[0] 'gamma_*' fits no error; they have names like epsilon_1_0_x"},
          {"frames = \"all\"", "frames = \"all\"\n[sets]\n\"a b\" = [\"*\"]",
           "m.toml:29:9: sets.a b 'a b' is not a name; write letters, digits, _ and -, and do not begin with -"},
          {"frames = \"all\"", "frames = \"all\"\n[sets]\n" + std::string(49, 's') + " = [\"*\"]",
           "m.toml:29:53: sets." + std::string(49, 's') + " '" + std::string(49, 's') +
               "' is too long; write at most 48 letters"},
          {"frames = \"all\"", "frames = \"all\"\n[sets",
           "m.toml:28:6: this is not TOML: parsing table header: expected ']', saw '\\n'; correct this "
           "line; names of parameters and expressions stand in quotes"},
          {"[\"rx\", \"ry\", \"z\"]\nworkspace   = { ",
           "[\"rx\", \"ry\", \"z\", \"x\"]\nworkspace   = { x = [0, \"1 mm\"], ",
           "m.toml:14:15: platform.coordinates are not independent: x follows from the others, and the platform has 3 "
           "freedoms; remove it, take another, or correct the axes of the joints"},
          {"[\"rx\", \"ry\", \"z\"]\nworkspace   = { rx",
           "[\"ry\", \"z\"]\nworkspace   = { z = [\"500 mm\", \"700 mm\"], ry = [0, \"9 deg\"] } # ",
           "m.toml:14:15: platform.coordinates has 2, but the platform has 3 freedoms; name as many as it has "
           "freedoms"},
          {"[\"rx\", \"ry\", \"z\"]\nworkspace   = { rx",
           "[\"rx\", \"ry\", \"rz\"]\nworkspace   = { rz = [0, \"1 deg\"], rx = [0, \"1 deg\"], ry = [0, \"9 deg\"] } "
           "# ",
           "m.toml:14:15: platform.coordinates are not independent: rz follows from the others, and the platform has 3 "
           "freedoms; remove it, take another, or correct the axes of the joints"},
      });
}

/// Several motions of the platform are possible, so the axis in the message may differ between computers.
TEST(MechanismFile, RefusesDrivesThatDoNotHoldThePlatform) {
  const auto expect = [](const Wrong& wrong) {
    const std::string problem = problem_of(replaced(text_of("rps3"), wrong));
    EXPECT_TRUE(problem.starts_with(wrong.message)) << problem;
    EXPECT_TRUE(problem.ends_with("; write actuated = true at one more joint, or correct the axes")) << problem;
  };
  expect({", actuated = true }", " }",
          "m.toml:23:3: the drives do not hold the platform, which has 3 freedoms and 0 drives: joint 'S' of limb 1 is "
          "loose, "});
  expect({"\"S\", at = [\"c\", 0, \"h\"] }", "\"S\", at = [0, 0, \"h\"] }",
          "m.toml:23:3: the drives do not hold the platform, which has 4 freedoms and 3 drives: joint 'S' of limb 3 is "
          "loose, "});
}

TEST(MechanismFile, RefusesWhatIsWrongInOthers) {
  expect_refused(
      "rrr3",
      {
          {"{ phi = \"rz\" }", "{ phi = \"rw\" }",
           "m.toml:13:34: platform.coordinates[2].phi is 'rw', which is unknown; did you mean 'rx'?"},
          {"at = \"elbow\"", "at = \"ellbow\"",
           "m.toml:23:34: limb[0].joints[1].at 'ellbow' is neither a joint of this limb nor a point; did you mean "
           "'elbow'?"},
          {"name = \"B\"", "name = \"elbow\"",
           "m.toml:23:3: limb[0].joints[1] 'elbow' takes its point from itself; a point has the name of the joint: "
           "rename one of them"},
          {"elbow = [\"220 mm\"", "C = [\"220 mm\"",
           "m.toml:23:34: limb[0].joints[1].at 'elbow' is neither a joint of this limb nor a point; known: A, B, C, C"},
          {"elbow = [\"220 mm\"", "elbow = [\"220 deg\"",
           "m.toml:17:10: points.elbow[0] '220 deg' is an angle, but must be a length; correct the expression or its "
           "unit"},
          {"name = \"l\"", "name = \"l l\"",
           "m.toml:27:8: error[0].name 'l l' is not a name; write letters, digits, _ and -, and do not begin with -"},
          {"name = \"l\"", "name = \"-l\"",
           "m.toml:27:8: error[0].name '-l' is not a name; write letters, digits, _ and -, and do not begin with -"},
          {"name = \"l\"", "nmae = \"l\"", "m.toml:27:1: unknown key 'nmae' in [error[0]]; did you mean 'name'?"},
          {"limb = \"each\"", "limb = \"all\"",
           "m.toml:28:8: error[0].limb is 'all', which no limb is named; write a limb's number, its name, a list of "
           "these, "
           "or \"each\""},
          {"limb = \"each\"", "limb = []",
           "m.toml:28:8: error[0].limb is empty; write the limbs' numbers, e.g. [1, 2, 3]"},
          {"limb = \"each\"", "limb = [1, 4]", "m.toml:28:12: error[0].limb[1] is 4; it must be at most 3"},
          {"limb = \"each\"", "limb = [2, 1, 2]",
           "m.toml:28:15: error[0].limb[2] names limb 2 a second time; remove it"},
          {"limb = \"each\"", "limb = [2, \"each\"]",
           "m.toml:28:12: error[0].limb[1] is 'each', which no limb is named; write a limb's number, its name, a list "
           "of "
           "these, or \"each\""},
          {"[[limb]]", "[[limb]]\nname = \"each\"",
           "m.toml:20:8: limb[0].name is 'each', which means all limbs; give the limb another name"},
          {"[[limb]]", "[[limb]]\nname = \"a b\"",
           "m.toml:20:8: limb[0].name 'a b' is not a name; write letters, digits, _ and -, and do not begin with -"},
          {"limb = \"each\"", "limb = 4", "m.toml:28:8: error[0].limb is 4; it must be at most 3"},
          {"limb = \"each\"", "limb = 0", "m.toml:28:8: error[0].limb is 0; it must be at least 1"},
          {"frame = 1", "frame = 4", "m.toml:29:9: error[0].frame is 4; the last frame of limb 1 is 3"},
          {"frame = 1", "frame = -1", "m.toml:29:9: error[0].frame is -1; it must be at least 0"},
          {"frame = 1", "", "m.toml:26:1: key 'frame' is missing in [error[0]]; write frame = 0"},
          {"component = \"delta_x\"", "component = \"delta_w\"",
           "m.toml:30:13: error[0].component is 'delta_w', which is unknown; did you mean 'delta_x'?"},
          {"component = \"delta_x\"", "component = []",
           "m.toml:30:13: error[0].component is empty; write \"delta_z\", for instance"},
          {"[\"delta_x\", \"delta_y\"]", "[\"delta_x\", \"epsilon_y\"]",
           "m.toml:37:25: error[1].component[1] mixes lengths and angles in one vector; write two [[error]]"},
          {"[\"delta_x\", \"delta_y\"]", "[\"delta_x\", \"delta_x\"]",
           "m.toml:37:25: error[1].component[1] is a component a second time; remove it"},
          {"name = \"pin\"", "name = \"l\"",
           "m.toml:48:13: sets.all-pins[0] 'pin_?_1' fits no error; they have names like l_1"},
          {"scale = 0.5", "scale = 0",
           "m.toml:44:9: error[2].scale is zero, so the error has no effect; write its scale"},
          {"scale = 0.5", "scale = \"2 mm\"",
           "m.toml:44:9: error[2].scale '2 mm' is a length, but must be a number; correct the expression or its unit"},
          {"name = \"encoder\"", "name = \"l_2\"",
           "m.toml:40:8: error[2].name 'l_2' makes a second error 'l_2'; give it a name of its own"},
          {"[\"l_*\"]", "[\"m_*\"]", "m.toml:47:12: sets.lengths[0] 'm_*' fits no error; they have names like l_1"},
          {"[[error]]", "[error]",
           "m.toml:33:1: this is not TOML: parsing table header: cannot redefine existing table 'error' as "
           "array-of-tables; correct this line; names of parameters and expressions stand in quotes"},
          {"actuated = true", "actuated = false",
           "m.toml:24:3: the drives do not hold the platform, which has 3 freedoms and 0 drives: joint 'C' of limb 1 "
           "is loose, and the platform turns about (0, 0, 1); write actuated = true at one more joint, or correct the "
           "axes"},
      });
}

}  // namespace
}  // namespace poesy::file
