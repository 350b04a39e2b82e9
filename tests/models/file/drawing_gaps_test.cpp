#include "models/file/drawing_gaps.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "models/file/model.h"
#include "tests/models/file/files.h"
#include "tests/models/file/wrong.h"

namespace poesy::file {
namespace {

using Clauses = std::vector<std::string>;

constexpr const char* kName = "linear-delta-drawing";

Mechanism read(const std::string& text) {
  const MechanismFile file = read_mechanism_file(text, "m.toml");
  return mechanism(file, default_geometry(file));
}

/// The text of the Delta's file without this feature.
std::string without(const std::string& feature) {
  std::string text = text_of(kName);
  const std::size_t begin = text.find("  { name = \"" + feature + "\"");
  EXPECT_NE(begin, std::string::npos) << feature;
  return text.erase(begin, text.find('\n', begin) + 1 - begin);
}

const Clauses& uncovered() {
  static const Clauses list{
      "limbs 1 to 3, between the base and O (frame 0): displacement along x, y and z and turn about z have no "
      "tolerance",
      // The zero of the drive, on the other side of the slide, is a tolerance along z.
      "limbs 1 to 3, between O and q (frame 1): turn about z has no tolerance",
      "limbs 1 to 3, between q and B (frame 2): displacement along y has no tolerance",
      "limbs 1 to 3, the cross of C (frame 5): displacement along y has no tolerance",
      "limb 1, between C and the platform (frame 6): displacement along y has no tolerance",
      "limb 2, between C and the platform (frame 6): displacement along (0.866025, 0.5, 0) has no tolerance",
      "limb 3, between C and the platform (frame 6): displacement along (0.866025, -0.5, 0) has no tolerance"};
  return list;
}

TEST(DrawingGaps, AreTheDirectionsThatNoFeatureOfThePartCovers) {
  EXPECT_EQ(uncovered_directions(from_file(kName)), uncovered());
}

TEST(DrawingGaps, GrowByWhatAFeatureSaid) {
  Clauses more = uncovered();
  more.insert(more.begin() + 3, "limbs 1 to 3, between B and C (frame 4): displacement along x has no tolerance");
  EXPECT_EQ(uncovered_directions(read(without("rod"))), more);
  EXPECT_EQ(uncovered_directions(read(without("zero"))), uncovered());  // the hinge's position covers it too
  more = uncovered();
  more[2] =
      "limbs 1 to 3, between q and B (frame 2): displacement along x and y and turn about x and z have no tolerance";
  EXPECT_EQ(uncovered_directions(read(without("hinge_b"))), more);
}

/// A leg's length error that is stated across the leg changes no length to first order.
TEST(DrawingGaps, AnErrorWithoutEffectIsAskedAbout) {
  const std::string legs = replaced(text_of("ups6"), {"frames = \"all\"", ""});
  const auto found = [&](const std::string& errors) { return errors_without_effect(read(legs + errors)); };
  const auto error = [](const std::string& name, const std::string& limb, const std::string& component) {
    return "\n[[error]]\nname = \"" + name + "\"\nlimb = " + limb + "\nframe = \"L\"\ncomponent = \"" + component +
           "\"\n";
  };
  EXPECT_EQ(errors_without_effect(from_file("ups6")), Clauses{});  // all errors of frames, none with a name
  EXPECT_EQ(found(error("leg", "[1, 2]", "delta_z")), Clauses{});
  EXPECT_EQ(found(error("leg", "2", "delta_x")),
            Clauses{"leg has no effect to first order, and its part has no other error"});
  EXPECT_EQ(found(error("leg", "[1, 2]", "delta_x")),
            Clauses{"leg_1 and leg_2 have no effect to first order, and their parts have no other error"});
  EXPECT_EQ(found(error("leg", "2", "delta_x") + error("along", "2", "delta_z")), Clauses{});
}

/// A hexapod with arms: its rods have balls at both ends, behind which no axis lies along the rod.
constexpr const char* kServoHexapod = R"(
format = "poesy-mechanism"
version = 1
name = "servo"
[platform]
origin = [0, 0, "200 mm"]
coordinates = ["x", "y", "z", "rx", "ry", "rz"]
workspace = { x = ["-20 mm", "20 mm"], y = ["-20 mm", "20 mm"], z = ["185 mm", "215 mm"], rx = ["-5 deg", "5 deg"], ry = ["-5 deg", "5 deg"], rz = ["-5 deg", "5 deg"] }
[[limb]]
name = "left"
copies = { count = 3, about = "z" }
joints = [
  { name = "q", type = "R", at = ["130 mm", "20 mm", 0], axis = "x", actuated = true },
  { name = "B", type = "S", at = ["130 mm", "80 mm", 0] },
  { name = "C", type = "S", at = ["70 mm", "70 mm", "200 mm"] } ]
[[limb]]
name = "right"
copies = { count = 3, about = "z" }
joints = [
  { name = "q", type = "R", at = ["130 mm", "-20 mm", 0], axis = "x", actuated = true },
  { name = "B", type = "S", at = ["130 mm", "-80 mm", 0] },
  { name = "C", type = "S", at = ["70 mm", "-70 mm", "200 mm"] } ]
)";

TEST(DrawingGaps, AnErrorObliqueToARodIsAskedAbout) {
  const auto found = [](const std::string& frame, const std::string& component) {
    return oblique_displacements(read(std::string(kServoHexapod) + "\n[[error]]\nname = \"rod\"\nlimb = [1]\nframe = " +
                                      frame + "\ncomponent = " + component + "\n"));
  };
  // the rod runs along (-60, -10, 200), x behind B along (-60, -10, 0): atan(200 / 60.8) = 73 deg
  const Clauses oblique = found("\"B\"", "\"delta_x\"");
  ASSERT_EQ(oblique.size(), 1U);
  EXPECT_TRUE(oblique[0].starts_with("rod_1 displaces 73 deg off (")) << oblique[0];
  EXPECT_TRUE(
      oblique[0].ends_with(", the only direction of frame 4 in which a displacement between B and C has an effect "
                           "to first order (a feature of kind distance states the length of a rod)"))
      << oblique[0];
  EXPECT_EQ(found("5", "\"delta_z\""), Clauses{});                                  // along the rod
  EXPECT_EQ(found("5", "\"delta_x\""), Clauses{});                                  // across the rod
  EXPECT_EQ(found("\"B\"", "[\"delta_x\", \"delta_y\", \"delta_z\"]"), Clauses{});  // all directions
  EXPECT_EQ(found("\"q\"", "\"delta_x\""), Clauses{});  // an arm, which acts in many directions
}

/// The direction of a rod is asked about even if other errors displace its part in all directions.
TEST(DrawingGaps, ADistanceObliqueToARodIsAskedAbout) {
  const auto found = [](const std::string& direction) {
    const std::string ball = R"({ name = "C", type = "S", at = ["70 mm", "70 mm", "200 mm"] } ])";
    const std::string rod =
        "\nfeatures = [ { name = \"rod\", joint = \"C\", kind = \"distance\", direction = " + direction +
        ", tolerance = \"0.02 mm\" } ]";
    return oblique_displacements(read(replaced(kServoHexapod, {ball, ball + rod}) +
                                      "\n[[error]]\nname = \"seat\"\nlimb = [1]\nframe = \"B\"\n"
                                      "component = [\"delta_x\", \"delta_y\", \"delta_z\"]\n"));
  };
  EXPECT_EQ(found("[-60, -10, 200]"), Clauses{});  // from B to C
  for (const auto& [direction, told] : {std::pair("[-60, 10, 200]", "rod_1, rod_2 and rod_3 displace 5 deg off ("),
                                        {"\"x\"", "rod_1, rod_2 and rod_3 displace 73 deg off ("}}) {
    const Clauses oblique = found(direction);
    ASSERT_EQ(oblique.size(), 1U) << direction;
    EXPECT_TRUE(oblique[0].starts_with(told)) << oblique[0];
    EXPECT_TRUE(oblique[0].ends_with("(the direction of a rod leads from one of its joints to the other)"))
        << oblique[0];
  }
}

TEST(DrawingGaps, ASizeFarFromTheLengthOfItsPartIsDoubtful) {
  const auto doubts = [](const std::string& size) {
    return doubtful_zones(read(replaced(
        text_of(kName), {"tolerance = \"0.02 mm\" },\n  { name = \"rod_bore\"",
                         "nominal_size = \"" + size + "\", tolerance = \"0.02 mm\" },\n  { name = \"rod_bore\""})));
  };
  const Clauses before = doubtful_zones(from_file(kName));
  for (const std::string size : {"340 mm", "171 mm", "679 mm"}) EXPECT_EQ(doubts(size), before) << size;
  for (const std::string size : {"34 mm", "169 mm", "681 mm"}) {
    const Clauses found = doubts(size);
    const std::string told = "rod has nominal_size = " + size + ", but its part is 340 mm long in this direction";
    EXPECT_NE(std::ranges::find(found, told), found.end()) << size;
  }
}

/// Lengths in another unit, or with a zero too many: of a rail, of a bore, and of a zone.
TEST(DrawingGaps, AFeatureOutOfProportionIsDoubtful) {
  const auto told = [](const std::string& written, const std::string& instead, const std::string& words) {
    const Clauses found = doubtful_zones(read(replaced(text_of(kName), {written, instead})));
    return std::ranges::any_of(found, [&](const std::string& one) { return one.find(words) != std::string::npos; });
  };
  EXPECT_TRUE(told("length = \"500 mm\"", "length = \"5 m\"",
                   "rail is along a slide and 5000 mm long, in a mechanism with a reach of"));
  EXPECT_TRUE(told("length = \"500 mm\"", "length = \"0.5 mm\"", "rail is along a slide and 0.5 mm long, in a"));
  const std::string cross = "name = \"cross_b\", joint = \"B\", axis = 2, kind = \"axis\", length = \"";
  EXPECT_TRUE(told(cross + "30 mm", cross + "3000 mm", "cross_b is 3000 mm long, in a mechanism"));
  EXPECT_TRUE(
      told("position = { zone = \"0.05 mm\"", "position = { zone = \"0.05 m\"", "is 50 mm for a mechanism with"));
  EXPECT_FALSE(told(cross + "30 mm", cross + "60 mm", "long, in"));
  const std::string hinge = "name = \"hinge_b\", joint = \"B\", kind = \"axis\", length = \"";
  EXPECT_FALSE(told(hinge + "40 mm", hinge + "2 mm", "long, in")) << "a bore of the carriage across the slide";
  EXPECT_TRUE(told(hinge + "40 mm", hinge + "1400 mm", "hinge_b is 1400 mm long, in a mechanism"));
}

/// A feature without a zone counts as a gap. An error that the file states closes the gap.
TEST(DrawingGaps, AreWithoutZonesAndStatedErrors) {
  const std::string rod = "direction = [\"r - R\", 0, \"-h\"], tolerance = \"0.02 mm\"";
  const std::string text = replaced(text_of(kName), {rod, "direction = [\"r - R\", 0, \"-h\"]"});
  EXPECT_EQ(uncovered_directions(read(text)), uncovered_directions(read(without("rod"))));
  const std::string stated = "\n[[error]]\nlimb = \"each\"\nname = \"width\"\nframe = 2\ncomponent = \"delta_y\"\n";
  Clauses fewer = uncovered();
  fewer.erase(fewer.begin() + 2);
  EXPECT_EQ(uncovered_directions(read(text_of(kName) + stated)), fewer);
}

/// The pins of the planar 3-RRR, which is over-constrained, and those of a Delta, which is not.
TEST(DrawingGaps, AClearanceMayAddToAGap) {
  const std::string last = R"({ name = "C", type = "R", at = ["c", 0, 0], axis = "z" } ])";
  const std::string pin =
      "\nclearances = [ { name = \"play\", joint = \"C\", length = \"20 mm\", fit = \"10 H7/f7\" } ]";
  const Clauses found = doubtful_clearances(read(replaced(text_of("rrr3"), {last, last + pin})));
  ASSERT_EQ(found.size(), 1u);
  EXPECT_NE(found.front().find("play is drawn like other errors, so it adds to the gap"), std::string::npos);
  EXPECT_TRUE(doubtful_clearances(from_file("rrr3")).empty());
  EXPECT_TRUE(doubtful_clearances(from_file("designed-delta")).empty());
}

TEST(DrawingGaps, AreNotSaidWithoutADrawing) { EXPECT_TRUE(uncovered_directions(from_file("rrr3")).empty()); }

/// Checks the list with the model: the listed error components move the platform; components that no feature covers and
/// that are not listed have no effect.
TEST(DrawingGaps, ActInTheModel) {
  std::string text = text_of(kName);
  text.erase(text.find("features = ["));
  for (int frame = 0; frame <= 6; ++frame) {
    for (const char* component : {"delta_x", "delta_y", "delta_z", "epsilon_x", "epsilon_y", "epsilon_z"}) {
      text += "\n[[error]]\nlimb = 1\nname = \"" + std::string(component) + "_" + std::to_string(frame) +
              "\"\nframe = " + std::to_string(frame) + "\ncomponent = \"" + component + "\"\n";
    }
  }
  const CatalogEntry entry = catalog_entry(text, "m.toml");
  const std::unique_ptr<Model> model = build(entry, 1);
  const std::vector<Factor>& factors = entry.description.factors;
  const auto effect = [&](const std::string& name) {
    double largest = 0.0;
    const auto at = std::ranges::find(factors, name, &Factor::name);
    EXPECT_NE(at, factors.end()) << name;
    std::vector<double> values(factors.size(), 0.0);
    values[static_cast<std::size_t>(at - factors.begin())] = 1e-3;
    for (const std::vector<double>& pose :
         {std::vector<double>{0.0, 0.0, 0.2}, {0.06, -0.04, 0.18}, {-0.03, 0.07, 0.24}}) {
      std::vector<double> found(entry.description.responses.size());
      SolveStatus status{};
      std::uint32_t iterations = 0;
      SolverOptions options;
      options.tolerance = entry.description.tolerance;
      model->evaluator(options)->evaluate({pose, values, {}, {}, 1}, {found, {&status, 1}, {&iterations, 1}, {}});
      for (const double one : found) largest = std::max(largest, std::abs(one));
    }
    return largest;
  };
  for (const char* acts : {"delta_x_0", "delta_y_0", "delta_z_0", "epsilon_z_0", "delta_z_1", "epsilon_z_1",
                           "delta_y_2", "delta_y_5", "delta_y_6"}) {
    EXPECT_GT(effect(acts), 1e-5) << acts;
  }
  // Rotations about the passive axes after the part have no effect.
  for (const char* idle : {"epsilon_y_2", "epsilon_y_6"}) EXPECT_LT(effect(idle), 1e-12) << idle;
}

TEST(DrawingGaps, NameZonesThatSayLittle) {
  EXPECT_TRUE(doubtful_zones(from_file(kName)).empty());
  const std::string rail = "perpendicularity = { zone = \"0.02 mm\", datums = \"A\" }";
  EXPECT_EQ(doubtful_zones(read(replaced(text_of(kName), {rail, "perpendicularity = \"0.0355 mm\""}))),
            (Clauses{"perpendicularity of rail has no datums",
                     "perpendicularity of rail is 0.0355 mm, and its position allows no more than 0.03536 mm "
                     "anyway"}));
  EXPECT_EQ(build(catalog_entry(text_of(kName), "m.toml"))->unusual_errors(), uncovered());
}

}  // namespace
}  // namespace poesy::file
