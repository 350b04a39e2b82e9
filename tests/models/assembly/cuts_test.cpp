#include <gtest/gtest.h>

#include "tests/models/assembly/made.h"

// Tests that a mechanism stays the same if a limb is written from its other end, or if a body cuts a limb in two.
namespace poesy::assembly {
namespace {

/// The answers without those whose names begin with one of these prefixes.
Answers without(const Answers& all, std::initializer_list<const char*> prefixes) {
  Answers kept{{}, {}, all.reach};
  for (std::size_t r = 0; r < all.values.size(); ++r) {
    const auto begins = [&](const char* prefix) { return all.responses[r].name.starts_with(prefix); };
    if (std::ranges::any_of(prefixes, begins)) continue;
    kept.responses.push_back(all.responses[r]);
    kept.values.push_back(all.values[r]);
  }
  return kept;
}

// ---- a limb from its other end

/// The text of delta-parallelogram with errors of the right rods. turned: whether the right rods are written from head
/// to foot.
std::string parallelograms(bool turned) {
  std::string text = file::text_of("delta-parallelogram");
  const auto put = [&](const std::string& from, const std::string& until, const std::string& to) {
    const std::size_t begin = text.find(from);
    const std::size_t end = until.empty() ? begin + from.size() : text.find(until, begin + 1);
    ASSERT_NE(begin, std::string::npos);
    ASSERT_NE(end, std::string::npos);
    text.replace(begin, end - begin, to);
  };
  put("frames = \"all\"", "", "");
  if (turned) {
    put("[[limb]]\nname   = \"right\"", "[[limb]]\nname   = \"wrist\"", R"([[limb]]
name   = "right"
copies = { count = 3, about = "z" }
from   = "head"
to     = "foot"
joints = [
  { name = "C", type = "R", at = ["r", "-w", "e"], axis = ["h", 0, "r - R"] },
  { name = "B", type = "R", at = ["R", "-w", "e + h"], axis = ["h", 0, "r - R"], reaction = true } ]
links  = [
  { from = "C", to = "B", E = "70 GPa", G = "26 GPa", A = "120 mm^2", Iy = "3600 mm^4", Iz = "1000 mm^4", J = "2200 mm^4", y = ["h", 0, "r - R"] },
  { from = "B", to = "foot", E = "70 GPa", G = "26 GPa", diameter = "20 mm" } ]

)");
  }
  const std::string first = turned ? "2" : "0";
  const std::string middle = turned ? "\"C\"" : "\"B\"";
  const std::string last = turned ? "0" : "2";
  const auto error = [&](const std::string& name, const std::string& limb, const std::string& frame,
                         const std::string& components) {
    text += "\n[[error]]\nname = \"" + name + "\"\nlimb = \"" + limb + "\"\nframe = " + frame +
            "\ncomponent = " + components + "\n";
  };
  const std::string deltas = R"(["delta_x", "delta_y", "delta_z"])";
  const std::string epsilons = R"(["epsilon_x", "epsilon_y", "epsilon_z"])";
  error("hole", "right", first, deltas);
  error("bore", "right", first, epsilons);
  error("length", "right", middle, R"("delta_x")");
  error("eye", "right", last, deltas);
  error("pin", "right", last, epsilons);
  error("rod", "left", "\"B\"", deltas);
  error("rail", "slide", "0", epsilons);
  return text;
}

TEST(AssemblyCuts, ALimbTurnedRoundIsTheSame) {
  for (const Metric metric : kMetrics) {
    const AssemblyModel one = made(parallelograms(false), metric);
    const AssemblyModel other = made(parallelograms(true), metric);
    const std::vector<double> pose{-0.03, 0.04, 0.16};
    const std::vector<double> errors = random_errors(one, 0.1, 11);
    const Answers wanted = answers(one, pose, errors, kFirstOrder);
    // The moment is then about the other end, and the joint's frame differs.
    const Answers found = without(answers(other, pose, errors, kFirstOrder), {"moment_right", "reaction_B_right"});
    EXPECT_GE(expect_same(found, wanted, 1e-13), 50u);
    if (metric == Metric::platform) continue;
    for (const std::string name : {"reaction_B_right_1_f", "reaction_B_right_2_m"}) {
      const Answers turned = answers(other, pose, errors, kFirstOrder);
      const auto size = [&](const Answers& all) {
        return std::hypot(all[name + "x"], all[name + "y"], all[name + "z"]);
      };
      EXPECT_NEAR(size(turned), size(wanted), 1e-11 * size(wanted)) << name;
    }
  }
}

// ---- a body inserted

/// Where a body cuts the first leg of the table in two.
enum class Cut { none, before_screw, behind_screw };

/// The text of a table on four screws. screw, ball: TOML with the stiffness of the first leg's joints.
std::string table(Cut cut, const std::string& screw, const std::string& ball) {
  const std::string to_nut = cut == Cut::behind_screw ? "to = \"nut\"\n" : "";
  const std::string from_foot = cut == Cut::before_screw ? "from = \"foot\"\n" : "";
  const std::string end_of_screw =
      cut == Cut::behind_screw ? " ]\n\n[[limb]]\nname = \"upper\"\nfrom = \"nut\"\njoints = [" : ",";
  const std::string post =
      cut == Cut::behind_screw ? "limb = \"upper\"\nframe = 0" : "limb = \"leg\"\nframe = \"screw\"";
  const std::string seat = cut == Cut::behind_screw ? "limb = \"upper\"\nframe = 3" : "limb = \"leg\"\nframe = 4";
  const std::string foot = cut == Cut::before_screw ? "limb = \"mount\"\nframe = 0" : "limb = \"leg\"\nframe = 0";
  std::string text = R"(format = "poesy-mechanism"
version = 1
name = "table"

[geometry]
a = "400 mm"
b = "250 mm"
h = "600 mm"

[platform]
origin = [0, 0, "h"]
rotation = "xyz"
coordinates = ["z", "rx", "ry"]
workspace = { z = ["500 mm", "700 mm"], rx = ["-6 deg", "6 deg"], ry = ["-6 deg", "6 deg"] }
tool = [0, 0, "120 mm"]
mass = "85 kg"
centre = ["40 mm", "-20 mm", "30 mm"]

[load]
gravity = [0, 0, "-9.81 m/s^2"]
force = ["30 N", "-20 N", 0]

[errors]
about = "frame"
)";
  if (cut == Cut::before_screw) {
    text += R"(
[[body]]
name = "foot"
at = ["a", "b", 0]

[[limb]]
name = "mount"
to = "foot"
joints = [ { name = "O", type = "fixed", at = ["a", "b", 0], axis = "z", x = "x" } ]
)";
  }
  if (cut == Cut::behind_screw) text += "\n[[body]]\nname = \"nut\"\nat = [\"a\", \"b\", 0]\n";
  text += "\n[[limb]]\nname = \"leg\"\n" + from_foot + to_nut +
          "joints = [ { name = \"screw\", type = \"P\", at = [\"a\", \"b\", 0], axis = \"z\", actuated = true" + screw +
          " }" + end_of_screw + " { name = \"ball\", type = \"S\", at = [\"a\", \"b\", \"h\"]" + ball + " } ]\n";
  text += R"(
[[limb]]
name = "second"
joints = [
  { name = "screw", type = "P", at = ["-a", "b", 0], axis = "z", actuated = true, stiffness = { z = "90 N/um" } },
  { name = "ball", type = "S", at = ["-a", "b", "h"] },
  { name = "along", type = "P", at = ["-a", "b", "h"], axis = "x" } ]

[[limb]]
name = "third"
joints = [
  { name = "screw", type = "P", at = ["-a", "-b", 0], axis = "z", actuated = true, stiffness = { z = "80 N/um" } },
  { name = "ball", type = "S", at = ["-a", "-b", "h"] },
  { name = "along", type = "P", at = ["-a", "-b", "h"], axis = "x" },
  { name = "across", type = "P", at = ["-a", "-b", "h"], axis = "y" } ]

[[limb]]
name = "fourth"
joints = [
  { name = "screw", type = "P", at = ["a", "-b", 0], axis = "z", actuated = true, stiffness = { z = "70 N/um" } },
  { name = "ball", type = "S", at = ["a", "-b", "h"] },
  { name = "along", type = "P", at = ["a", "-b", "h"], axis = "x" },
  { name = "across", type = "P", at = ["a", "-b", "h"], axis = "y" } ]
)";
  const auto error = [&](const std::string& name, const std::string& where) {
    for (const std::string kind : {"delta", "epsilon"}) {
      text += "\n[[error]]\nname = \"" + name + "_" + kind + "\"\n" + where + "\ncomponent = [\"" + kind + "_x\", \"" +
              kind + "_y\", \"" + kind + "_z\"]\n";
    }
  };
  error("foot", foot);
  error("post", post);
  error("seat", seat);
  error("other", "limb = \"second\"\nframe = \"screw\"");
  return text;
}

