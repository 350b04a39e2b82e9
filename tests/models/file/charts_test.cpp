#include "models/file/charts.h"

#include <gtest/gtest.h>

#include <Eigen/SVD>
#include <cmath>
#include <numbers>

#include "tests/models/file/files.h"
#include "tests/models/file/poses.h"

namespace poesy::file {
namespace {

const Chart* find(const std::vector<Chart>& charts, std::string_view name) {
  const auto found = std::ranges::find(charts, name, [](const Chart& chart) { return chart.description().name; });
  return found == charts.end() ? nullptr : &*found;
}

std::vector<std::string> names_of(const Chart& chart) {
  std::vector<std::string> list;
  for (const PoseCoordinate& coordinate : chart.description().coordinates) list.push_back(coordinate.name);
  return list;
}

/// For each coordinate of the chart, the index of its drive's first joint among all moving joints.
std::vector<std::size_t> places_of(const Chart& actuators, const Mechanism& mechanism) {
  const std::vector<Drive> drives = drives_of(mechanism);
  std::vector<std::size_t> list;
  for (const std::string& name : names_of(actuators)) {
    list.push_back(std::ranges::find(drives, name, &Drive::name)->joints.front());
  }
  return list;
}

/// The coordinates of a configuration in the chart.
std::vector<double> in_chart(const Chart& chart, const Mechanism& mechanism, const Tracked& there) {
  std::vector<double> list;
  if (chart.description().name == "actuators") {
    for (const std::size_t place : places_of(chart, mechanism)) list.push_back(there.displacements[place]);
    return list;
  }
  const Vector3 tip = there.platform.R * *mechanism.tool + there.platform.p;
  for (const Coordinate& c : mechanism.coordinates) {
    list.push_back(c.component < 3 ? tip[static_cast<Eigen::Index>(c.component)] : there.pose[c.component]);
  }
  return list;
}

/// The largest difference between two configurations (rad, and lengths divided by the reach). Whole turns of revolute
/// joints do not count, because a screw may have carried neighbouring joints along.
double apart(const Mechanism& mechanism, std::span<const double> a, std::span<const double> b) {
  double largest = 0.0;
  std::size_t k = 0;
  for (const Limb& limb : mechanism.limbs) {
    for (const Joint& joint : limb.joints) {
      if (!joint.moves()) continue;
      const double difference = a[k] - b[k];
      const double one = joint.motion == Motion::revolute    ? std::remainder(difference, 2.0 * std::numbers::pi)
                         : joint.motion == Motion::prismatic ? difference / mechanism.reach
                                                             : difference * joint.pitch / mechanism.reach;
      largest = std::max(largest, std::abs(one));
      ++k;
    }
  }
  return largest;
}

struct Mechanisms {
  const char* name;
  std::size_t poses;
  std::size_t charts;
};

class Charts : public testing::TestWithParam<Mechanisms> {
 protected:
  const Mechanism mechanism_ = from_file(GetParam().name);
  const std::vector<Chart> charts_ = charts_of(mechanism_);
#ifdef NDEBUG
  const std::vector<std::vector<double>> poses_ = random_poses(mechanism_, GetParam().poses);
#else
  const std::vector<std::vector<double>> poses_ = random_poses(mechanism_, 2 + GetParam().poses / 50);
#endif
};

TEST_P(Charts, BringPosesBack) {
  ASSERT_EQ(charts_.size(), GetParam().charts);
  const Tracker tracker(mechanism_);
  for (const std::vector<double>& pose : poses_) {
    const Tracked there = tracker.track(pose);
    ASSERT_EQ(there.unreachable, "");
    for (const Chart& chart : charts_) {
      const Tracked back = chart.track(in_chart(chart, mechanism_, there));
      ASSERT_EQ(back.unreachable, "") << chart.description().name;
      EXPECT_EQ(back.share, 1.0);
      EXPECT_LE(open_by(mechanism_, back), 1e-12);
      EXPECT_LE(apart(mechanism_, back.displacements, there.displacements), 1e-12) << chart.description().name;
      EXPECT_LE((back.platform.p - there.platform.p).norm(), 1e-12 * mechanism_.reach);
      for (std::size_t k = 0; k < 6; ++k) {
        EXPECT_NEAR(back.pose[k], there.pose[k], k < 3 ? 1e-12 * mechanism_.reach : 1e-12);
      }
    }
  }
}

TEST_P(Charts, OrderOfPosesMakesNoDifference) {
  const std::span<const std::vector<double>> poses = std::span(poses_).first(std::min(poses_.size(), 20ul));
  const Tracker tracker(mechanism_);
  const std::vector<Chart> others = charts_of(mechanism_);
  for (std::size_t c = 0; c < charts_.size(); ++c) {
    std::vector<std::vector<double>> given;
    std::vector<PlatformPose> first;
    for (const std::vector<double>& pose : poses) {
      given.push_back(in_chart(charts_[c], mechanism_, tracker.track(pose)));
      first.push_back(charts_[c].track(given.back()).pose);
    }
    for (std::size_t n = poses.size(); n-- > 0;) EXPECT_EQ(others[c].track(given[n]).pose, first[n]);
  }
}

INSTANTIATE_TEST_SUITE_P(
    Files, Charts,
    testing::Values(Mechanisms{"rps3", 500, 2}, Mechanisms{"ups6", 500, 2}, Mechanisms{"upr2-rpu", 500, 2},
                    Mechanisms{"sps6", 100, 2}, Mechanisms{"mixed6", 5, 1}, Mechanisms{"odd6", 10, 1},
                    Mechanisms{"press", 20, 1}, Mechanisms{"3-rps", 500, 2}, Mechanisms{"3-prs", 500, 2},
                    Mechanisms{"2upr-rpu", 500, 2}, Mechanisms{"tripteron", 500, 1}, Mechanisms{"3-rrr", 500, 1},
                    Mechanisms{"6-ups", 500, 1}, Mechanisms{"delta6", 200, 1}, Mechanisms{"geared3", 200, 1}),
    [](const auto& instance) {
      std::string name = instance.param.name;
      std::ranges::replace(name, '-', '_');
      return name;
    });

/// The mechanism of a file with every `from` replaced by `to`.
Mechanism changed(const std::string& name, const std::string& from, const std::string& to) {
  std::string text = text_of(name);
  std::size_t at = text.find(from);
  EXPECT_NE(at, std::string::npos) << from;
  for (; at != std::string::npos; at = text.find(from, at + to.size())) text.replace(at, from.size(), to);
  const MechanismFile file = read_mechanism_file(text, name + ".toml");
  return mechanism(file, default_geometry(file));
}

TEST(ChartsOf, AreThoseThatDetermineThePose) {
  const std::vector<Chart> all = charts_of(from_file("3-rps"));
  ASSERT_EQ(all.size(), 2u);
  EXPECT_EQ(names_of(*find(all, "tip")), (std::vector<std::string>{"rx", "ry", "tip_z"}));
  EXPECT_EQ(names_of(*find(all, "actuators")), (std::vector<std::string>{"q_1_2", "q_2_2", "q_3_2"}));
  EXPECT_EQ(find(all, "tip")->description().advice,
            "take a pose nearer to home, which is at rx = 0 deg, ry = 0 deg, tip_z = 700 mm");
  EXPECT_EQ(find(charts_of(from_file("3-rrr")), "tip"), nullptr) << "there is no tool";
  const Mechanism redundant =
      changed("3-rrr", "at = \"elbow\", axis = \"z\"", "at = \"elbow\", axis = \"z\", actuated = true");
  EXPECT_EQ(find(charts_of(redundant), "actuators"), nullptr);
  EXPECT_EQ(charts_of(changed("3-rrr", "phi =", "q_1_1 =")).size(), 0u) << "the name is taken";
}

/// The chart has one number for each motor. Each carriage is the centre of a sphere with the rod length as radius; the
/// platform is on all three spheres.
TEST(ChartsOf, HaveANumberForEachDrive) {
  const Mechanism mechanism = from_file("delta6");
  const std::vector<Chart> charts = charts_of(mechanism);
  ASSERT_EQ(charts.size(), 1u);
  const PoseChart& motors = charts[0].description();
  EXPECT_EQ(names_of(charts[0]), (std::vector<std::string>{"motor_1", "motor_2", "motor_3"}));
  EXPECT_EQ(motors.coordinates[1].description, "displacement of joint q of limb 2 and joint q of limb 5 from home");
  EXPECT_EQ(motors.coordinates[1].dimension, Dimension::length);
  const std::vector<double> moved{0.03, -0.005, 0.012};
  const Tracked found = charts[0].track(moved);
  ASSERT_EQ(found.unreachable, "");
  const double level = std::sqrt(0.217 * 0.217 - 0.095 * 0.095);
  for (std::size_t k = 0; k < 3; ++k) {
    const double angle = 2.0 * std::numbers::pi / 3.0 * static_cast<double>(k);
    const Vector3 carriage(0.095 * std::cos(angle), 0.095 * std::sin(angle), level + moved[k]);
    EXPECT_NEAR((carriage - found.platform.p).norm(), 0.217, 1e-13);
    EXPECT_NEAR(found.displacements[7 * (k + 3)], moved[k], 1e-15);
  }
}

/// The smallest singular value of the platform's equations of the 3-RRR with locked drives, computed by hand: each
/// point C turns about its elbow B, so its velocity is perpendicular to B C.
double holding(const Mechanism& mechanism, const Tracked& there) {
  Eigen::MatrixXd rows(3, 3);
  std::size_t begin = 0;
  for (std::size_t i = 0; i < 3; ++i) {
    const Limb& limb = mechanism.limbs[i];
    const Vector3 base = limb.joints[0].at_home.p;
    const double turned = there.displacements[begin];
    const Vector3 elbow = lie::rotation<double>(lie::Axis::z, turned).R * (limb.joints[1].at_home.p - base) + base;
    const Vector3 arm =
        there.platform.R * mechanism.platform.R.transpose() * (limb.joints[2].at_home.p - mechanism.platform.p);
    const Vector3 rod = (there.platform.p + arm - elbow).normalized();
    rows.row(static_cast<Eigen::Index>(i)) << rod.x(), rod.y(), rod.dot(Vector3(-arm.y(), arm.x(), 0.0)) / 0.1;
    begin += limb.moving();
  }
  return Eigen::JacobiSVD<Eigen::MatrixXd>(rows).singularValues()[2];
}

/// For each limb of the 3-RRR, on which side of the line from base to platform its elbow is.
std::vector<bool> elbows(const Mechanism& mechanism, const Tracked& there) {
  std::vector<bool> list;
  for (std::size_t i = 0; i < 3; ++i) {
    const std::vector<Joint>& joints = mechanism.limbs[i].joints;
    const Vector3 first = joints[1].at_home.p - joints[0].at_home.p;
    const Vector3 second = joints[2].at_home.p - joints[1].at_home.p;
    const double home = std::atan2(first.cross(second).z(), first.dot(second));
    list.push_back(std::sin(home + there.displacements[3 * i + 1]) > 0.0);
  }
  return list;
}

/// Drive positions far from home. Either the path from home ends where the drives no longer hold the platform, or an
/// elbow has changed sides, or the found pose belongs to these drive positions.
TEST(Actuators, AreRefusedWithTheWayThatTheyGot) {
  const Mechanism mechanism = from_file("rrr3");
  const std::vector<Chart> charts = charts_of(mechanism);
  const Chart& chart = *find(charts, "actuators");
  const Tracker tracker(mechanism);
  const Tracked home = chart.track(std::vector{0.0, 0.0, 0.0});
  std::mt19937_64 engine(5);
  std::uniform_real_distribution<double> drive(-2.5, 2.5);
  std::size_t singular = 0, other_mode = 0, reached = 0;
  for (int n = 0; n < 300; ++n) {
    const std::vector<double> wanted{drive(engine), drive(engine), drive(engine)};
    const Tracked found = chart.track(wanted);
    EXPECT_LE(open_by(mechanism, found), 1e-12);
    for (std::size_t i = 0; i < 3; ++i) EXPECT_NEAR(found.displacements[3 * i], found.share * wanted[i], 1e-15);
    if (found.share < 1.0) {
      ++singular;
      const std::string way = "ends after " + readable_text({100.0 * found.share, Dimension::number}, 3) + " %: ";
      EXPECT_NE(found.unreachable.find(way), std::string::npos) << found.unreachable;
      EXPECT_NE(found.unreachable.find("drives do not hold it"), std::string::npos) << found.unreachable;
      EXPECT_LT(holding(mechanism, found), 0.2 * holding(mechanism, home));
    } else if (found.unreachable.empty()) {
      const Tracked own = tracker.track(coordinates_of(mechanism, found.pose));
      if (!own.unreachable.empty()) continue;
      ++reached;
      EXPECT_EQ(elbows(mechanism, found), elbows(mechanism, home));
      EXPECT_LE(apart(mechanism, own.displacements, found.displacements), 1e-11);
    } else {
      ++other_mode;
      EXPECT_NE(found.unreachable.find("another working mode"), std::string::npos) << found.unreachable;
      EXPECT_NE(elbows(mechanism, found), elbows(mechanism, home));
    }
  }
  EXPECT_GT(singular, 20u);
  EXPECT_GT(other_mode, 5u);
  EXPECT_GT(reached, 5u);
}

/// A crank of 50 mm along x, with a rod from the crank pin to a slider at (150 mm, 40 mm). The tool is the crank pin.
constexpr const char* kCrankSlider = R"(
format = "poesy-mechanism"
version = 1
name = "crank"
title = "crank and slider"
[platform]
origin = ["150 mm", "40 mm", 0]
coordinates = ["x"]
workspace = { x = ["100 mm", "160 mm"] }
tool = ["-100 mm", "-40 mm", 0]
points = [[0, 0, 0], ["10 mm", 0, 0], [0, "10 mm", 0]]
[[limb]]
joints = [ { name = "crank", type = "R", at = [0, 0, 0], axis = "z", actuated = true },
           { name = "pin", type = "R", at = ["50 mm", 0, 0], axis = "z" } ]
[[limb]]
joints = [ { name = "slide", type = "P", at = ["150 mm", "40 mm", 0], axis = "x" },
           { name = "rod", type = "R", at = ["150 mm", "40 mm", 0], axis = "z" } ]
[errors]
frames = "all"
)";

TEST(CrankSlider, IsWhereTheCrankPutsItButNotWhereThePinCannotGo) {
  const MechanismFile file = read_mechanism_file(kCrankSlider, "crank.toml");
  const Mechanism mechanism = poesy::file::mechanism(file, {});
  const std::vector<Chart> charts = charts_of(mechanism);
  ASSERT_EQ(charts.size(), 2u);
  for (const double turned : {-0.4, -0.1, 0.2, 0.9}) {
    const Tracked found = find(charts, "actuators")->track(std::vector{turned});
    // The dead point is at 0.26 rad. Beyond it the slider returns to positions that it already had, in another working
    // mode.
    const bool beyond = found.unreachable.find("another working mode") != std::string::npos;
    EXPECT_EQ(beyond, turned > 0.26);
    ASSERT_EQ(found.unreachable.empty(), !beyond) << found.unreachable;
    const double up = 0.04 - 0.05 * std::sin(turned);
    const double x = 0.05 * std::cos(turned) + std::sqrt(0.1 * 0.1 + 0.04 * 0.04 - up * up);
    EXPECT_NEAR(found.pose[0], x, 1e-14);
    EXPECT_NEAR(found.pose[1], 0.04, 1e-14);
  }
  // At home the pin moves perpendicular to x, so the x of the pin does not determine the motion.
  const Tracked along = find(charts, "tip")->track(std::vector{0.049});
  EXPECT_LT(along.share, 0.01);
  EXPECT_NE(along.unreachable.find("one coordinate depends on the others"), std::string::npos) << along.unreachable;
}

TEST(Actuators, MustBeNumbers) {
  const std::vector<Chart> charts = charts_of(from_file("rps3"));
  const Tracked found = find(charts, "actuators")->track(std::vector{0.0, std::nan(""), 0.0});
  EXPECT_NE(found.unreachable, "");
}

}  // namespace
}  // namespace poesy::file
