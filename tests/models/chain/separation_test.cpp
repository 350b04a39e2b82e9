#include "models/chain/separation.h"

#include <gtest/gtest.h>

#include <Eigen/QR>
#include <algorithm>
#include <cmath>

#include "tests/models/chain/closed_chain.h"

namespace poesy::chain {
namespace {

using Vector3 = lie::Vector3<double>;
using Screw = lie::Screw<double>;

struct Example {
  std::vector<double> q;
  DeformationModel model;
};

/// A random chain with points on its platform. All six errors of each frame are errors of the model.
Example example(const std::vector<std::size_t>& joints, std::mt19937_64& engine) {
  std::size_t all = 0;
  for (const std::size_t n : joints) all += n;
  Example one{random_displacements(all, 0.4, engine), {}};
  one.model.chain = closed_chain(joints, PassiveJoints::mixed, one.q, engine);
  for (std::size_t i = 0; i < joints.size(); ++i) {
    for (std::size_t frame = 0; frame <= joints[i]; ++frame) {
      for (std::size_t c = 0; c < 6; ++c) one.model.terms.push_back({{i, frame, c}});
    }
  }
  one.model.terms.back().front().scale = -2.0;
  one.model.platform = PlatformReport{{}, {{0.2, 0.0, 0.0}, {-0.1, 0.2, 0.0}, {0.0, -0.1, 0.1}, {0.1, 0.1, -0.2}}};
  return one;
}

/// The separation of the example at its joint displacements.
Separation separate(Example& one) {
  one.model.joint_displacements = [&one](std::span<const double>) { return one.q; };
  return separation(one.model, {});
}

const std::vector<std::vector<std::size_t>> kShapes{{4, 4}, {4, 4, 4}, {5, 5, 5}, {5, 5, 5, 5}, {6, 5, 4}};

/// [3 points x errors] The displacements of the platform's points per unit of each error, divided by the square root of
/// the number of points. Computed by the first-order kernel.
Eigen::MatrixXd displacements_of(const Example& one) {
  const std::size_t factors = one.model.terms.size();
  constexpr std::size_t before = 3;  // number of responses before those of the platform
  std::vector<FactorIndex> varied;
  for (std::size_t f = 0; f < factors; ++f) varied.emplace_back(f);
  const Eigen::MatrixXd units =
      Eigen::MatrixXd::Identity(static_cast<Eigen::Index>(factors), static_cast<Eigen::Index>(factors));
  std::vector<double> responses((before + 8) * factors);
  std::vector<SolveStatus> status(factors);
  std::vector<std::uint32_t> iterations(factors);
  const std::vector<double> zeros(factors, 0.0);
  deformation_evaluator(one.model, {}, Fidelity::first_order)
      ->evaluate({{}, zeros, varied, {units.data(), factors * factors}, factors}, {responses, status, iterations, {}});
  const lie::Transform<double> platform = one.model.platform_points(one.q)->platform;
  const std::vector<Vector3>& points = one.model.platform->points;
  const auto rows = 3 * static_cast<Eigen::Index>(points.size());
  Eigen::MatrixXd displacements(rows, static_cast<Eigen::Index>(factors));
  for (std::size_t f = 0; f < factors; ++f) {
    EXPECT_TRUE(solved(status[f]));
    const auto response = [&](std::size_t r) { return responses[(before + r) * factors + f]; };
    const Vector3 moved(response(0), response(1), response(2)), theta(response(3), response(4), response(5));
    for (Eigen::Index row = 0; row < rows; row += 3) {
      const Vector3 arm = platform.R * points[static_cast<std::size_t>(row / 3)];
      displacements.col(static_cast<Eigen::Index>(f)).segment<3>(row) = moved + theta.cross(arm);
    }
  }
  return displacements / std::sqrt(static_cast<double>(points.size()));
}

/// For each drive, the error with the same effect: the error along or about the drive's axis of the frame after it.
std::vector<Eigen::Index> drives_of(const DeformationModel& model) {
  std::vector<Eigen::Index> list;
  for (std::size_t f = 0; f < model.terms.size(); ++f) {
    const ErrorTerm& term = model.terms[f].front();
    if (term.frame == 0) continue;
    const Joint& joint = model.chain.limbs[term.limb].joints[term.frame - 1];
    const std::size_t axis = joint.type == JointType::prismatic ? 5 : 2;
    if (joint.actuated && !joint.fixed && term.component == axis) list.push_back(static_cast<Eigen::Index>(f));
  }
  return list;
}

void expect_least_squares(Example& one) {
  const Separation found = separate(one);
  const Eigen::MatrixXd effects = displacements_of(one);
  const Eigen::MatrixXd drives = effects(Eigen::all, drives_of(one.model));
  const Eigen::MatrixXd left = effects - drives * drives.completeOrthogonalDecomposition().solve(effects);
  for (Eigen::Index f = 0; f < effects.cols(); ++f) {
    const auto at = static_cast<std::size_t>(f);
    const double effect = effects.col(f).norm();
    EXPECT_NEAR(found.effect[at], effect, 1e-9 * (1.0 + effect)) << f;
    EXPECT_NEAR(found.residual[at], left.col(f).norm(), 1e-9 * (1.0 + effect)) << f;
    EXPECT_LE(found.effect[at], (found.drive[at] + found.constraint[at]) * (1.0 + 1e-12)) << f;
    EXPECT_LE(found.residual[at], found.effect[at] * (1.0 + 1e-9)) << f;
    EXPECT_LE(found.residual[at], found.constraint[at] * (1.0 + 1e-12)) << f;
  }
}

TEST(ChainSeparation, ResidualIsWhatNoCorrectionTakesAway) {
  std::mt19937_64 engine(41);
  for (const std::vector<std::size_t>& shape : kShapes) {
    Example one = example(shape, engine);
    expect_least_squares(one);
  }
}

/// The twist of a limb's platform per unit of a parameter, by finite differences. pose_at: the platform pose as a
/// function of the parameter.
template <class PoseAt>
Screw twist_by(PoseAt&& pose_at) {
  constexpr double kStep = 1e-5;
  return lie::log<double>(pose_at(kStep) * pose_at(-kStep).inverse()) / (2.0 * kStep);
}

/// A limb of an example. Twists of its platform are weighted: the rotation times the radius of the platform's points,
/// and the translation of the limb's last joint.
struct OwnLimb {
  const Limb& limb;
  std::span<const double> q;
  Vector3 end;
  double radius;