const std::string kScrew =
    R"(, stiffness = { x = "40 N/um", y = "30 N/um", z = "90 N/um", rx = "9000 N m/rad", ry = "8000 N m/rad", rz = "7000 N m/rad" })";
const std::string kBall = R"(, stiffness = { x = "25 N/um", y = "25 N/um", z = "25 N/um" })";

/// The answers that must not change: all except the moment of the cut leg, which is about another point, and the
/// mismatch, which is divided between both parts of the leg and so has another mean square over the loops.
Answers comparable(const Answers& all) {
  return without(all, {"moment_leg", "gap", "angular_deformation", "linear_deformation"});
}

void expect_cut_same(Cut cut, const std::string& screw, const std::string& ball, Metric metric,
                     chain::Fidelity fidelity, double tolerance) {
  SCOPED_TRACE((cut == Cut::before_screw ? "before" : "behind") + screw + ball +
               (metric == Metric::stiffness ? ", stiffness" : ", platform"));
  const AssemblyModel whole = made(table(Cut::none, screw, ball), metric);
  const AssemblyModel in_two = made(table(cut, screw, ball), metric);
  const std::vector<double> pose{0.56, 0.03, -0.05};
  const std::vector<double> errors = random_errors(whole, 0.1, 12);
  const Answers wanted = answers(whole, pose, errors, fidelity);
  EXPECT_GE(expect_same(comparable(answers(in_two, pose, errors, fidelity)), wanted, tolerance), 12u);
}

