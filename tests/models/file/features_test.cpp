#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <fstream>
#include <nlohmann/json.hpp>
#include <string>

#include "models/file/model.h"
#include "tests/models/file/files.h"
#include "tests/models/file/wrong.h"

// Compares the drawing of a linear Delta with tests/data/drawing.json, which another program computed.
namespace poesy::file {
namespace {

using nlohmann::json;

constexpr const char* kName = "linear-delta-drawing";

const std::string kHalfWidth =
    ", but the tolerance of a distance is one length, +- half the width of its zone; write half the width, e.g. "
    "\"0.035 mm\" for -0.02 mm and 0.05 mm, and in the study what is not symmetric: errors.override.ERROR = { "
    "distribution = \"normal\", limits = [\"-0.02 mm\", \"0.05 mm\"], sigmas = 3 }, or a mean";

const json& expected() {
  static const json all = json::parse(std::ifstream(POESY_TEST_DATA "/drawing.json"));
  return all["linear_delta"];
}

std::size_t position(const std::vector<Factor>& factors, const std::string& name) {
  return static_cast<std::size_t>(std::ranges::find(factors, name, &Factor::name) - factors.begin());
}

TEST(Features, HaveTheColumnsOfTheOracle) {
  const Mechanism mechanism = from_file(kName);
  for (const auto& [name, wanted] : expected()["errors"].items()) {
    const std::size_t f = position(mechanism.factors, name);
    ASSERT_LT(f, mechanism.factors.size()) << name;
    EXPECT_EQ(mechanism.factors[f].limb, wanted["limb"]) << name;
    EXPECT_EQ(mechanism.factors[f].frame, wanted["frame"]) << name;
    EXPECT_EQ(mechanism.factors[f].dimension, Dimension::length);
    std::array<double, 6> column{};
    for (const chain::ErrorTerm& term : mechanism.terms[f]) {
      EXPECT_EQ(term.limb + 1, wanted["limb"]);
      EXPECT_EQ(term.frame, wanted["frame"]);
      column[term.component] += term.scale;
    }
    for (std::size_t k = 0; k < 6; ++k) EXPECT_NEAR(column[k], wanted["column"][k].get<double>(), 2e-14) << name;
  }
}

TEST(Features, SayWhichErrorsTheirZonesLimit) {
  const Mechanism mechanism = from_file(kName);
  ASSERT_EQ(mechanism.features.size(), 27u);
  const Feature& rail = mechanism.features[10];
  EXPECT_EQ(rail.name, "rail_2");
  EXPECT_EQ(rail.label, "rail");
  EXPECT_EQ(rail.kind, FeatureKind::axis);
  EXPECT_EQ(rail.size[0], 0.5);
  EXPECT_EQ(rail.location->key, "position");
  EXPECT_EQ(rail.location->size, 5e-5);
  EXPECT_EQ(rail.location->datums, "A|B");
  EXPECT_EQ(rail.orientation->key, "perpendicularity");
  ASSERT_EQ(rail.middle.size(), 2u);
  EXPECT_EQ(mechanism.factors[rail.middle[1].value].name, "rail_y_2");
  EXPECT_EQ(mechanism.factors[rail.tilt[0].value].name, "rail_lean_x_2");
  EXPECT_TRUE(mechanism.features[0].middle.empty());  // with a parallelism alone, the face only tilts
  EXPECT_EQ(mechanism.features[0].tilt.size(), 2u);
  EXPECT_EQ(mechanism.factors.size(), 78u);
}

TEST(Features, SayWhetherADistanceMakesItsPartLonger) {
  const auto rod = [](const std::string& place, const std::string& direction) {
    const std::string text =
        replaced(text_of(kName), {R"(joint = "C", kind = "distance", direction = ["r - R", 0, "-h"])",
                                  place + R"(, kind = "distance", direction = )" + direction});
    const MechanismFile file = read_mechanism_file(text, "m.toml");
    const Mechanism made = mechanism(file, default_geometry(file));
    return made.factors[position(made.factors, "rod_1")].description;
  };
  const std::string towards_c = R"(["r - R", 0, "-h"])";
  const std::string towards_b = R"(["R - r", 0, "h"])";
  const std::string after_b = R"(joint = "B", axis = 2, part = "after")";
  const std::string longer = "is too long";
  const std::string shorter = "is off along its direction, which makes its part shorter";
  EXPECT_NE(rod(R"(joint = "C")", towards_c).find(longer), std::string::npos);
  EXPECT_NE(rod(R"(joint = "C")", towards_b).find(shorter), std::string::npos);
  EXPECT_NE(rod(after_b, towards_c).find(shorter), std::string::npos);
  EXPECT_NE(rod(after_b, towards_b).find(longer), std::string::npos);
  EXPECT_EQ(rod(R"(joint = "C")", R"([1, 0, "-1.5"])").find(longer), std::string::npos);  // oblique to the rod
  EXPECT_NE(rod(R"(joint = "B")", R"("-z")").find(shorter), std::string::npos);  // a carriage, towards the rail's foot
  EXPECT_NE(rod(R"(joint = "B")", R"("z")").find(longer), std::string::npos);
  const std::string on_platform = R"(joint = "C", axis = 2, part = "after")";
  EXPECT_NE(rod(on_platform, R"([-1, 0, 0])").find(shorter), std::string::npos);  // to the platform's origin
  EXPECT_NE(rod(on_platform, R"([1, 0, 0])").find(longer), std::string::npos);
}

TEST(Features, SayWhatADistanceOfALegWithASlideDoes) {
  const auto leg = [](const std::string& place, const std::string& direction) {
    const std::string text =
        replaced(text_of("ups6"), {R"("S", type = "S", at = ["92.1597 mm", "84.4488 mm", "h"] } ])",
                                   R"("S", type = "S", at = ["92.1597 mm", "84.4488 mm", "h"] } ]
features = [ { name = "rod", kind = "distance", tolerance = "0.02 mm", )" +
                                       place + ", direction = " + direction + " } ]"});
    const MechanismFile file = read_mechanism_file(text, "m.toml");
    const Mechanism made = mechanism(file, default_geometry(file));
    const std::string& description = made.factors[position(made.factors, "rod_1")].description;
    return description.substr(description.find(" is ") + 1);
  };
  const std::string to_platform = "[-213, -27, 800]";
  const std::string to_base = "[213, 27, -800]";
  const std::string off = "is off along its direction";
  EXPECT_EQ(leg(R"(joint = "S")", to_platform), "is too long");
  EXPECT_EQ(leg(R"(joint = "S")", to_base), off + ", which makes its part shorter");
  EXPECT_EQ(leg(R"(joint = "B", axis = 2, part = "after")", to_platform), off + ", which makes its part shorter");
  EXPECT_EQ(leg(R"(joint = "B", axis = 2, part = "after")", to_base), "is too long");
  EXPECT_EQ(leg(R"(joint = "S")", "[1, 0, 0]"), off);  // across the leg
  EXPECT_EQ(leg(R"(joint = "L")", to_platform), off);  // of the slide itself
}

TEST(Features, HaveTolerancesByExpressions) {
  const auto tolerance = [](const std::string& written) {
    const std::string text = replaced(text_of(kName), {"geometry = { ", "geometry = { t1 = \"0.01 mm\", "});
    return problem_of(replaced(text, {"tolerance = \"0.02 mm\"", "tolerance = \"" + written + "\""}));
  };
  for (const std::string written : {"0.5 * t1", "0.01 mm + t1", "2 * t1", "+1e-5 m", "+0.05 mm + 2 * t1"}) {
    EXPECT_EQ(tolerance(written), "read") << written;
  }
  for (const std::string written : {"905 js7", "905.5 IT7", "+0.05 mm -0.02 mm", "+1e-5 / -2e-5 m"}) {
    EXPECT_NE(tolerance(written).find(kHalfWidth), std::string::npos) << written;
  }
}

TEST(Features, AdviceOnAToleranceAmongErrorsIsOfKeysOfTheFile) {
  const std::string problem = problem_of(text_of(kName) + "\n[errors]\ntolerance = \"0.02 mm\"\n");
  EXPECT_NE(problem.find("unknown key 'tolerance' in [errors]; "), std::string::npos) << problem;
  EXPECT_NE(problem.find("frames"), std::string::npos) << problem;
  EXPECT_EQ(problem.find("linear"), std::string::npos) << problem;
}

TEST(Features, AreLooseByAClearance) {
  const auto with = [](const std::string& clearance) {
    return replaced(text_of(kName),
                    {"features = [", "clearances = [ { name = \"play\", joint = \"B\", length = \"40 mm\", " +
                                         clearance + " } ]\nfeatures = ["});
  };
  const auto read = [](const std::string& text) {
    const MechanismFile file = read_mechanism_file(text, "m.toml");
    return mechanism(file, default_geometry(file));
  };
  const Mechanism made = read(with("fit = \"8 H7/g6\""));
  ASSERT_EQ(made.factors.size(), 78u + 12u);
  const auto play = std::ranges::find(made.features, "play_2", &Feature::name);
  ASSERT_NE(play, made.features.end());
  EXPECT_NEAR(play->clearance->most, 29e-6, 1e-18);
  EXPECT_NEAR(std::sqrt(play->clearance->mean_square), 17.24818831066034e-6, 1e-16);
  // The errors of the clearance act like those of the hinge at the same joint.
  const std::size_t lean = position(made.factors, "play_lean_x_2");
  const std::size_t hinge = position(made.factors, "hinge_b_lean_x_2");
  ASSERT_EQ(made.terms[lean].size(), made.terms[hinge].size());
  EXPECT_EQ(made.terms[lean].front().scale, made.terms[hinge].front().scale);
  const Mechanism stated = read(with("least = \"5 um\", most = \"29 um\", contact = \"uniform\""));
  const auto other = std::ranges::find(stated.features, "play_2", &Feature::name);
  EXPECT_FALSE(other->clearance->touches);
  EXPECT_NEAR(other->clearance->mean_square, 17e-6 * 17e-6 + 4e-6 * 4e-6, 1e-20);
}

TEST(Features, RefuseAClearanceWithPlaceAndRemedy) {
  const auto refused = [](const std::string& clearance, const std::string& words) {
    const std::string text = "clearances = [ { name = \"play\", joint = \"B\", " + clearance + " } ]\nfeatures = [";
    const std::string problem = problem_of(replaced(text_of(kName), {"features = [", text}));
    EXPECT_NE(problem.find("m.toml:17:"), std::string::npos) << problem;
    EXPECT_NE(problem.find(words), std::string::npos) << problem;
    EXPECT_NE(problem.find("; "), std::string::npos) << problem;
  };
  refused("length = \"40 mm\"", "limb[0].clearances[0] has no fit");
  refused("length = \"40 mm\", least = \"5 um\"", "has no fit");
  refused("fit = \"8 H7/g6\"", "key 'length' is missing");
  refused("length = \"40 mm\", fit = \"8 H7/q6\"", "limb[0].clearances[0].fit");
  refused("length = \"40 mm\", fit = \"8 H7/g6\", most = \"5 um\"", "does not belong to a clearance with a fit");
  refused("length = \"40 mm\", least = \"9 um\", most = \"5 um\"", "is not between 0 and most");
  refused("length = \"40 mm\", least = \"-9 um\", most = \"5 um\"", "is not between 0 and most");
  refused("length = \"40 mm\", least = 0, most = 0", "is not greater than 0");
  refused("length = \"40 mm\", fit = \"8 H7/g6\", contact = \"loose\"", "is 'loose'");
  refused("length = \"0 mm\", fit = \"8 H7/g6\"", "is not greater than 0");
  refused("axis = 3, length = \"40 mm\", fit = \"8 H7/g6\"", "has 2 axes");
}

/// The model of a mechanism file, with its responses to named errors.
class Answer {
 public:
  Answer(const std::string& text, std::size_t fidelity)
      : entry_(catalog_entry(text, "file.toml")), model_(build(entry_, fidelity)) {}

  std::vector<double> responses(const std::vector<double>& pose, const json& errors) const {
    const ModelDescription& description = entry_.description;
    std::vector<double> values(description.factors.size(), 0.0);
    for (const auto& [name, value] : errors.items()) values[position(description.factors, name)] = value;
    std::vector<double> found(description.responses.size());
    SolveStatus status{};
    std::uint32_t iterations = 0;
    SolverOptions options;
    options.tolerance = description.tolerance;
    model_->evaluator(options)->evaluate({pose, values, {}, {}, 1}, {found, {&status, 1}, {&iterations, 1}, {}});
    EXPECT_TRUE(solved(status));
    return found;
  }

  const std::vector<Response>& described() const { return entry_.description.responses; }
  const Model& model() const { return *model_; }

 private:
  CatalogEntry entry_;
  std::unique_ptr<Model> model_;
};

TEST(Features, MoveThePlatformAsTheOracleSays) {
  const Answer exact(text_of(kName), 0);
  const Answer first_order(text_of(kName), 1);
  for (const json& at : expected()["poses"]) {
    const std::vector<double> pose = at["pose"];
    for (const json& one : at["cases"]) {
      const std::vector<double> found = exact.responses(pose, one["errors"]);
      const std::vector<double> linear = first_order.responses(pose, one["errors"]);
      std::size_t tip = 0;
      for (std::size_t r = 0; r < found.size(); ++r) {
        const std::string& name = exact.described()[r].name;
        EXPECT_NEAR(found[r], one["exact"][name].get<double>(), 1e-12) << name << " " << one["errors"];
        if (tip < 3 && name.starts_with("tip_")) {
          EXPECT_NEAR(linear[r], one["first_order_tip"][tip++].get<double>(), 1e-12) << name;
        }
      }
      EXPECT_EQ(tip, 3u);
    }
  }
}

/// The plain solver, which gives the trace, has the same responses as the kernels.
TEST(Features, AreTracedWithTheSameResponses) {
  const Answer exact(text_of(kName), 0);
  const std::vector<double> pose{0.08, -0.08, 0.15};
  std::vector<double> errors(78);
  for (std::size_t f = 0; f < errors.size(); ++f) errors[f] = 1e-4 * std::sin(1.0 + static_cast<double>(f));
  std::vector<double> found(exact.described().size());
  SolveStatus status{};
  std::uint32_t iterations = 0;
  exact.model()
      .evaluator(SolverOptions())
      ->evaluate({pose, errors, {}, {}, 1}, {found, {&status, 1}, {&iterations, 1}, {}});
  const auto trace = exact.model().trace(pose, errors, SolverOptions());
  for (std::size_t r = 0; r < found.size(); ++r) EXPECT_NEAR(trace->responses[r], found[r], 1e-14);
}

TEST(Features, AreRefusedWithPlaceAndRemedy) {
  expect_refused(
      kName,
      {
          {"kind = \"plane\", size", "kind = \"bore\", size",
           "m.toml:18:40: limb[0].features[0].kind is 'bore', which is unknown; known: axis, plane, point, distance"},
          {"kind = \"axis\", length = \"500 mm\", at", "kind = \"axis\", at",
           "m.toml:19:3: key 'length' is missing in [limb[0].features[1]]; write length = \"30 mm\""},
          {"joint = \"q\", kind", "joint = \"Q\", kind",
           "m.toml:19:28: limb[0].features[1].joint 'Q' is not a joint of this limb; did you mean 'q'?"},
          {"joint = \"q\", kind", "kind",
           "m.toml:19:3: key 'joint' is missing in [limb[0].features[1]]; write joint = \"A\""},
          {"joint = \"B\", axis = 2", "joint = \"B\", axis = 3",
           "m.toml:22:3: limb[0].features[4].axis is 3, but joint 'B' has 2 axes; write the number of one of its axes"},
          {"size = [\"60 mm\", \"40 mm\"]", "size = [\"60 mm\"]",
           "m.toml:18:56: limb[0].features[0].size has 1 values; write its sides along x and y, e.g. [\"60 mm\", \"40 "
           "mm\"]"},
          {"size = [\"60 mm\", \"40 mm\"], ", "",
           "m.toml:18:3: limb[0].features[0] 'face' has no size; write size = [\"60 mm\", \"40 mm\"] for a rectangle, "
           "or diameter = \"50 mm\""},
          {"size = [\"60 mm\", \"40 mm\"]", "size = [\"60 mm\", \"40 mm\"], diameter = \"50 mm\"",
           "m.toml:18:3: limb[0].features[0] 'face' has size and diameter; write size = [\"60 mm\", \"40 mm\"] for a "
           "rectangle, or diameter = \"50 mm\""},
          {"size = [\"60 mm\", \"40 mm\"]", "size = [\"60 mm\", \"0 mm\"]",
           "m.toml:18:66: limb[0].features[0].size[1] '0 mm' is not greater than 0; write a value greater than 0"},
          {"perpendicularity = { zone = \"0.02 mm\"", "coaxiality = { zone = \"0.02 mm\"",
           "m.toml:19:163: limb[0].features[1] 'rail' has position and coaxiality; keep the one that decides: a "
           "feature has one zone of location and one of orientation"},
          {"perpendicularity = { zone = \"0.02 mm\"", "straightness = { zone = \"0.02 mm\"",
           "m.toml:19:156: limb[0].features[1].straightness is the form of one surface, which rigid parts do not have; "
           "remove it, or give the location or the orientation of the feature"},
          {"position = { zone = \"0.05 mm\"", "position = { zone = \"0.05 mm (M)\"",
           "m.toml:19:103: limb[0].features[1].position has the modifier (M), which depends on the actual size, which "
           "is not modelled; remove it; the zone is then the smallest that it allows"},
          {"position = { zone = \"0.05 mm\"", "position = { zone = \"\u00d80.05 mm\"",
           "m.toml:19:112: limb[0].features[1].position.zone is '\u00d80.05 mm', with the sign \u00d8; write the "
           "number "
           "and its unit alone, e.g. \"0.05 mm\": around an axis or a point a zone is a diameter"},
          {"position = { zone = \"0.05 mm\"", "position = { zone = \"+-0.05 mm\"",
           "m.toml:19:112: limb[0].features[1].position.zone is '+-0.05 mm', with the sign +-; write the whole width "
           "of "
           "the zone, \"0.1 mm\" for +-0.05 mm"},
          {"direction = \"z\", tolerance = \"0.02 mm\"", "direction = \"z\", tolerance = \"\u00b10.02 mm\"",
           "m.toml:20:81: limb[0].features[2].tolerance is '\u00b10.02 mm', with the sign \u00b1; write the number and "
           "its unit alone: tolerance = \"0.02 mm\" of a distance is +-0.02 mm"},
          {"tolerance = \"0.02 mm\"", "tolerance = [\"-0.02 mm\", \"0.05 mm\"]",
           "m.toml:20:81: limb[0].features[2].tolerance is a list" + kHalfWidth},
          {"tolerance = \"0.02 mm\"", "tolerance = \"+0.05 -0.02 mm\"",
           "m.toml:20:81: limb[0].features[2].tolerance is '+0.05 -0.02 mm'" + kHalfWidth},
          {"tolerance = \"0.02 mm\"", "tolerance = \"0 / -0.05 mm\"",
           "m.toml:20:81: limb[0].features[2].tolerance is '0 / -0.05 mm'" + kHalfWidth},
          {"tolerance = \"0.02 mm\"", "tolerance = \"905 js7\"",
           "m.toml:20:81: limb[0].features[2].tolerance is '905 js7'" + kHalfWidth},
          {"tolerance = \"0.02 mm\"", "tolerance = { zone = \"IT7\" }",
           "m.toml:20:90: limb[0].features[2].tolerance.zone is 'IT7'" + kHalfWidth},
          {"position = { zone = \"0.05 mm\"", "position = { zone = \"general\"",
           "m.toml:19:112: limb[0].features[1].position.zone is \"general\", but ISO 2768-2 never held for position, "
           "coaxiality, angularity, profile and total run-out; write the length that is meant, because nothing is "
           "assumed in silence"},
          {"position = { zone = \"0.05 mm\"", "position = { zone = \"-0.05 mm\"",
           "m.toml:19:112: limb[0].features[1].position.zone '-0.05 mm' is not greater than 0; write a value greater "
           "than 0"},
          {"position = { zone = \"0.05 mm\"", "position = { zone = \"1 deg\"",
           "m.toml:19:112: limb[0].features[1].position.zone '1 deg' is an angle, but must be a length; correct the "
           "expression or its unit"},
          {"position = { zone = \"0.05 mm\"", "position = { zones = \"0.05 mm\"",
           "m.toml:19:105: unknown key 'zones' in [limb[0].features[1].position]; did you mean 'zone'?"},
          {"direction = \"z\", tolerance = \"0.02 mm\"", "direction = \"z\", parallelism = \"0.02 mm\"",
           "m.toml:20:69: limb[0].features[2].parallelism does not belong to a feature of kind \"distance\"; remove "
           "it"},
          {"perpendicularity = { zone = \"0.02 mm\"", "tolerance = { zone = \"0.02 mm\"",
           "m.toml:19:141: limb[0].features[1].tolerance does not belong to a feature of kind \"axis\"; remove it"},
          {"name = \"cross_b\"", "name = \"hinge_b\"",
           "m.toml:22:12: limb[0].features[4].name 'hinge_b' is the name of another feature of this limb; give it a "
           "name of its own"},
          {"parallelism = { zone = \"0.01 mm\", datums = \"A\" } },\n  { name = \"rail\"",
           "runout = { zone = \"0.01 mm\", datums = \"A\" } },\n  { name = \"rail\"",
           "m.toml:18:3: limb[0].features[0] 'face' has runout, which is measured on a round face; write its "
           "diameter"},
          {"at = [\"R\", 0, \"300 mm\"]", "shape = \"planes\", at = [\"R\", 0, \"300 mm\"]",
           "m.toml:19:3: limb[0].features[1] 'rail' has zones between planes; write along = \"x\" or \"y\""},
          {"at = [\"R\", 0, \"300 mm\"]", "along = \"y\", at = [\"R\", 0, \"300 mm\"]",
           "m.toml:19:3: limb[0].features[1] 'rail' has along; write shape = \"planes\" too, or remove it"},
          {"at = [\"R\", 0, \"300 mm\"]", "along = \"z\", shape = \"planes\", at = [\"R\", 0, \"300 mm\"]",
           "m.toml:19:75: limb[0].features[1].along is 'z', which is unknown; known: x, y"},
          {"parallelism = { zone = \"0.01 mm\", datums = \"A\" } },\n  { name = \"rail\"",
           "flatness = \"0.01 mm\", parallelism = { zone = \"0.01 mm\", datums = \"A\" } },\n  { name = \"rail\"",
           "m.toml:18:121: limb[0].features[0] 'face' has flatness and parallelism; remove the flatness, because the "
           "other zone contains the form"},
          {"at = [\"R\", 0, \"300 mm\"]", "x = \"z\", at = [\"R\", 0, \"300 mm\"]",
           "m.toml:19:71: limb[0].features[1] 'rail' has x parallel to z; write another x"},
          {"at = [\"R\", 0, \"300 mm\"]", "at = \"C0\"",
           "m.toml:19:72: limb[0].features[1].at 'C0' is neither a joint of this limb nor a point; did you mean 'C'?"},
          {"direction = \"z\"", "direction = [0, 0, 0]",
           "m.toml:20:64: limb[0].features[2].direction is zero and has no direction; give it a length, e.g. [0, 0, "
           "1]"},
          {"direction = \"z\", ", "",
           "m.toml:20:3: key 'direction' is missing in [limb[0].features[2]]; write direction = [1, 0, 0]"},
          {"part = \"after\"", "part = \"behind\"",
           "m.toml:26:53: limb[0].features[8].part is 'behind', which is unknown; known: before, after"},
          {"part = \"after\", kind", "part = \"after\", fit = 3, kind",
           "m.toml:26:62: unknown key 'fit' in [limb[0].features[8]]; known: kind, name, joint, axis, part, at, "
           "length, size, diameter, direction, nominal_size, z, ... (30 in all)"},
          {"\"A|B\" } } ]",
           "\"A|B\" } } ]\n\n[[error]]\nname = \"k\"\nlimb = 1\nframe = 1\ncomponent = \"delta_x\"\ncomponents = { "
           "delta_y = 1 }\n",
           "m.toml:33:1: error[0].components does not belong to an error with component; remove it"},
          {"\"A|B\" } } ]", "\"A|B\" } } ]\n\n[[error]]\nname = \"k\"\nlimb = 1\nframe = 1\n",
           "m.toml:28:1: key 'component' is missing in [error[0]]; write component = \"delta_z\", or components = { "
           "delta_z = 1 }"},
          {"\"A|B\" } } ]", "\"A|B\" } } ]\n\n[[error]]\nname = \"k\"\nlimb = 1\nframe = 1\ncomponents = {}\n",
           "m.toml:32:14: error[0].components is empty; write { delta_z = 1 }, for instance"},
          {"\"A|B\" } } ]",
           "\"A|B\" } } ]\n\n[[error]]\nname = \"k\"\nlimb = 1\nframe = 1\ncomponents = { delta_x = 0 }\n",
           "m.toml:29:8: error[0].name 'k' changes nothing; write the share of a component"},
          {"\"A|B\" } } ]",
           "\"A|B\" } } ]\n\n[[error]]\nname = \"k\"\nlimb = 1\nframe = 1\ncomponents = { delta_q = 1 }\n",
           "m.toml:32:26: error[0].components.delta_q is of a component that no frame has; write delta_x, delta_y, "
           "delta_z, epsilon_x, epsilon_y or epsilon_z = its share of the error"},
          {"\"A|B\" } } ]",
           "\"A|B\" } } ]\n\n[[error]]\nname = \"k\"\nlimb = 1\nframe = 1\ncomponents = { delta_x = 1, epsilon_y = 1 "
           "}\n",
           "m.toml:32:41: error[0].components.epsilon_y '1' makes the error an angle, and what is before it a length; "
           "for an error that is a length write numbers for delta and 1/length for epsilon, for an angle lengths for "
           "delta and numbers for epsilon"},
          {"\"A|B\" } } ]",
           "\"A|B\" } } ]\n\n[[error]]\nname = \"k\"\nlimb = 1\nframe = 1\ncomponents = { delta_x = \"1 kg\" }\n",
           "m.toml:32:26: error[0].components.delta_x '1 kg' is a mass, so the error is neither a length nor an angle; "
           "for an error that is a length write numbers for delta and 1/length for epsilon, for an angle lengths for "
           "delta and numbers for epsilon"},
          {"\"A|B\" } } ]",
           "\"A|B\" } } ]\n\n[[error]]\nname = \"k\"\nlimb = 1\nframe = 1\ncomponents = { delta_x = \"1 mm^2\" }\n",
           "m.toml:32:26: error[0].components.delta_x '1 mm^2' is length^2, so the error is neither a length nor an "
           "angle; for an error that is a length write numbers for delta and 1/length for epsilon, for an angle "
           "lengths for delta and numbers for epsilon"},
          {"\"A|B\" } } ]",
           "\"A|B\" } } ]\n\n[[error]]\nname = \"k\"\nlimb = 1\nframe = 1\ncomponents = { delta_x = \"1 / x\" }\n",
           "m.toml:32:31: error[0].components.delta_x '1 / x' has an unknown parameter 'x'; known: R, r, h, e, t, "
           "sqrt, sin, cos, tan, atan, atan2, pi"},
          {"\"A|B\" } } ]",
           "\"A|B\" } } ]\n\n[[error]]\nname = \"k\"\nlimb = 1\nframe = 1\nscale = 2\ncomponents = { delta_x = 1 }\n",
           "m.toml:32:1: error[0].scale does not belong to an error with components, each of which has its share; "
           "remove it"},
          {"\"A|B\" } } ]",
           "\"A|B\" } } ]\n\n[[error]]\nname = \"k\"\nlimb = 1\nframe = 1\nplaces = [{ limb = 1, frame = 1, component "
           "= \"delta_x\" }]\n",
           "m.toml:30:1: error[0].limb does not belong to an error with places, each of which says it; remove it"},
          {"\"A|B\" } } ]", "\"A|B\" } } ]\n\n[[error]]\nname = \"k\"\nplaces = []\n",
           "m.toml:30:10: error[0].places is empty; write [{ limb =, frame =, component = }]"},
          {"\"A|B\" } } ]", "\"A|B\" } } ]\n\n[[error]]\nname = \"k\"\nplaces = [{ limb = 1, frame = 1 }]\n",
           "m.toml:30:11: key 'component' is missing in [error[0].places[0]]; write component = \"delta_z\", or "
           "components = { delta_z = 1 }"},
          {"\"A|B\" } } ]",
           "\"A|B\" } } ]\n\n[[error]]\nname = \"k\"\nplaces = [{ limb = 4, frame = 1, component = \"delta_x\" }]\n",
           "m.toml:30:20: error[0].places[0].limb is 4; it must be at most 3"},
          {"\"A|B\" } } ]",
           "\"A|B\" } } ]\n\n[[error]]\nname = \"k\"\nplaces = [{ limb = 1, frame = 1, component = \"delta_x\" }, { "
           "limb = 2, frame = 1, component = \"epsilon_x\" }]\n",
           "m.toml:30:94: error[0].places[1].component '1' makes the error an angle, and what is before it a length; "
           "for an error that is a length write numbers for delta and 1/length for epsilon, for an angle lengths for "
           "delta and numbers for epsilon"},
          {"\"A|B\" } } ]", "\"A|B\" } } ]\n\n[[error]]\nname = \"k\"\ncomponent = \"delta_x\"\n",
           "m.toml:28:1: key 'limb' is missing in [error[0]]; write limb = \"each\""},
      });
}

/// If an error combines the same components as another error or a feature, it has the same effect on the platform.
TEST(Combinations, AreTheColumnsOfTheirComponents) {
  const std::string text = text_of(kName) +
                           "\n[[error]]\nname = \"lean\"\nlimb = 1\nframe = 1\n"
                           "components = { epsilon_y = \"2 / 1 m\", delta_x = -0.6 }\n"
                           "[[error]]\nname = \"both\"\nplaces = [\n"
                           "  { limb = [1, 2], frame = 4, component = \"delta_x\" },\n"
                           "  { limb = 3, frame = \"q\", component = \"delta_z\", scale = -2 }]\n"
                           "[[error]]\nname = \"turn\"\nlimb = 2\nframe = 3\n"
                           "components = { epsilon_x = 1, delta_z = \"30 mm\" }\n";
  const MechanismFile file = read_mechanism_file(text, "m.toml");
  const Mechanism made = mechanism(file, default_geometry(file));
  ASSERT_EQ(made.factors.size(), 81u);
  EXPECT_EQ(made.factors[78].dimension, Dimension::length);
  EXPECT_EQ(made.factors[79].name, "both");
  EXPECT_EQ(made.terms[79].size(), 3u);
  EXPECT_EQ(made.factors[80].dimension, Dimension::angle);
  const Answer exact(text, 0);
  const std::vector<double> pose{0.02, 0.03, 0.21};
  const auto same = [&](const json& one, const json& other) {
    const std::vector<double> a = exact.responses(pose, one);
    const std::vector<double> b = exact.responses(pose, other);
    for (std::size_t r = 0; r < a.size(); ++r) EXPECT_NEAR(a[r], b[r], 1e-15) << one << other;
  };
  same({{"lean", 2e-5}}, {{"rail_lean_x_1", 2e-5}});
  same({{"both", 3e-5}}, {{"rod_1", 3e-5}, {"rod_2", 3e-5}, {"zero_3", -6e-5}});
}

/// Angular errors of the first and last frame of a limb act about the same points with and without features.
TEST(Combinations, TurnAboutTheJointsToFirstOrder) {
  const std::string angles =
      "\n[[error]]\nname = \"a\"\nlimb = \"each\"\nframe = 0\ncomponent = \"epsilon_y\"\n"
      "[[error]]\nname = \"b\"\nlimb = \"each\"\nframe = 6\ncomponent = \"epsilon_x\"\n";
  const std::string text = text_of(kName);
  const std::size_t features = text.find("features = [");
  const Answer with(text + angles, 1);
  const Answer without(text.substr(0, features) + angles, 1);
  const json errors = {{"a_1", 1e-3}, {"b_2", 2e-3}};
  const std::vector<double> a = with.responses({0.02, 0.03, 0.21}, errors);
  const std::vector<double> b = without.responses({0.02, 0.03, 0.21}, errors);
  EXPECT_GT(std::abs(b[0]), 1e-6);
  for (std::size_t r = 0; r < a.size(); ++r) EXPECT_NEAR(a[r], b[r], 1e-15);
}

}  // namespace
}  // namespace poesy::file
