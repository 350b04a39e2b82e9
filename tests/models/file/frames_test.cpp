#include <gtest/gtest.h>

#include <numbers>

#include "models/file/metric_check.h"
#include "models/file/structure.h"
#include "tests/models/file/files.h"
#include "tests/models/file/wrong.h"

namespace poesy::file {
namespace {

const Joint& joint(const Mechanism& mechanism, std::size_t limb, std::size_t j) {
  return mechanism.limbs[limb].joints[j];
}

Vector3 axis(const Joint& joint, Eigen::Index column) { return joint.at_home.R.col(column); }

TEST(Frames, AreRightHanded) {
  for (const char* name : {"rps3", "ups6", "upr2-rpu", "tripteron", "rrr3", "sps6", "mixed6", "odd6", "press"}) {
    for (const Limb& limb : from_file(name).limbs) {
      for (const Joint& joint : limb.joints) {
        const lie::Matrix3<double>& R = joint.at_home.R;
        EXPECT_LE((R * R.transpose() - lie::Matrix3<double>::Identity()).norm(), 3e-15);
        EXPECT_NEAR(R.determinant(), 1.0, 3e-15);
      }
    }
  }
}

TEST(Loads, AreAskedAboutWithoutStiffness) {
  const auto found = [](const std::string& name, const std::string& load) {
    const MechanismFile file = read_mechanism_file(text_of(name) + "\n[load]\n" + load, "m.toml");
    return loads_without_effect(mechanism(file, default_geometry(file)));
  };
  EXPECT_EQ(found("rps3", "force = [0, 0, \"-50 N\"]\n").size(), 1u);
  EXPECT_TRUE(found("rps3", "force = [0, 0, 0]\n").empty());
  EXPECT_TRUE(found("tripteron-msa", "force = [0, 0, \"-50 N\"]\n").empty());
}

TEST(Tools, FarFromThePlatformOrStatedInTheBaseAreAskedAbout) {
  const auto found = [](const std::string& tool) {
    const std::string text = replaced(text_of("ups6"), {"tool        = [0, 0, \"80 mm\"]", "tool = " + tool});
    const MechanismFile file = read_mechanism_file(text, "m.toml");
    return odd_tool(mechanism(file, default_geometry(file)));
  };
  EXPECT_TRUE(found("[0, 0, \"80 mm\"]").empty());
  EXPECT_TRUE(found("[0, 0, \"-300 mm\"]").empty());
  const std::vector<std::string> far = found("[0, 0, \"80 m\"]");
  ASSERT_EQ(far.size(), 1u);
  EXPECT_EQ(far.front().find("the tool is 80000 mm from the platform's origin"), 0u) << far.front();
  const std::vector<std::string> in_base = found("[0, 0, \"h + 80 mm\"]");
  ASSERT_EQ(in_base.size(), 1u);
  EXPECT_EQ(in_base.front().find("the tool is at (0, 0, 880) mm from the platform's origin, which is itself at (0, 0, "
                                 "800) mm in the base's frame"),
            0u)
      << in_base.front();
}

TEST(Turns, OfMoreThanAFullTurnAreAskedAbout) {
  const auto found = [](const std::string& range) {
    const std::string text = replaced(text_of("ups6"), {"rz = [\"-8 deg\", \"8 deg\"]", "rz = [" + range + "]"});
    const MechanismFile file = read_mechanism_file(text, "m.toml");
    return wide_turns(mechanism(file, default_geometry(file)));
  };
  EXPECT_TRUE(found("\"-180 deg\", \"180 deg\"").empty());
  EXPECT_EQ(found("\"-8 rad\", \"8 rad\""),
            std::vector<std::string>{"the workspace has rz from -458.4 deg to 458.4 deg, more than a full turn"});
}

/// An axis of a universal joint that lies along its leg is asked about, at either end of the leg.
TEST(Frames, OfUniversalJointsLieAcrossTheLeg) {
  const auto found = [](const std::string& written, const std::string& instead) {
    const MechanismFile file =
        read_mechanism_file(replaced(text_of("linear-delta-drawing"), {written, instead}), "m.toml");
    return axes_along_legs(mechanism(file, default_geometry(file)));
  };
  EXPECT_TRUE(found("axis = \"y\"", "axis = \"y\"").empty());
  const std::vector<std::string> first =
      found(R"(axis = "y", axis2 = ["h", 0, "r - R"])", R"(axis = "y", axis2 = ["r - R", 0, "-h"])");
  ASSERT_EQ(first.size(), 1u);
  EXPECT_EQ(first.front().find("axis2 of joint B of limb"), 0u) << first.front();
  const std::vector<std::string> last =
      found(R"(axis = ["h", 0, "r - R"], axis2 = "y")", R"(axis = ["r - R", 0, "-h"], axis2 = "y")");
  ASSERT_EQ(last.size(), 1u);
  EXPECT_EQ(last.front().find("axis of joint C of limb"), 0u) << last.front();
  for (const char* name : {"rps3", "ups6", "upr2-rpu", "mixed6", "odd6", "flat-delta", "printer-universal"}) {
    EXPECT_TRUE(axes_along_legs(from_file(name)).empty()) << name;
  }
}

/// Sound limbs in which an axis of a universal joint lies along the line to another joint.
TEST(Frames, OfUniversalJointsMayLieAlongOtherLines) {
  const std::string ball = R"({ name = "C", type = "S", at = ["200 mm", 0, "500 mm"] })";
  const std::string rod = R"({ name = "B", type = "U", at = ["400 mm", 0, 0], axis = "x", axis2 = "y" }, )" + ball;
  const std::string leg = R"(axis = "y", axis2 = [-2, 0, 5] }, )" + ball;
  for (
      const std::string& joints :
      {R"({ name = "q", type = "P", at = ["300 mm", 0, 0], axis = "x", actuated = true }, )" + rod,
       R"({ name = "q", type = "R", at = ["300 mm", 0, 0], axis = "y", actuated = true }, )" + rod,
       R"({ name = "A", type = "R", at = ["400 mm", 0, 0], axis = "x" }, { name = "B", type = "U", at = ["400 mm", 0, 0], )" +
           leg}) {
    const MechanismFile file = read_mechanism_file(
        "format = \"poesy-mechanism\"\nversion = 1\nname = \"m\"\ntitle = \"m\"\n[platform]\norigin = [0, 0, \"500 "
        "mm\"]\n"
        "coordinates = [\"x\"]\nworkspace = { x = [\"-1 mm\", \"1 mm\"] }\n[[limb]]\n"
        "copies = { count = 3, about = \"z\" }\njoints = [ " +
            joints + " ]\n",
        "m.toml");
    EXPECT_TRUE(axes_along_legs(mechanism(file, default_geometry(file))).empty()) << joints;
  }
}

/// The x axis of a joint points to the next joint, projected perpendicular to z. If both points coincide, x is along a
/// base axis.
TEST(Frames, FollowThePrintedRule) {
  const Mechanism m = from_file("mixed6");
  ASSERT_EQ(m.limbs[0].joints.size(), 7u);
  EXPECT_LE((axis(joint(m, 0, 0), 2) - Vector3(0, 0, -1)).norm(), 1e-15);
  EXPECT_LE((axis(joint(m, 0, 0), 0) - Vector3(0, 1, 0)).norm(), 1e-15);
  EXPECT_LE((axis(joint(m, 0, 1), 0) - Vector3(0, 1, 0)).norm(), 1e-15);
  const double skew = 8.0 * std::numbers::pi / 180.0;
  const Vector3 second(std::sin(skew), std::cos(skew), 0.0);
  EXPECT_LE((axis(joint(m, 0, 2), 2) - second).norm(), 1e-15);
  EXPECT_LE((axis(joint(m, 0, 2), 0) - (Vector3::UnitX() - std::sin(skew) * second).normalized()).norm(), 1e-15);
  EXPECT_EQ(joint(m, 0, 3).motion, Motion::helical);
  EXPECT_NEAR(joint(m, 0, 3).pitch, -0.005 / (2.0 * std::numbers::pi), 1e-18);
  EXPECT_LE((axis(joint(m, 0, 4), 2) - axis(joint(m, 0, 3), 2)).norm(), 1e-15);
  EXPECT_LE((axis(joint(m, 0, 5), 2) - axis(joint(m, 0, 4), 0)).norm(), 1e-15);
  EXPECT_LE((axis(joint(m, 0, 6), 2) - axis(joint(m, 0, 4), 1)).norm(), 1e-15);
  const Vector3 to_platform = m.platform.p - joint(m, 0, 6).at_home.p;
  EXPECT_NEAR(axis(joint(m, 0, 6), 1).dot(to_platform), 0.0, 1e-15);
  EXPECT_GT(axis(joint(m, 0, 6), 0).dot(to_platform), 0.0);
}

TEST(Frames, CylindricalIsTurnThenSlide) {
  const Mechanism m = from_file("mixed6");
  EXPECT_EQ(joint(m, 3, 2).motion, Motion::revolute);
  EXPECT_EQ(joint(m, 3, 3).motion, Motion::prismatic);
  EXPECT_FALSE(joint(m, 3, 2).actuated);
  EXPECT_TRUE(joint(m, 3, 3).actuated);
  EXPECT_LE((joint(m, 3, 2).at_home.p - joint(m, 3, 3).at_home.p).norm(), 1e-16);
  EXPECT_EQ(displacement_names(m)[0].name, "q_1_2");
  EXPECT_EQ(displacement_names(m)[2].dimension, Dimension::angle);
  EXPECT_EQ(displacement_names(m)[21].name, "q_4_4");
  EXPECT_EQ(displacement_names(m)[21].dimension, Dimension::length);
}

TEST(Frames, CopiesAreTurned) {
  const Mechanism m = from_file("mixed6");
  for (std::size_t k = 0; k < 3; ++k) {
    const Transform turn = lie::rotation<double>(lie::Axis::z, 2.0 * std::numbers::pi * static_cast<double>(k) / 3.0);
    for (std::size_t j = 0; j < m.limbs[0].joints.size(); ++j) {
      const Transform wanted = turn * joint(m, 0, j).at_home;
      EXPECT_LE((joint(m, k, j).at_home.R - wanted.R).norm() + (joint(m, k, j).at_home.p - wanted.p).norm(), 1e-15);
    }
  }
}

TEST(Frames, PlatformHasItsOwnAxes) {
  const Mechanism m = from_file("mixed6");
  EXPECT_LE((m.platform.R.col(0) - Vector3::UnitY()).norm(), 1e-15);
  EXPECT_NEAR(m.platform.p.z(), 0.52, 1e-15);
  EXPECT_NEAR(m.points[0].z(), -0.02, 1e-15);
}

/// The z axis of an S joint at the beginning of a limb points to the next different point. Fixed frames count as
/// frames. Base axes that serve as x are rotated with the copies of a limb.
TEST(Frames, OfOddLimbs) {
  const Mechanism m = from_file("odd6");
  const Vector3 ball(0.0, 0.2, 0.04), plate(0.1, 0.15, 0.06), top(0.4, 0.0, 0.09);
  EXPECT_LE((axis(joint(m, 0, 0), 2) - (plate - ball).normalized()).norm(), 1e-15);
  EXPECT_EQ(joint(m, 0, 3).name, "plate");
  EXPECT_EQ(joint(m, 0, 3).motion, Motion::fixed);
  EXPECT_EQ(m.limbs[0].home.size(), 9u);
  EXPECT_LE((axis(joint(m, 0, 4), 2) - (top - ball).normalized()).norm(), 1e-15);
  EXPECT_LE((joint(m, 0, 4).at_home.p - ball).norm(), 1e-15);
  EXPECT_LE((axis(joint(m, 0, 6), 2) - Vector3::UnitY()).norm(), 1e-15);
  EXPECT_LE((axis(joint(m, 0, 7), 2) - Vector3(0, 1, 2).normalized()).norm(), 1e-15);
  EXPECT_EQ(displacement_names(m)[3].name, "q_1_5");
  const Transform turn = lie::rotation<double>(lie::Axis::x, 2.0 * std::numbers::pi / 3.0);
  const Vector3 turned = turn.R * axis(joint(m, 3, 0), 0);
  EXPECT_LE((axis(joint(m, 3, 0), 0) - Vector3::UnitY()).norm(), 1e-15);
  EXPECT_LE((axis(joint(m, 4, 0), 0) - turned).norm(), 1e-15);
  EXPECT_EQ(m.factors.size(), 12u);
}

TEST(Geometry, OfAStudyMovesTheFrames) {
  const MechanismFile file = read_mechanism_file(text_of("rps3"), "rps3.toml");
  ASSERT_EQ(file.geometry.size(), 3u);
  EXPECT_EQ(file.geometry[0].name, "a");
  EXPECT_EQ(file.geometry[2].name, "h");
  EXPECT_EQ(file.geometry[0].description, "circumradius of the base joints");
  const Mechanism m = mechanism(file, std::vector{0.3, 0.135, 0.7});
  EXPECT_NEAR(joint(m, 0, 0).at_home.p.x(), 0.3, 1e-16);
  EXPECT_NEAR(m.platform.p.z(), 0.7, 1e-16);
  const Mechanism flat = mechanism(file, std::vector{0.3, 0.0, 0.7});
  EXPECT_THROW(check_metric(file, flat), InputError);
}

TEST(Factors, AllAreSixForEachFixedFrame) {
  const Mechanism m = from_file("rps3");
  ASSERT_EQ(m.factors.size(), 3u * 6u * 6u);
  EXPECT_EQ(m.factors[0].name, "epsilon_1_0_x");
  EXPECT_EQ(m.factors[3].name, "delta_1_0_x");
  EXPECT_EQ(m.factors[3].axis, "x");
  EXPECT_EQ(m.factors[3].dimension, Dimension::length);
  EXPECT_EQ(m.factors.back().name, "delta_3_5_z");
  EXPECT_EQ(m.factors.back().limb, 3u);
  EXPECT_EQ(m.factors.back().frame, 5u);
  EXPECT_EQ(m.terms.back().front().limb, 2u);
  EXPECT_EQ(m.terms.back().front().component, 5u);
  EXPECT_EQ(m.factors[21].description,
            "limb 1, joint S (2 of 3) against joint S (1 of 3): linear error along x of frame 3");
  ASSERT_EQ(m.sets.size(), 1u);
  EXPECT_EQ(m.sets[0].name, "all");
  EXPECT_EQ(m.sets[0].factors.size(), m.factors.size());
}

TEST(Factors, AListKeepsItsOrder) {
  const Mechanism m = from_file("upr2-rpu");
  ASSERT_EQ(m.factors.size(), 71u);
  EXPECT_EQ(m.factors[0].name, "delta_1_0_x");
  EXPECT_EQ(m.terms[0].front().component, 3u);
  EXPECT_EQ(m.factors[3].name, "epsilon_1_0_y");
}

TEST(Factors, NamesOfTheFileAndItsSets) {
  const Mechanism m = from_file("rrr3");
  std::vector<std::string> names;
  for (const Factor& factor : m.factors) names.push_back(factor.name);
  EXPECT_EQ(names, (std::vector<std::string>{"l_1", "l_2", "l_3", "pin_x_1", "pin_y_1", "pin_x_2", "pin_y_2", "pin_x_3",
                                             "pin_y_3", "encoder"}));
  EXPECT_EQ(m.factors[0].description, "length of the first link");
  EXPECT_EQ(m.factors[0].axis, "");
  EXPECT_EQ(m.factors[4].axis, "y");
  EXPECT_EQ(m.factors[9].dimension, Dimension::angle);
  EXPECT_EQ(m.terms[9].front().limb, 1u);
  EXPECT_EQ(m.terms[9].front().scale, 0.5);
  ASSERT_EQ(m.sets.size(), 3u);
  EXPECT_EQ(m.sets[1].name, "lengths");
  EXPECT_EQ(m.sets[2].factors.size(), 6u);
  EXPECT_EQ(from_file("tripteron").sets[1].factors.size(), 18u);
}

TEST(Reference, HasEveryKey) {
  const std::string text = tables_reference(mechanism_file_tables());
  for (const char* key : {"`format`", "`[limb.joints]`", "`axis2`", "`pitch`", "`actuated`", "`[platform.workspace]`",
                          "`coordinates`", "`[error]`", "`scale`", "`[sets]`", "`[points]`", "`count`"}) {
    EXPECT_NE(text.find(key), std::string::npos) << key;
  }
}

}  // namespace
}  // namespace poesy::file