TEST(AssemblyCuts, ABodyInALimbIsNothingToFirstOrder) {
  for (const Metric metric : kMetrics) {
    expect_cut_same(Cut::behind_screw, kScrew, "", metric, kFirstOrder, 1e-13);     // compliance before the cut
    expect_cut_same(Cut::behind_screw, "", kBall, metric, kFirstOrder, 1e-13);      // behind the cut
    expect_cut_same(Cut::behind_screw, kScrew, kBall, metric, kFirstOrder, 1e-13);  // on both sides
    expect_cut_same(Cut::before_screw, kScrew, kBall, metric, kFirstOrder, 1e-13);
  }
}

TEST(AssemblyCuts, ARigidPartBeforeALimbIsNothingAtAll) {
  expect_cut_same(Cut::behind_screw, "", kBall, Metric::stiffness, kExact, 1e-11);
  expect_cut_same(Cut::before_screw, kScrew, kBall, Metric::stiffness, kExact, 1e-11);
}

TEST(AssemblyCuts, ACarriageOnItsRailIsInNoLoop) {
  const std::string text = table(Cut::none, kScrew, kBall);
  const std::string more = text + R"(
[[body]]
name = "tray"
at = ["900 mm", 0, "300 mm"]
mass = "2 kg"

[[limb]]
name = "rail"
to = "tray"
joints = [ { name = "slide", type = "P", at = ["900 mm", 0, 0], axis = "z", actuated = true } ]
)";
  for (const Metric metric : kMetrics) {
    for (const chain::Fidelity fidelity : {kExact, kFirstOrder}) {
      const AssemblyModel plain = made(text, metric);
      const AssemblyModel with = made(more, metric);
      const std::vector<double> pose{0.56, 0.03, -0.05};
      const std::vector<double> errors = random_errors(plain, 0.1, 13);
      const Answers wanted = answers(plain, pose, errors, fidelity);
      EXPECT_EQ(expect_same(answers(with, pose, errors, fidelity), wanted, fidelity == kExact ? 1e-11 : 1e-13),
                wanted.values.size());
    }
  }
}

}  // namespace
}  // namespace poesy::assembly
