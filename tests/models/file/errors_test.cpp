// Tests where the errors of a mechanism file act, and in which limbs.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <random>

#include "models/file/model.h"
#include "tests/models/file/files.h"

namespace poesy::file {
namespace {

using Errors = std::map<std::string, double>;

/// The responses by name, if only these errors are not zero.
std::map<std::string, double> outcome(const Model& model, const std::vector<double>& pose, const Errors& named) {
  const ModelDescription& description = model.description();
  std::vector<FactorIndex> varied;
  std::vector<double> errors;
  for (const auto& [name, value] : named) {
    varied.push_back(*description.find_factor(name));
    errors.push_back(value);
  }
  const std::vector<double> none(description.factors.size(), 0.0);
  std::vector<double> responses(description.responses.size());
  std::array status{SolveStatus::singular};
  std::array iterations{std::uint32_t{0}};
  model.evaluator({.tolerance = description.tolerance})
      ->evaluate({pose, none, varied, errors, 1}, {responses, status, iterations, {}});
  EXPECT_TRUE(solved(status[0]));
  std::map<std::string, double> found;
  for (std::size_t r = 0; r < responses.size(); ++r) found[description.responses[r].name] = responses[r];
  return found;
}

/// Geometry parameters of a Tricept and a planar 3-RRR: bx, by, bz shift the mechanism in the base frame, and px, py,
/// pz shift the platform's origin. The tool and the points of the platform stay where they are in the mechanism.
const std::string kShifts =
    "[geometry]\nbx = \"0 mm\"\nby = \"0 mm\"\nbz = \"0 mm\"\npx = \"0 mm\"\npy = \"0 mm\"\npz = \"0 mm\"\n";

std::string platform(const std::string& height, const std::string& coordinates) {
  return "[platform]\norigin = [\"bx + px\", \"by + py\", \"bz + pz + " + height + "\"]\n" + coordinates +
         "tool = [\"10 mm - px\", \"20 mm - py\", \"30 mm - pz\"]\n"
         "points = [[\"80 mm - px\", \"-py\", \"-pz\"], [\"-40 mm - px\", \"70 mm - py\", \"-pz\"], "
         "[\"-40 mm - px\", \"-70 mm - py\", \"-pz\"]]\n";
}

std::string at(double x, double y, double z) {
  return "[\"bx + " + shortest(x) + " mm\", \"by + " + shortest(y) + " mm\", \"bz + " + shortest(z) + " mm\"]";
}

std::string tricept() {
  std::string text =
      "format = \"poesy-mechanism\"\nversion = 1\nname = \"tricept\"\n" + kShifts +
      platform("800 mm",
               "coordinates = [\"x\", \"y\", \"z\"]\nworkspace = { x = [\"bx - 300 mm\", \"bx + 300 "
               "mm\"], y = [\"by - 300 mm\", \"by + 300 mm\"], z = [\"bz + 500 mm\", \"bz + 1500 mm\"] }\n");
  for (int i = 0; i < 3; ++i) {
    const double angle = 2.0 * M_PI / 3.0 * i;
    const std::string base = at(250.0 * std::cos(angle), 250.0 * std::sin(angle), 0.0);
    const std::string end = at(125.0 * std::cos(angle), 125.0 * std::sin(angle), 800.0);
    text += "[[limb]]\nname = \"leg_" + std::to_string(i + 1) +
            "\"\njoints = [ { name = \"A\", type = \"U\", at = " + base +
            ", axis = \"y\", axis2 = \"x\" },\n"
            "  { name = \"q\", type = \"P\", from = \"A\", to = \"S\", actuated = true },\n"
            "  { name = \"S\", type = \"S\", at = " +
            end + " } ]\n";
  }
  return text + "[[limb]]\nname = \"post\"\njoints = [ { name = \"C\", type = \"U\", at = " + at(0, 0, 0) +
         ", axis = \"x\", axis2 = \"y\" },\n  { name = \"p\", type = \"P\", at = " + at(0, 0, 800) +
         ", axis = \"z\" } ]\n";
}

std::string planar() {
  std::string text =
      "format = \"poesy-mechanism\"\nversion = 1\nname = \"planar\"\n" + kShifts +
      platform("0 mm",
               "coordinates = [\"x\", \"y\", \"rz\"]\nworkspace = { x = [\"bx - 40 mm\", \"bx + 40 mm\"], "
               "y = [\"by - 40 mm\", \"by + 40 mm\"], rz = [\"-20 deg\", \"20 deg\"] }\n");
  for (int i = 0; i < 3; ++i) {
    const double angle = 2.0 * M_PI / 3.0 * i;
    const auto point = [&](double x, double y) {
      return at(x * std::cos(angle) - y * std::sin(angle), x * std::sin(angle) + y * std::cos(angle), 0.0);
    };
    text += "[[limb]]\njoints = [ { name = \"A\", type = \"R\", at = " + point(300, 0) +
            ", axis = \"z\", actuated = true },\n  { name = \"B\", type = \"R\", at = " + point(220, 120) +
            ", axis = \"z\" },\n  { name = \"C\", type = \"R\", at = " + point(80, 0) + ", axis = \"z\" } ]\n";
  }
  return text;
}

struct Shifted {
  std::string name;
  std::string text;
  std::vector<double> pose;  ///< of the mechanism without shifts, in the home orientation
};

class Shifts : public testing::TestWithParam<Shifted> {
 protected:
  /// The largest difference that the shifts in `geometry` make to a response to one error of 1 mm or 1 deg, relative to
  /// the largest value of this response. Responses that refer to the platform's origin are not compared.
  double difference(const std::string& about, const std::vector<double>& geometry) const {
    const CatalogEntry entry = catalog_entry(GetParam().text + "[errors]\n" + about, "m.toml");
    const std::unique_ptr<Model> model = build(entry);
    const std::unique_ptr<Model> shifted = entry.build(geometry, 0);
    std::vector<double> pose = GetParam().pose;
    for (std::size_t c = 0; c < pose.size(); ++c) {
      const std::string& name = entry.description.pose_coordinates[c].name;
      if (name.size() == 1) pose[c] += geometry[static_cast<std::size_t>(name[0] - 'x')] + geometry[3 + name[0] - 'x'];
    }
    std::map<std::string, double> largest;
    std::map<std::string, double> apart;
    for (const Factor& factor : entry.description.factors) {
      const double size = factor.dimension == Dimension::length ? 1e-3 : M_PI / 180.0;
      const auto before = outcome(*model, GetParam().pose, {{factor.name, size}});
      const auto after = outcome(*shifted, pose, {{factor.name, size}});
      for (const auto& [name, value] : before) {
        if (name == "x" || name == "y" || name == "z" || name == "position" || name == "linear_deformation") continue;
        largest[name] = std::max(largest[name], std::abs(value));
        apart[name] = std::max(apart[name], std::abs(after.at(name) - value));
      }
    }
    double share = 0.0;
    for (const auto& [name, value] : apart) {
      if (largest[name] > 1e-9) share = std::max(share, value / largest[name]);
    }
    return share;
  }
};

TEST_P(Shifts, OfTheBaseChangeNoErrorAboutJoints) {
  const std::vector<double> lower{0.3, -0.2, 1.0, 0.0, 0.0, 0.0};
  EXPECT_LT(difference("", lower), 1e-9);
  EXPECT_LT(difference("about = \"joint\"", lower), 1e-9);
  EXPECT_GT(difference("about = \"frame\"", lower), 0.1);
}

TEST_P(Shifts, OfTheOriginChangeNoErrorAboutJoints) {
  const std::vector<double> elsewhere{0.0, 0.0, 0.0, 0.1, -0.2, 0.3};
  EXPECT_LT(difference("", elsewhere), 1e-9);
  EXPECT_GT(difference("about = \"frame\"", elsewhere), 0.1);
}

INSTANTIATE_TEST_SUITE_P(Mechanisms, Shifts,
                         testing::Values(Shifted{"tricept", tricept(), {0.0, 0.0, 0.85}},
                                         Shifted{"planar", planar(), {0.02, -0.01, 0.0}}),
                         [](const auto& instance) { return instance.param.name; });

/// The same mechanism with angular errors about the joints and about the origins of the frames.
struct Both {
  CatalogEntry joint;
  CatalogEntry frame;
  Mechanism mechanism;
};

Both both(const std::string& name) {
  std::string text = text_of(name);
  text = text.substr(0, text.find("\n[errors]")) + "\n[errors]\nframes = \"all\"\n";
  const MechanismFile file = read_mechanism_file(text, "m.toml");
  return {catalog_entry(text, "m.toml"), catalog_entry(text + "about = \"frame\"\n", "m.toml"),
          mechanism(file, default_geometry(file))};
}

/// An angular error epsilon about the point c of a joint equals the same angular error about the frame's origin and a
/// displacement: c - exp(epsilon) c exactly, c x epsilon to first order.
TEST(ErrorsAbout, AreTheFramesWithTheDisplacementOfTheJoint) {
  std::mt19937_64 engine(5);
  const auto draw = [&](double size) {
    return Vector3(std::uniform_real_distribution<double>(-size, size)(engine),
                   std::uniform_real_distribution<double>(-size, size)(engine),
                   std::uniform_real_distribution<double>(-size, size)(engine));
  };
  for (const char* name : {"rps3", "ups6", "upr2-rpu"}) {
    const Both models = both(name);
    const ModelDescription& description = models.joint.description;
    for (const std::size_t fidelity : {0u, 1u}) {
      const std::unique_ptr<Model> joint = build(models.joint, fidelity);
      const std::unique_ptr<Model> frame = build(models.frame, fidelity);
      std::vector<double> pose;
      for (std::size_t c = 0; c < description.pose_lower.size(); ++c) {
        pose.push_back(0.3 * description.pose_lower[c] + 0.7 * description.pose_upper[c]);
      }
      for (std::size_t i = 0; i < models.mechanism.limbs.size(); ++i) {
        const Limb& limb = models.mechanism.limbs[i];
        for (const std::size_t j : {std::size_t{0}, limb.joints.size()}) {
          const Joint& one = j == 0 ? limb.joints.front() : limb.joints.back();
          const Transform& platform = models.mechanism.platform;
          const Vector3 c = j == 0 ? one.at_home.p : Vector3(platform.R.transpose() * (one.at_home.p - platform.p));
          const Vector3 epsilon = draw(0.02);
          const Vector3 delta = draw(0.001);
          const Vector3 moved =
              delta + (fidelity == 0 ? Vector3(c - lie::exp<double>(epsilon) * c) : Vector3(c.cross(epsilon)));
          const std::string at = std::to_string(i + 1) + "_" + std::to_string(j) + "_";
          Errors about_joint;
          Errors about_frame;
          for (Eigen::Index k = 0; k < 3; ++k) {
            about_joint["epsilon_" + at + "xyz"[k]] = about_frame["epsilon_" + at + "xyz"[k]] = epsilon[k];
            about_joint["delta_" + at + "xyz"[k]] = delta[k];
            about_frame["delta_" + at + "xyz"[k]] = moved[k];
          }
          const auto expected = outcome(*frame, pose, about_frame);
          const auto found = outcome(*joint, pose, about_joint);
          for (const auto& [response, value] : expected) EXPECT_NEAR(found.at(response), value, 1e-12) << response;
          Errors displacement;  // without an angle both have the same bits
          for (const char axis : {'x', 'y', 'z'})
            displacement["delta_" + at + axis] = about_joint["delta_" + at + axis];
          EXPECT_EQ(outcome(*joint, pose, displacement), outcome(*frame, pose, displacement));
        }
      }
    }
  }
}

TEST(ErrorsAbout, IsSaidOfTheFactors) {
  const Both models = both("rps3");
  const auto words = [](const CatalogEntry& entry, const char* name) {
    return entry.description.factors[entry.description.find_factor(name)->value].description;
  };
  EXPECT_EQ(words(models.joint, "epsilon_2_0_x"),
            "limb 2, joint A against base: angular error about x of the base at joint A");
  EXPECT_EQ(words(models.joint, "epsilon_2_5_y"),
            "limb 2, platform against joint S (3 of 3): angular error about y of the platform at joint S (3 of 3)");
  EXPECT_EQ(words(models.frame, "epsilon_2_0_x"), "limb 2, joint A against base: angular error about x of the base");
  EXPECT_NE(models.joint.description.structure.find("turn about the points of its first and last joint."),
            std::string::npos);
  EXPECT_NE(models.frame.description.structure.find("turn about the origins of base and platform."), std::string::npos);
}

TEST(ErrorsAbout, PointOfASlidingJointIsExplained) {
  const auto structure = [](const std::string& file) { return catalog_entry(file, "m.toml").description.structure; };
  const std::string words = "The point of a P joint does not change how it slides";
  EXPECT_NE(structure(tricept()).find(words), std::string::npos);
  EXPECT_EQ(structure(planar()).find(words), std::string::npos);
}

// ---- limbs of named errors

std::vector<std::string> factors_with(const std::string& error) {
  std::vector<std::string> list;
  for (const Factor& factor : catalog_entry(tricept() + "[[error]]\n" + error, "m.toml").description.factors) {
    list.push_back(factor.name + " in " + std::to_string(factor.limb));
  }
  return list;
}

std::string problem_with(const std::string& error) {
  try {
    static_cast<void>(factors_with(error));
  } catch (const InputError& problem) {
    const std::string text = problem.what();
    return text.substr(text.find(": ") + 2);
  }
  return "read";
}

using Names = std::vector<std::string>;

TEST(LimbsOfErrors, AreNumbersNamesListsOrEach) {
  const std::string foot = "name = \"foot\"\nframe = 6\ncomponent = \"delta_x\"\n";
  EXPECT_EQ(factors_with(foot + "limb = 2\n"), Names{"foot in 2"});
  EXPECT_EQ(factors_with(foot + "limb = \"leg_3\"\n"), Names{"foot in 3"});
  EXPECT_EQ(factors_with(foot + "limb = [3, 1]\n"), (Names{"foot_3 in 3", "foot_1 in 1"}));
  EXPECT_EQ(factors_with(foot + "limb = [\"leg_2\"]\n"), Names{"foot_2 in 2"});
  EXPECT_EQ(factors_with("name = \"foot\"\nframe = 0\ncomponent = [\"delta_x\", \"delta_z\"]\nlimb = [1, \"post\"]\n"),
            (Names{"foot_x_1 in 1", "foot_z_1 in 1", "foot_x_4 in 4", "foot_z_4 in 4"}));
}

TEST(LimbsOfErrors, ANameMeansAllCopies) {
  std::string text = text_of("rps3");
  text = text.substr(0, text.find("\n[errors]"));
  text.replace(text.find("[[limb]]"), 8, "[[limb]]\nname = \"leg\"");
  const CatalogEntry entry =
      catalog_entry(text + "\n[[error]]\nname = \"l\"\nlimb = \"leg\"\nframe = 2\ncomponent = \"delta_z\"\n", "m.toml");
  ASSERT_EQ(entry.description.factors.size(), 3u);
  for (std::size_t i = 0; i < 3; ++i) {
    EXPECT_EQ(entry.description.factors[i].name, "l_" + std::to_string(i + 1));
    EXPECT_EQ(entry.description.factors[i].limb, i + 1);
  }
}

/// In the Tricept a leg has six joints, and the post in the middle has three.
TEST(LimbsOfErrors, EachNeedsTheFrameInAllOfThem) {
  const std::string each = "limb = \"each\"\nname = \"foot\"\ncomponent = \"delta_x\"\n";
  EXPECT_EQ(problem_with(each + "frame = 6\n"),
            "error[0].frame is 6, which limbs 1, 2 and 3 have, and limb 4 not: the last frame of limb 4 is 3; name the "
            "limbs that are meant: limb = [1, 2, 3]");
  EXPECT_EQ(problem_with(each + "frame = 7\n"), "error[0].frame is 7; the last frame of limb 1 (leg_1) is 6");
  EXPECT_EQ(problem_with("limb = [2, 4]\nname = \"foot\"\ncomponent = \"delta_x\"\nframe = 5\n"),
            "error[0].frame is 5; the last frame of limb 4 (post) is 3");
  EXPECT_EQ(problem_with("limb = \"leg\"\nname = \"foot\"\ncomponent = \"delta_x\"\nframe = 5\n"),
            "error[0].limb is 'leg', which no limb is named; write a limb's number, its name, a list of these, or "
            "\"each\"");
}

TEST(LimbsOfErrors, EachSaysWhich) {
  const std::string each = "[[error]]\nlimb = \"each\"\nname = \"foot\"\nframe = 1\ncomponent = \"delta_x\"\n";
  const std::string said =
      "error foot with limb = \"each\" is in limbs 1, 2 and 3, joint A (2 of 2) against joint A (1 of 2); in limb 4, "
      "joint C (2 of 2) against joint C (1 of 2)";
  const CatalogEntry unlike = catalog_entry(tricept() + each, "m.toml");
  EXPECT_NE(unlike.description.structure.find("  " + said + ".\n"), std::string::npos) << unlike.description.structure;
  const std::vector<std::string> hints = build(unlike)->unusual_errors();
  ASSERT_EQ(hints.size(), 1u);
  EXPECT_EQ(hints.front(), said + ", and these limbs have other joints than each other");
  const CatalogEntry alike = catalog_entry(text_of("rrr3"), "m.toml");
  EXPECT_NE(alike.description.structure.find(
                "  error l with limb = \"each\" is in limbs 1, 2 and 3, joint B against joint A.\n"),
            std::string::npos)
      << alike.description.structure;
  EXPECT_TRUE(build(alike)->unusual_errors().empty());
}

// ---- sizes

/// A leg of 600 mm with a universal joint whose axes are 1.2 mm apart. A link must bound the errors, not this offset.
TEST(SizesOfErrors, AreComparedWithLinks) {
  std::string text = text_of("rps3");
  const std::string joint = "{ name = \"q\", type = \"P\", from = \"A\"";
  text.replace(text.find(joint), joint.size(),
               "{ name = \"offset\", type = \"fixed\", at = [\"a + 1.2 mm\", 0, 0], axis = \"y\" },\n  " + joint);
  const std::unique_ptr<Model> model = build(catalog_entry(text, "m.toml"));
  const auto bound = [&](const char* name) { return model->error_bound(*model->description().find_factor(name)); };
  EXPECT_GT(bound("delta_1_1_x").size, 0.1);
  EXPECT_LT(bound("delta_1_1_x").size, 0.7);
  EXPECT_EQ(bound("delta_1_1_x").part, "the distance from S to the platform's origin");
}

/// Short links that are real parts of the mechanism do bound the errors.
TEST(SizesOfErrors, ShortLinksCount) {
  const std::unique_ptr<Model> model = build(catalog_entry(text_of("rrr3"), "m.toml"));
  const ErrorBound bound = model->error_bound(FactorIndex(0));
  EXPECT_EQ(bound.part, "the distance from C to the platform's origin");
  EXPECT_NEAR(bound.size, 0.08, 1e-12);
}

/// A limb of three hinges through the platform's origin has no link, so the bound is the reach of the mechanism.
TEST(SizesOfErrors, WithoutALinkTheReachIsTheBound) {
  const std::string text =
      "format = \"poesy-mechanism\"\nversion = 1\nname = \"wrist\"\n[platform]\norigin = [0, 0, 0]\n"
      "coordinates = [\"rx\", \"ry\", \"rz\"]\nworkspace = { rx = [\"-9 deg\", \"9 deg\"], ry = [\"-9 deg\", \"9 "
      "deg\"], "
      "rz = [\"-9 deg\", \"9 deg\"] }\npoints = [[\"1 m\", 0, 0], [0, \"1 m\", 0], [0, 0, \"1 m\"]]\n"
      "[[limb]]\ncopies = { count = 3, about = \"z\" }\njoints = [\n"
      "  { name = \"A\", type = \"U\", at = [\"400 mm\", 0, \"-800 mm\"], axis = \"y\", axis2 = \"x\" },\n"
      "  { name = \"q\", type = \"P\", from = \"A\", to = \"S\", actuated = true },\n"
      "  { name = \"S\", type = \"S\", at = [\"150 mm\", \"150 mm\", 0] } ]\n"
      "[[limb]]\njoints = [ { name = \"X\", type = \"R\", at = [0, 0, 0], axis = \"x\" },\n"
      "  { name = \"Y\", type = \"R\", at = [0, 0, 0], axis = \"y\" },\n"
      "  { name = \"Z\", type = \"R\", at = [0, 0, 0], axis = \"z\" } ]\n";
  const CatalogEntry entry = catalog_entry(text, "m.toml");
  const ErrorBound bound = build(entry)->error_bound(*entry.description.find_factor("delta_4_1_x"));
  EXPECT_EQ(bound.part, "the mechanism's reach");
  EXPECT_NEAR(bound.size, std::hypot(0.4, 0.8), 1e-12);
}

}  // namespace
}  // namespace poesy::file