  OwnLimb(const Example& one, std::size_t i) : limb(one.model.chain.limbs[i]) {
    std::size_t first = 0;
    for (std::size_t k = 0; k < i; ++k) first += one.model.chain.limbs[k].joints.size();
    q = std::span(one.q).subspan(first, limb.joints.size());
    Limb to_last = limb;
    to_last.joints.pop_back();
    to_last.home.pop_back();
    end = platform_pose(to_last, to_last.home, q.first(q.size() - 1)).p;
    const std::vector<Vector3>& points = one.model.platform->points;
    Vector3 middle = Vector3::Zero();
    for (const Vector3& point : points) middle += point / static_cast<double>(points.size());
    double sum = 0.0;
    for (const Vector3& point : points) sum += (point - middle).squaredNorm() / static_cast<double>(points.size());
    radius = std::sqrt(sum);
  }

  Screw weighed(const Screw& xi) const {
    Screw weighed;
    weighed << radius * xi.head<3>(), xi.tail<3>() + xi.head<3>().cross(end);
    return weighed;
  }

  Screw by_error(const ErrorTerm& term) const {
    return weighed(term.scale * twist_by([&](double step) {
                     std::vector<lie::Transform<double>> frames = limb.home;
                     FrameError<double> error = FrameError<double>::Zero();
                     error[static_cast<Eigen::Index>(term.component)] = step;
                     frames[term.frame] = frame_with_error(limb, term.frame, error);
                     return platform_pose(limb, frames, q);
                   }));
  }

