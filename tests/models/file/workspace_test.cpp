#include <gtest/gtest.h>

#include <Eigen/QR>
#include <cmath>
#include <future>
#include <numbers>

#include "tests/models/file/files.h"
#include "tests/models/file/poses.h"

/// Tests tracking over the whole workspace of mechanisms: all loops close, each pose has one solution, and the working
/// mode stays the same.
namespace poesy::file {
namespace {

using Vector = Eigen::VectorXd;
using Columns = Eigen::Matrix<double, 6, Eigen::Dynamic>;

/// How many poses and lines are tested. A build without optimisation tests fewer.
struct Effort {
  const char* name;
  std::size_t poses;
  std::size_t lines;
  std::size_t steps;  ///< steps of each line

#ifndef NDEBUG
  static constexpr std::size_t kLess = 100;
#else
  static constexpr std::size_t kLess = 1;
#endif
};

std::vector<Tracked> track_all(const Mechanism& mechanism, std::span<const std::vector<double>> poses, bool backwards) {
  const Tracker tracker(mechanism);
  std::vector<Tracked> found(poses.size());
  for (std::size_t n = 0; n < poses.size(); ++n) {
    const std::size_t m = backwards ? poses.size() - 1 - n : n;
    found[m] = tracker.track(poses[m]);
  }
  return found;
}

/// The joint displacements (rad, or lengths in units of the reach). The functions below use these units.
Vector displacements(const Mechanism& mechanism, const Tracked& tracked) {
  const std::vector<double> list = scaled_displacements(mechanism, tracked.displacements, 1.0 / mechanism.reach);
  return Eigen::Map<const Vector>(list.data(), std::ssize(list));
}

/// [moving joints] The velocities of all joints if the pose coordinates have the velocities `coordinates`. Solves J_i
/// dq_i = C dpose for all limbs; components of the pose that are not coordinates are unknown too.
Vector velocity(const Mechanism& mechanism, const Tracked& there, std::span<const double> coordinates) {
  const Mechanism unit = in_reaches(mechanism);
  const Vector q = displacements(mechanism, there);
  PlatformPose pose = there.pose;
  for (std::size_t k = 0; k < 3; ++k) pose[k] /= mechanism.reach;
  const lie::Matrix6<double> by_pose = platform_columns(unit, pose);
  lie::Matrix6<double> free = by_pose;
  lie::Screw<double> twist = lie::Screw<double>::Zero();
  for (std::size_t c = 0; c < coordinates.size(); ++c) {
    const std::size_t k = unit.coordinates[c].component;
    const auto column = static_cast<Eigen::Index>(k);
    twist += by_pose.col(column) * (k < 3 ? coordinates[c] / mechanism.reach : coordinates[c]);
    free.col(column).setZero();
  }
  Eigen::MatrixXd matrix = Eigen::MatrixXd::Zero(6 * std::ssize(unit.limbs), q.size() + 6);
  Vector wanted(matrix.rows());
  Eigen::Index row = 0, begin = 0;
  for (const Limb& limb : unit.limbs) {
    Columns columns(6, static_cast<Eigen::Index>(limb.moving()));
    limb_transform(limb, {q.data() + begin, limb.moving()}, &columns);
    matrix.block(row, begin, 6, columns.cols()) = columns;
    matrix.block<6, 6>(row, q.size()) = -free;
    wanted.segment<6>(row) = twist;
    begin += columns.cols();
    row += 6;
  }
  Eigen::CompleteOrthogonalDecomposition<Eigen::MatrixXd> solver;
  solver.setThreshold(1e-9);
  const Vector rates = solver.compute(matrix).solve(wanted);
  EXPECT_LE((matrix * rates - wanted).lpNorm<Eigen::Infinity>(), 1e-9 * (1.0 + wanted.lpNorm<Eigen::Infinity>()));
  EXPECT_EQ(solver.rank(), matrix.cols() - std::ssize(coordinates)) << "idle freedoms have no velocity";
  return rates.head(q.size());
}

/// The smallest distance from the configuration of limb 1 to its other inverse-kinematics solutions, found by Newton's
/// method from random starts. Whole turns do not count.
double nearest_other_root(const Mechanism& mechanism, const Tracked& there) {
  const Mechanism unit = in_reaches(mechanism);
  const Limb& limb = unit.limbs.front();
  const auto joints = static_cast<Eigen::Index>(limb.moving());
  const Vector own = displacements(mechanism, there).head(joints);
  Transform platform = there.platform;
  platform.p /= mechanism.reach;
  std::vector<bool> turns;
  for (const Joint& joint : limb.joints) {
    if (joint.moves()) turns.push_back(joint.motion == Motion::revolute);
  }
  std::mt19937_64 engine(11);
  std::uniform_real_distribution<double> anywhere(-std::numbers::pi, std::numbers::pi);
  double nearest = HUGE_VAL;
  for (int start = 0; start < 60; ++start) {
    Vector q(joints);
    for (double& value : q) value = anywhere(engine);
    Columns columns(6, joints);
    lie::Screw<double> open;
    for (int n = 0; n < 40; ++n) {
      open = lie::log(platform * limb_transform(limb, {q.data(), limb.moving()}, &columns).inverse());
      Vector change = columns.completeOrthogonalDecomposition().solve(open);
      if (change.norm() > 0.5) change *= 0.5 / change.norm();
      q += change;
    }
    if (!(open.norm() < 1e-10)) continue;
    double distance = 0.0;
    for (Eigen::Index k = 0; k < joints; ++k) {
      const double difference = q[k] - own[k];
      const bool turn = turns[static_cast<std::size_t>(k)];
      distance = std::max(distance, std::abs(turn ? std::remainder(difference, 2.0 * std::numbers::pi) : difference));
    }
    if (distance > 1e-6) nearest = std::min(nearest, distance);
  }
  return nearest;
}

class Workspace : public testing::TestWithParam<Effort> {
 protected:
  const Mechanism mechanism_ = from_file(GetParam().name);
};

TEST_P(Workspace, ClosesLoopsWhateverTheOrder) {
  const std::vector<std::vector<double>> poses = random_poses(mechanism_, GetParam().poses / Effort::kLess + 2);
  auto backwards = std::async(std::launch::async, [&] { return track_all(mechanism_, poses, true); });
  const std::vector<Tracked> found = track_all(mechanism_, poses, false);
  const std::vector<Tracked> again = backwards.get();
  for (std::size_t m = 0; m < poses.size(); ++m) {
    ASSERT_EQ(found[m].unreachable, "") << m;
    ASSERT_LE(open_by(mechanism_, found[m]), 1e-12) << m;
    for (std::size_t c = 0; c < poses[m].size(); ++c) {
      ASSERT_NEAR(found[m].pose[mechanism_.coordinates[c].component], poses[m][c], 1e-15);
    }
    ASSERT_EQ(found[m].displacements, again[m].displacements) << m;
    ASSERT_EQ(found[m].pose, again[m].pose) << m;
  }
}

/// The Jacobian gives the joint velocities at both ends of a step. In a step no joint may move by more than the larger
/// of both velocities plus their difference allows. A jump to another working mode would be larger.
TEST_P(Workspace, StaysInTheWorkingModeAlongLines) {
  const Tracker tracker(mechanism_);
  const std::size_t lines = GetParam().lines / Effort::kLess + 1;
  const std::size_t steps = GetParam().steps;
  const std::vector<std::vector<double>> ends = random_poses(mechanism_, 2 * lines, 1.0, 23);
  const double h = 1.0 / static_cast<double>(steps);
  double largest = 0.0;
  double nearest = HUGE_VAL;
  for (std::size_t n = 0; n < lines; ++n) {
    const std::vector<double>& from = ends[2 * n];
    const std::vector<double>& to = ends[2 * n + 1];
    std::vector<double> rates, at(from.size());
    for (std::size_t c = 0; c < from.size(); ++c) rates.push_back(to[c] - from[c]);
    Vector q, v;
    for (std::size_t k = 0; k <= steps; ++k) {
      for (std::size_t c = 0; c < at.size(); ++c) at[c] = std::lerp(from[c], to[c], h * static_cast<double>(k));
      const Tracked there = tracker.track(at);
      ASSERT_EQ(there.unreachable, "") << n << ' ' << k;
      const Vector q_now = displacements(mechanism_, there);
      const Vector v_now = velocity(mechanism_, there, rates);
      if (k == 0 && n % 20 == 0) nearest = std::min(nearest, nearest_other_root(mechanism_, there));
      if (k > 0) {
        const double changes = (v_now - v).lpNorm<Eigen::Infinity>();
        const Vector bound = (h * (v.cwiseAbs().cwiseMax(v_now.cwiseAbs()).array() + changes)).matrix();
        largest = std::max(largest, bound.maxCoeff());
        const Vector excess = (q_now - q).cwiseAbs() - bound;
        ASSERT_LE(excess.maxCoeff(), 1e-11) << "line " << n << ", step " << k;
      }
      q = q_now;
      v = v_now;
    }
  }
  EXPECT_LT(nearest, HUGE_VAL);
  EXPECT_LT(10.0 * largest, nearest) << "a jump would not be seen";
  RecordProperty("bound", std::to_string(largest));
  RecordProperty("other", std::to_string(nearest));
}

INSTANTIATE_TEST_SUITE_P(Files, Workspace,
                         testing::Values(Effort{"rps3", 10'000, 100, 40}, Effort{"ups6", 10'000, 100, 40},
                                         Effort{"upr2-rpu", 10'000, 100, 40}, Effort{"3-prs", 10'000, 100, 40},
                                         Effort{"rrr3", 10'000, 100, 40}, Effort{"tripteron", 10'000, 100, 40}),
                         [](const auto& instance) {
                           std::string name = instance.param.name;
                           std::erase(name, '-');
                           return name;
                         });

constexpr double kPart = 1.0 / 4096;

/// The share of the path from home to `wanted`, in steps of kPart, at which a limb first cannot reach; more than 1 if
/// all limbs reach everywhere. Computed from the two links of each limb, which has three parallel hinges.
double first_out_of_reach(const Mechanism& mechanism, std::span<const double> wanted) {
  const auto in_reach = [&](double share) {
    PlatformPose pose = home_pose(mechanism);
    for (std::size_t c = 0; c < wanted.size(); ++c) {
      double& value = pose[mechanism.coordinates[c].component];
      value += share * (wanted[c] - value);
    }
    const Transform motion = platform_transform(mechanism, pose) * mechanism.platform.inverse();
    return std::ranges::all_of(mechanism.limbs, [&](const Limb& limb) {
      std::vector<Transform> hinges;
      for (const Joint& joint : limb.joints) {
        if (joint.motion == Motion::revolute) hinges.push_back(joint.at_home);
      }
      const Vector3 axis = hinges.at(0).R.col(2);
      const auto apart = [&](const Vector3& a, const Vector3& b) { return axis.cross(b - a).norm(); };
      const double first = apart(hinges.at(0).p, hinges.at(1).p), second = apart(hinges.at(1).p, hinges.at(2).p);
      const double now = apart(hinges.at(0).p, motion.R * hinges.at(2).p + motion.p);
      return now <= first + second && now >= std::abs(first - second);
    });
  };
  double share = kPart;
  while (share <= 1.0 && in_reach(share)) share += kPart;
  return share;
}

class OutOfReach : public testing::TestWithParam<const char*> {};

TEST_P(OutOfReach, IsRefusedWithTheWayThatItGot) {
  const Mechanism mechanism = from_file(GetParam());
  const Tracker tracker(mechanism);
  std::size_t refused = 0;
  const std::vector<std::vector<double>> poses = random_poses(mechanism, 300 / Effort::kLess + 20, 6.0);
  for (const std::vector<double>& pose : poses) {
    const Tracked found = tracker.track(pose);
    const double out = first_out_of_reach(mechanism, pose);
    EXPECT_LT(found.share, out);
    EXPECT_GE(found.share, std::min(out - 0.004, 1.0));
    EXPECT_EQ(found.unreachable.empty(), out > 1.0) << found.unreachable;
    EXPECT_LE(open_by(mechanism, found), 1e-12);
    const PlatformPose home = home_pose(mechanism);
    for (std::size_t c = 0; c < pose.size(); ++c) {
      const std::size_t k = mechanism.coordinates[c].component;
      EXPECT_NEAR(found.pose[k], std::lerp(home[k], pose[c], found.share), 1e-15);
    }
    if (found.unreachable.empty()) continue;
    ++refused;
    const std::string way = "ends after " + readable_text({100.0 * found.share, Dimension::number}, 3) + " %";
    EXPECT_NE(found.unreachable.find(way), std::string::npos) << found.unreachable;
  }
  EXPECT_GT(refused, poses.size() / 10);
  EXPECT_LT(refused, poses.size());
}

INSTANTIATE_TEST_SUITE_P(Files, OutOfReach, testing::Values("rrr3", "tripteron"),
                         [](const auto& instance) { return std::string(instance.param); });

}  // namespace
}  // namespace poesy::file
