#include "models/file/mobility.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "tests/models/file/files.h"

namespace poesy::file {
namespace {

/// Expected numbers of a mechanism: joints, rank, loop equations, freedoms, over-constraints, freedoms of the platform,
/// rotations of the platform, idle freedoms, and freedoms left when the drives are locked.
struct Row {
  const char* name;
  std::array<std::size_t, 9> numbers;
};

std::array<std::size_t, 9> numbers(const Mobility& m) {
  return {m.joints,           m.rank, m.loop_equations,  m.freedoms, m.over_constraints, m.platform_freedoms,
          m.platform_rotates, m.idle, m.left_when_locked};
}

class Table : public testing::TestWithParam<Row> {};

TEST_P(Table, AtHomeAndInTheWorkspace) {
  const Mechanism mechanism = from_file(GetParam().name);
  const Mobility home = home_mobility(mechanism);
  EXPECT_EQ(numbers(home), GetParam().numbers);
  EXPECT_EQ(home.loose, 0u) << home.loose_text;
  EXPECT_EQ(home.coordinates_rank, mechanism.coordinates.size());
  EXPECT_NO_THROW(check_mobility(mechanism, home));
  const std::vector<PoseMobility> poses = workspace_mobility(mechanism);
  EXPECT_NO_THROW(check_mobility(mechanism, home, poses));
  for (const PoseMobility& pose : poses) {
    ASSERT_EQ(pose.tracked.unreachable, "");
    EXPECT_EQ(numbers(pose.mobility), GetParam().numbers);
    EXPECT_GT(pose.mobility.above_gap(), 1e-3);
    EXPECT_LT(pose.mobility.below_gap().value_or(0.0), 1e-12);
  }
}

INSTANTIATE_TEST_SUITE_P(
    Files, Table,
    testing::Values(Row{"rps3", {15, 12, 12, 3, 0, 3, 2, 0, 0}}, Row{"ups6", {36, 30, 30, 6, 0, 6, 3, 0, 0}},
                    Row{"upr2-rpu", {12, 9, 12, 3, 3, 3, 2, 0, 0}}, Row{"tripteron", {12, 9, 12, 3, 3, 3, 0, 0, 0}},
                    Row{"rrr3", {9, 6, 12, 3, 6, 3, 1, 0, 0}}, Row{"sps6", {42, 30, 30, 12, 0, 6, 3, 6, 6}},
                    Row{"mixed6", {36, 30, 30, 6, 0, 6, 3, 0, 0}}, Row{"press", {5, 4, 12, 1, 8, 1, 0, 0, 0}},
                    Row{"delta6", {42, 30, 30, 9, 0, 3, 0, 6, 6}}, Row{"geared3", {12, 6, 12, 3, 6, 3, 1, 0, 0}}),
    [](const auto& instance) {
      std::string name = instance.param.name;
      std::erase(name, '-');
      return name;
    });

TEST(Mobility, DoesNotDependOnTheUnitOfLength) {
  Mechanism mechanism = from_file("ups6");
  const Mobility metres = home_mobility(mechanism);
  const Mobility other = home_mobility(in_reaches(mechanism));
  for (std::size_t k = 0; k < metres.singular_values.size(); ++k) {
    EXPECT_NEAR(other.singular_values[k], metres.singular_values[k], 1e-13);
  }
}

TEST(Mobility, SaysWhatIsLoose) {
  Mechanism mechanism = from_file("rps3");
  for (Joint& joint : mechanism.limbs[1].joints) joint.actuated = false;
  const Mobility found = home_mobility(mechanism);
  EXPECT_EQ(found.loose, 1u);
  EXPECT_EQ(found.left_when_locked, 1u);
  EXPECT_NE(found.loose_text.find(" of limb "), std::string::npos) << found.loose_text;
  EXPECT_THROW(check_mobility(mechanism, found), InputError);
}

TEST(Mobility, MoreDrivesThanFreedomsAreOverConstraints) {
  Mechanism mechanism = from_file("rrr3");
  EXPECT_EQ(home_mobility(mechanism).passive_rank, 6u);
  mechanism.limbs[0].joints[1].actuated = true;
  const Mobility found = home_mobility(mechanism);
  EXPECT_EQ(found.actuated, 4u);
  EXPECT_EQ(found.passive_rank, 5u);
  EXPECT_NO_THROW(check_mobility(mechanism, found));
}

/// The message of the checks for a mechanism file in which `from` is replaced by `to`. "accepted" if there is none.
std::string problem_of(const std::string& from, const std::string& to, const std::string& name = "rrr3") {
  std::string text = text_of(name);
  text.replace(text.find(from), from.size(), to);
  const MechanismFile file = read_mechanism_file(text, "m.toml");
  const Mechanism made = mechanism(file, default_geometry(file));
  const Mobility home = home_mobility(made);
  try {
    check_mobility(made, home);
    check_mobility(made, home, workspace_mobility(made));
  } catch (const InputError& error) {
    return error.what();
  }
  return "accepted";
}

TEST(Mobility, DrivesMustHoldThePlatform) {
  EXPECT_EQ(
      problem_of("actuated = true }", "actuated = false }"),
      "m.toml:24:3: the drives do not hold the platform, which has 3 freedoms and 0 drives: joint 'C' of limb 1 is "
      "loose, and the platform turns about (0, 0, 1); write actuated = true at one more joint, or correct the axes");
}

TEST(Mobility, ThePlatformMustMove) {
  EXPECT_EQ(problem_of("type = \"P\", at = [\"r\", 0, 0], axis = \"z\"",
                       "type = \"P\", at = [\"r\", 0, 0], axis = \"x\"", "press"),
            "m.toml:12:15: the platform cannot move; look at the axes of the joints at home");
}

TEST(Mobility, SomeJointMustGiveWay) {
  constexpr const char* kTwoRails = R"(
format = "poesy-mechanism"
version = 1
name = "rails"
[platform]
origin = [0, 0, 0]
coordinates = ["y"]
workspace = { y = ["-50 mm", "50 mm"] }
points = [[0, 0, 0], ["1 mm", 0, 0], [0, "1 mm", 0]]
[[limb]]
joints = [ { name = "a", type = "P", at = ["-200 mm", 0, 0], axis = "y", actuated = "motor" } ]
[[limb]]
joints = [ { name = "b", type = "P", at = ["200 mm", 0, 0], axis = "y", actuated = "motor" } ]
)";
  const MechanismFile file = read_mechanism_file(kTwoRails, "m.toml");
  const Mechanism made = mechanism(file, {});
  const Mobility home = home_mobility(made);
  EXPECT_EQ(home.rank, 0u);
  EXPECT_EQ(home.platform_freedoms, 1u);
  EXPECT_THROW(check_mobility(made, home), InputError);
}

/// At this home pose all arms are stretched, which is singular.
TEST(Mobility, HomeMustNotBeSingular) {
  EXPECT_EQ(
      problem_of("\"220 mm\", \"120 mm\", 0", "\"190 mm\", 0, 0"),
      "m.toml:24:3: the drives do not hold the platform, which has 1 freedom and 3 drives: joint 'C' of limb 3 is "
      "loose, and the platform turns about (0, 0, 1); correct the axes, drive another joint, or draw it at a pose "
      "that is not singular");
}

TEST(Mobility, HomeMustBeLikeOtherPoses) {
  const Mechanism mechanism = from_file("rrr3");
  const Mobility home = home_mobility(mechanism);
  std::vector<PoseMobility> poses = workspace_mobility(mechanism, 3);
  EXPECT_NO_THROW(check_mobility(mechanism, home, poses));
  poses[1].mobility.rank += 1;
  EXPECT_THROW(check_mobility(mechanism, home, poses), InputError);
}

/// The axis about which the leg can spin is not the leg's own line. So away from home its drive moves when it spins.
TEST(Mobility, DrivesMustHoldThePlatformElsewhere) {
  const std::string problem = problem_of("at = \"top\"", "at = [\"d / 2\", \"b\", 0]", "odd6");
  EXPECT_TRUE(
      problem.starts_with("m.toml:23:3: the drives do not hold the platform at some poses, which has 6 freedoms "
                          "and 6 drives: joint '"))
      << problem;
}

/// A Delta whose rods have their last two axes in the wrong order, so the platform turns. The axis of this rotation is
/// not a coordinate axis.
TEST(Mobility, TellsTheAngleByWhichThePlatformTurns) {
  std::string text = text_of("linear-delta-drawing");
  const std::string right = R"(axis = ["h", 0, "r - R"], axis2 = "y")";
  ASSERT_NE(text.find(right), std::string::npos);
  text.replace(text.find(right), right.size(), R"(axis = "y", axis2 = ["h", 0, "r - R"])");
  text.erase(text.find("features = ["));
  const MechanismFile file = read_mechanism_file(text, "m.toml");
  const Mechanism made = mechanism(file, default_geometry(file));
  std::size_t turned_about_several = 0;
  for (const PoseMobility& at : workspace_mobility(made)) {
    ASSERT_TRUE(at.reached());
    const auto turn = (at.tracked.platform.R * made.platform.R.transpose()).eval();
    EXPECT_NEAR(at.turned, std::acos(0.5 * (turn.trace() - 1.0)), 1e-7);
    EXPECT_LT(at.moved, 1e-12);
    const double largest =
        std::max({std::abs(at.tracked.pose[3]), std::abs(at.tracked.pose[4]), std::abs(at.tracked.pose[5])});
    if (at.turned > 1.01 * largest) ++turned_about_several;
  }
  EXPECT_GT(turned_about_several, 0u);
}

TEST(Mobility, SomeOfTheWorkspaceMustBeInReach) {
  const std::string problem = problem_of("x = [\"-40 mm\", \"40 mm\"]", "x = [\"400 mm\", \"500 mm\"]");
  EXPECT_TRUE(
      problem.starts_with("m.toml:13:15: no pose that was tried in the workspace is reached from home: the way "
                          "there from home ends after 33.9 %: "))
      << problem;
}

}  // namespace
}  // namespace poesy::file