  /// [6 x joints] The weighted twists per unit displacement of each joint.
  Eigen::MatrixXd by_joints() const {
    Eigen::MatrixXd columns(6, static_cast<Eigen::Index>(q.size()));
    for (std::size_t j = 0; j < q.size(); ++j) {
      columns.col(static_cast<Eigen::Index>(j)) = weighed(twist_by([&](double step) {
        std::vector<double> moved(q.begin(), q.end());
        moved[j] += step;
        return platform_pose(limb, limb.home, moved);
      }));
    }
    return columns;
  }
};

TEST(ChainSeparation, DrivePartIsInTheNearestMotionOfTheLimbsOwnJoints) {
  std::mt19937_64 engine(47);
  for (const std::vector<std::size_t>& shape : kShapes) {
    Example one = example(shape, engine);
    const Separation found = separate(one);
    const Eigen::MatrixXd effects = displacements_of(one);
    const std::vector<Eigen::Index> drives = drives_of(one.model);
    for (std::size_t f = 0; f < one.model.terms.size(); ++f) {
      const ErrorTerm& term = one.model.terms[f].front();
      const OwnLimb own(one, term.limb);
      const Eigen::VectorXd by =
          own.by_joints().completeOrthogonalDecomposition().solve(Eigen::VectorXd(own.by_error(term)));
      const auto drive = std::ranges::find(own.limb.joints, true, &Joint::actuated) - own.limb.joints.begin();
      const Eigen::VectorXd by_drive = by[drive] * effects.col(drives[term.limb]);
      const Eigen::VectorXd effect = effects.col(static_cast<Eigen::Index>(f));
      const double tolerance = 1e-6 * (1.0 + effect.norm() + by_drive.norm());
      EXPECT_NEAR(found.drive[f], by_drive.norm(), tolerance) << f;
      EXPECT_NEAR(found.constraint[f], (effect - by_drive).norm(), tolerance) << f;
    }
  }
}

/// A fixed drive cannot correct anything.
TEST(ChainSeparation, FixedFramesCorrectNothing) {
  std::mt19937_64 engine(42);
  Example one = example({5, 5, 5}, engine);
  const std::size_t drive = static_cast<std::size_t>(drives_of(one.model)[1]);
  EXPECT_EQ(separate(one).residual[drive], 0.0);
  for (Joint& joint : one.model.chain.limbs[1].joints) joint.fixed = joint.actuated;
  ASSERT_EQ(drives_of(one.model).size(), 2u);
  expect_least_squares(one);
  const Separation found = separate(one);
  EXPECT_GT(found.residual[drive], 0.0);
  EXPECT_EQ(found.drive[drive], 0.0);
  for (Limb& limb : one.model.chain.limbs) {
    for (Joint& joint : limb.joints) joint.fixed = joint.actuated;
  }
  const Separation without = separate(one);
  EXPECT_EQ(without.residual, without.effect);
  EXPECT_EQ(without.constraint, without.effect);
}

TEST(ChainSeparation, SingularPoseIsOpen) {
  std::mt19937_64 engine(45);
  Example one = example({5, 5, 5}, engine);
  Limb& limb = one.model.chain.limbs[2];
  limb.joints[3] = limb.joints[4] = {JointType::prismatic, false};
  limb.home[4] = {};  // both joints slide along the same line
  const Separation found = separate(one);
  for (const auto part : {&Separation::drive, &Separation::constraint, &Separation::effect, &Separation::residual}) {
    ASSERT_EQ((found.*part).size(), one.model.terms.size());
    EXPECT_TRUE(std::ranges::all_of(found.*part, [](double value) { return std::isnan(value); }));
  }
}

TEST(ChainSeparation, IsOnlyWhereThePlatformIsMeasured) {
  std::mt19937_64 engine(46);
  Example one = example({4, 4, 4}, engine);
  ASSERT_TRUE(separation_description(one.model));
  EXPECT_EQ(separation_description(one.model)->measure,
            "root mean square displacement of the platform's points, without the gap between its limbs");
  one.model.platform->points.clear();
  EXPECT_FALSE(separation_description(one.model));
  one.model.platform.reset();
  EXPECT_FALSE(separation_description(one.model));
}

}  // namespace
}  // namespace poesy::chain
