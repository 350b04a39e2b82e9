#include "models/file/tracking.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <random>

#include "models/chain/limb.h"
#include "models/file/mobility.h"
#include "tests/models/file/files.h"
#include "tests/models/file/poses.h"

namespace poesy::file {
namespace {

class Everywhere : public testing::TestWithParam<const char*> {
 protected:
  const Mechanism mechanism_ = from_file(GetParam());
  const Tracker tracker_{mechanism_};
};

TEST_P(Everywhere, LoopsAreClosed) {
  for (const std::vector<double>& pose : random_poses(mechanism_, 20)) {
    const Tracked found = tracker_.track(pose);
    ASSERT_EQ(found.unreachable, "");
    EXPECT_EQ(found.share, 1.0);
    EXPECT_LE(open_by(mechanism_, found), kClosed);
    for (std::size_t c = 0; c < pose.size(); ++c) {
      EXPECT_NEAR(found.pose[mechanism_.coordinates[c].component], pose[c], 1e-15);
    }
  }
}

/// At home all displacements are zero up to rounding. A screw with a lead of 5 mm amplifies rounding errors a thousand
/// times.
TEST_P(Everywhere, HomeIsZero) {
  std::vector<double> pose;
  for (const Coordinate& c : mechanism_.coordinates) pose.push_back(home_pose(mechanism_)[c.component]);
  for (const double q : tracker_.track(pose).displacements) EXPECT_NEAR(q, 0.0, 1e-12);
}

TEST_P(Everywhere, OrderOfPosesMakesNoDifference) {
  std::vector<std::vector<double>> poses = random_poses(mechanism_, 6);
  std::vector<std::vector<double>> first;
  for (const auto& pose : poses) first.push_back(tracker_.track(pose).displacements);
  const Tracker other(mechanism_);
  for (std::size_t n = poses.size(); n-- > 0;) EXPECT_EQ(other.track(poses[n]).displacements, first[n]);
}

INSTANTIATE_TEST_SUITE_P(Files, Everywhere,
                         testing::Values("rps3", "ups6", "upr2-rpu", "tripteron", "rrr3", "sps6", "mixed6", "odd6",
                                         "press", "delta6", "geared3"),
                         [](const auto& instance) {
                           std::string name = instance.param;
                           std::erase(name, '-');
                           return name;
                         });

TEST(Tracker, ScrewsTurnByTheirLead) {
  const Mechanism press = from_file("press");
  const Tracked found = Tracker(press).track(std::vector{0.13});
  EXPECT_NEAR(found.displacements[0], 0.03 / 0.004 * 2.0 * std::numbers::pi, 1e-11);
  EXPECT_NEAR(found.displacements[1], -found.displacements[0], 1e-11);
  EXPECT_NEAR(found.displacements[2], 0.03, 1e-14);
  EXPECT_NEAR(found.displacements[3], 0.0, 1e-12);
  EXPECT_NEAR(found.displacements[4], 0.03, 1e-14);
}

/// The height of a carriage is computed by hand from the rod length. Both joints of a carriage have exactly the same
/// displacement, and the platform does not rotate.
TEST(Tracker, JointsOfOneDriveMoveTogether) {
  const Mechanism mechanism = from_file("delta6");
  const Tracker tracker(mechanism);
  const double rod = 0.217;
  const double level = std::sqrt(rod * rod - 0.095 * 0.095);
  for (const std::vector<double>& pose : random_poses(mechanism, 30)) {
    const Tracked found = tracker.track(pose);
    ASSERT_EQ(found.unreachable, "");
    for (std::size_t c = 3; c < 6; ++c) EXPECT_NEAR(found.pose[c], 0.0, 1e-13);
    for (std::size_t k = 0; k < 3; ++k) {
      const double angle = 2.0 * std::numbers::pi / 3.0 * static_cast<double>(k);
      const double across = std::hypot(0.095 * std::cos(angle) - pose[0], 0.095 * std::sin(angle) - pose[1]);
      EXPECT_NEAR(found.displacements[7 * k], pose[2] + std::sqrt(rod * rod - across * across) - level, 1e-13);
      EXPECT_EQ(found.displacements[7 * (k + 3)], found.displacements[7 * k]);
    }
  }
}

/// Two joints of each limb are coupled by a gear, so they are one drive.
TEST(Tracker, JointsOfOneLimbMayHaveOneDrive) {
  const Mechanism mechanism = from_file("geared3");
  const Tracker tracker(mechanism);
  for (const std::vector<double>& pose : random_poses(mechanism, 20)) {
    const Tracked found = tracker.track(pose);
    ASSERT_EQ(found.unreachable, "");
    for (std::size_t i = 0; i < 3; ++i) EXPECT_EQ(found.displacements[4 * i + 1], found.displacements[4 * i]);
  }
}

/// Without the common name, both joints of a carriage are separate drives, and the platform has six freedoms.
TEST(Tracker, JointsWithoutADriveInCommonMoveApart) {
  std::string text = text_of("delta6");
  for (std::size_t at = text.find("\"motor_*\""); at != std::string::npos; at = text.find("\"motor_*\"")) {
    text.replace(at, 9, "true");
  }
  const MechanismFile file = read_mechanism_file(text, "m.toml");
  EXPECT_EQ(home_mobility(mechanism(file, default_geometry(file))).platform_freedoms, 6u);
}

/// The screws are left-handed: the length of a leg grows by -q lead / (2 pi), whatever its orientation.
TEST(Tracker, LegsGrowWithTheirScrews) {
  const Mechanism mechanism = from_file("mixed6");
  const Tracker tracker(mechanism);
  for (const std::vector<double>& pose : random_poses(mechanism, 10)) {
    const Tracked found = tracker.track(pose);
    ASSERT_EQ(found.unreachable, "");
    for (std::size_t i = 0; i < 3; ++i) {
      const std::vector<Joint>& joints = mechanism.limbs[i].joints;
      EXPECT_EQ(joints[0].motion, Motion::fixed);
      EXPECT_EQ(joints[3].motion, Motion::helical);
      const Vector3 top = mechanism.platform.inverse().R * (joints.back().at_home.p - mechanism.platform.p);
      const Vector3 base = joints[1].at_home.p;
      const double home = (joints.back().at_home.p - base).norm();
      const double now = (found.platform.R * top + found.platform.p - base).norm();
      EXPECT_NEAR(now - home, -0.005 / (2.0 * std::numbers::pi) * found.displacements[6 * i + 2], 1e-13);
    }
  }
}

/// The displacements of idle freedoms have the least norm: spinning any leg of the 6-SPS makes the sum of squares
/// larger.
TEST(Tracker, IdleFreedomsTakeTheLeastNorm) {
  const Mechanism mechanism = from_file("sps6");
  const Tracker tracker(mechanism);
  for (const std::vector<double>& pose : random_poses(mechanism, 5)) {
    const Tracked found = tracker.track(pose);
    std::size_t begin = 0;
    for (const Limb& limb : mechanism.limbs) {
      const Eigen::VectorXd q = Eigen::Map<const Eigen::VectorXd>(found.displacements.data() + begin, 7);
      Eigen::Matrix<double, 6, Eigen::Dynamic> columns(6, 7);
      const auto reached = [&](const Eigen::VectorXd& at) { return limb_transform(limb, {at.data(), 7}, &columns); };
      reached(q);
      const Eigen::VectorXd idle = columns.fullPivLu().kernel().col(0).normalized();
      EXPECT_NEAR(q.dot(idle), 0.0, 1e-12);
      for (const double spin : {-0.1, 0.1}) {
        Eigen::VectorXd other = q + spin * idle;
        for (int n = 0; n < 6; ++n) {
          const lie::Screw<double> open = lie::log(found.platform * reached(other).inverse());
          other += columns.completeOrthogonalDecomposition().solve(open);
        }
        EXPECT_GT(other.norm(), q.norm());
      }
      begin += 7;
    }
  }
}

/// Mechanisms with legs that may spin, and with screws. Displacements change smoothly between two poses, so idle
/// freedoms do not depend on the path from home. For mechanisms without idle freedoms, workspace_test.cpp bounds the
/// changes.
class Spinning : public testing::TestWithParam<const char*> {};

TEST_P(Spinning, IsContinuousAlongLines) {
  const Mechanism mechanism = from_file(GetParam());
  const Tracker tracker(mechanism);
  const std::vector<std::vector<double>> ends = random_poses(mechanism, 4);
  constexpr std::size_t kParts = 20;
  for (std::size_t n = 0; n + 1 < ends.size(); ++n) {
    std::vector<std::vector<double>> along;
    for (std::size_t k = 0; k <= kParts; ++k) {
      std::vector<double> pose;
      for (std::size_t c = 0; c < ends[n].size(); ++c) {
        pose.push_back(std::lerp(ends[n][c], ends[n + 1][c], static_cast<double>(k) / kParts));
      }
      along.push_back(tracker.track(pose).displacements);
    }
    for (std::size_t q = 0; q < along[0].size(); ++q) {
      double span = 0.0;
      for (std::size_t k = 1; k <= kParts; ++k) span += std::abs(along[k][q] - along[k - 1][q]);
      for (std::size_t k = 2; k <= kParts; ++k) {
        const double second = along[k][q] - 2.0 * along[k - 1][q] + along[k - 2][q];
        EXPECT_LE(std::abs(second), 0.05 * span + 1e-3) << q;
      }
    }
  }
}

INSTANTIATE_TEST_SUITE_P(Files, Spinning, testing::Values("sps6", "odd6", "mixed6", "press"),
                         [](const auto& instance) { return std::string(instance.param); });

TEST(Tracker, SaysHowFarTheWayWent) {
  const Mechanism mechanism = from_file("rrr3");
  const Tracked found = Tracker(mechanism).track(std::vector{0.3, 0.0, 0.0});
  EXPECT_LT(found.share, 1.0);
  EXPECT_GT(found.share, 0.1);
  EXPECT_NE(found.unreachable.find("the way there from home ends after "), std::string::npos) << found.unreachable;
  EXPECT_NE(found.unreachable.find(" of limb "), std::string::npos) << found.unreachable;
  EXPECT_LE(open_by(mechanism, found), kClosed);
  EXPECT_NE(Tracker(mechanism).track(std::vector{std::nan(""), 0.0, 0.0}).unreachable, "");
}

/// A limb has the same forward kinematics as the corresponding chain::Limb.
TEST(Tracker, LimbsAreThoseOfChains) {
  const Mechanism mechanism = from_file("rps3");
  std::vector<double> q{0.1, 0.02, -0.3, 0.2, 0.4};
  for (const Limb& limb : mechanism.limbs) {
    chain::Limb other{{}, limb.home};
    for (const Joint& joint : limb.joints) {
      other.joints.push_back(
          {joint.motion == Motion::prismatic ? chain::JointType::prismatic : chain::JointType::revolute,
           joint.actuated});
    }
    const Transform one = limb_transform(limb, q);
    const Transform two = chain::forward_kinematics<double>(other, other.home, q, [](std::size_t, const auto&) {});
    EXPECT_LE((one.R - two.R).norm() + (one.p - two.p).norm(), 1e-15);
  }
}

/// The columns of limb_transform() and platform_columns() are derivatives of the transforms.
TEST(Tracker, ColumnsAreDerivatives) {
  const Mechanism mechanism = from_file("mixed6");
  constexpr double kStep = 1e-6;
  std::mt19937_64 engine(3);
  std::uniform_real_distribution<double> share(-0.3, 0.3);
  for (const Limb& limb : mechanism.limbs) {
    std::vector<double> q(limb.moving());
    for (double& value : q) value = share(engine);
    Eigen::Matrix<double, 6, Eigen::Dynamic> columns(6, static_cast<Eigen::Index>(q.size()));
    limb_transform(limb, q, &columns);
    for (std::size_t k = 0; k < q.size(); ++k) {
      std::vector<double> more = q, less = q;
      more[k] += kStep;
      less[k] -= kStep;
      const lie::Screw<double> rate =
          lie::log(limb_transform(limb, more) * limb_transform(limb, less).inverse()) / (2.0 * kStep);
      EXPECT_LE((rate - columns.col(static_cast<Eigen::Index>(k))).norm(), 1e-9);
    }
  }
  for (const Rotation rotation : {Rotation::vector, Rotation::xyz, Rotation::zxy, Rotation::zyx}) {
    Mechanism turned = mechanism;
    turned.rotation = rotation;
    const PlatformPose pose{0.1, 0.2, 0.3, 0.4, -0.5, 0.6};
    const lie::Matrix6<double> columns = platform_columns(turned, pose);
    for (std::size_t k = 0; k < 6; ++k) {
      PlatformPose more = pose, less = pose;
      more[k] += kStep;
      less[k] -= kStep;
      const lie::Screw<double> rate =
          lie::log(platform_transform(turned, more) * platform_transform(turned, less).inverse()) / (2.0 * kStep);
      EXPECT_LE((rate - columns.col(static_cast<Eigen::Index>(k))).norm(), 1e-9);
    }
  }
}

}  // namespace
}  // namespace poesy::file
