#include "models/three_prs/error_mapping.h"

#include <gtest/gtest.h>

#include <Eigen/LU>
#include <algorithm>
#include <cmath>

#include "tests/models/three_prs/reference.h"

namespace poesy::three_prs {
namespace {

using Twist = Eigen::Matrix<double, 6, 1>;

Configuration nominal_at(const std::vector<double>& pose) { return configuration({}, {pose[0], pose[1], pose[2]}); }

/// The root mean square displacement of the spherical joints (m) by its definition, also for finite rotations.
double joint_displacement(const Configuration& nominal, const lie::Vector3<double>& theta,
                          const lie::Vector3<double>& dr) {
  double sum = 0.0;
  for (const LimbConfiguration& limb : nominal.limbs) {
    sum += (dr + lie::exp<double>(theta) * limb.c - limb.c).squaredNorm();
  }
  return std::sqrt(sum / 3.0);
}

double measure(const Configuration& nominal, const Twist& twist) {
  double sum = 0.0;
  for (const LimbConfiguration& limb : nominal.limbs) {
    sum += (twist.tail<3>() + twist.head<3>().cross(limb.c)).squaredNorm();
  }
  return std::sqrt(sum / 3.0);
}

/// The joint_displacement() (m) of the exact mechanism with these errors.
double exact_displacement(const Model& exact, const std::vector<double>& pose, const std::vector<double>& errors) {
  const Solved found = solve(exact, pose, errors);
  EXPECT_TRUE(solved(found.status));
  return joint_displacement(nominal_at(pose), Eigen::Vector3d(found.responses.data()),
                            Eigen::Vector3d(found.responses.data() + 3));
}

/// The smallest displacement (m) of the exact mechanism over all corrections of its carriages, which are changes of the
/// q errors. The squared displacement is a parabola in each correction; the corrections are moved to its vertex in turn
/// until they converge.
double smallest_displacement(const Model& exact, const std::vector<double>& pose, std::vector<double> errors,
                             double step) {
  const auto square = [&] { return std::pow(exact_displacement(exact, pose, errors), 2); };
  for (int sweep = 0; sweep < 300; ++sweep) {
    double moved = 0.0;
    for (std::size_t limb = 0; limb < kLimbs; ++limb) {
      double& dq = errors[factor_of(limb, Source::q)];
      const double start = dq;
      const double here = square();
      dq = start + step;
      const double above = square();
      dq = start - step;
      const double below = square();
      dq = start - 0.5 * step * (above - below) / (above - 2.0 * here + below);
      moved = std::max(moved, std::abs(dq - start));
    }
    if (moved < 1e-4 * step) break;
  }
  return std::sqrt(square());
}

TEST(Separation, ResidualIsWhatNoCorrectionRemoves) {
  const auto exact = published("exact");
  constexpr double kStep = 1e-6;
  for (const std::vector<double>& pose : random_poses(3, 11)) {
    const Separation found = separation({}, nominal_at(pose));
    for (std::size_t f = 0; f < kSources; ++f) {
      std::vector<double> errors(kFactors, 0.0);
      errors[f] = kStep;
      const double effect = exact_displacement(*exact, pose, errors) / kStep;
      EXPECT_NEAR(found.effect[f], effect, 1e-5);
      if (f == factor_of(0, Source::q)) continue;  // this error is itself a correction
      EXPECT_NEAR(found.residual[f], smallest_displacement(*exact, pose, errors, kStep) / kStep, 1e-4) << f;
    }
  }
}

TEST(Separation, PartsAddToTheEffect) {
  for (const std::vector<double>& pose : random_poses(20, 12)) {
    const Configuration nominal = nominal_at(pose);
    const Separation found = separation({}, nominal);
    const auto inverse = velocity_jacobian(nominal).inverse().eval();
    const ErrorMapping G = error_mapping({}, nominal);
    const Effects effects = first_order_effects({}, nominal);
    for (std::size_t f = 0; f < kFactors; ++f) {
      const auto column = static_cast<Eigen::Index>(f);
      Twist drive_rows = G.col(column), constraint_rows = G.col(column);
      drive_rows.tail<3>().setZero();
      constraint_rows.head<3>().setZero();
      const Twist drive = inverse * drive_rows;
      const Twist constraint = inverse * constraint_rows;
      const Twist effect = effects.col(column).head<6>();
      EXPECT_LE((drive + constraint - effect).norm(), 1e-13 * (1.0 + effect.norm()));
      EXPECT_NEAR(found.drive[f], measure(nominal, drive), 1e-12);
      EXPECT_NEAR(found.constraint[f], measure(nominal, constraint), 1e-12);
      EXPECT_NEAR(found.effect[f], measure(nominal, effect), 1e-12);
    }
  }
}

TEST(Separation, PureSourcesAreExact) {
  for (const std::vector<double>& pose : random_poses(20, 13)) {
    const Separation found = separation({}, nominal_at(pose));
    const std::vector<std::string> classes = separation_description().published;
    for (std::size_t f = 0; f < kFactors; ++f) {
      const bool is_c = f % kSources >= static_cast<std::size_t>(Source::c);
      if (classes[f].empty()) {
        EXPECT_EQ(found.effect[f], 0.0);
      } else if (classes[f] == "non-compensable") {
        EXPECT_EQ(found.drive[f], 0.0);
        EXPECT_EQ(found.constraint[f], found.effect[f]);
        EXPECT_GT(found.residual[f], 0.0);
        EXPECT_LE(found.residual[f], found.effect[f] * (1.0 + 1e-14));
      } else if (!is_c) {
        EXPECT_EQ(found.constraint[f], 0.0);
        EXPECT_EQ(found.drive[f], found.effect[f]);
        EXPECT_EQ(found.residual[f], 0.0);
      } else {
        EXPECT_GT(found.drive[f], 0.0);
        EXPECT_GT(found.constraint[f], 0.0);
        EXPECT_GT(found.residual[f], 0.0);
        EXPECT_LT(found.residual[f], found.effect[f]);
      }
    }
  }
}

TEST(Separation, LimbsAreAlikeWherePlatformIsLevel) {
  const Separation found = separation({}, nominal_at({0.0, 0.0, 0.8}));
  for (const std::vector<double>* values : {&found.drive, &found.constraint, &found.effect, &found.residual}) {
    for (std::size_t f = 0; f < kSources; ++f) {
      for (std::size_t limb = 1; limb < kLimbs; ++limb) {
        EXPECT_NEAR((*values)[limb * kSources + f], (*values)[f], 1e-13 * (1.0 + (*values)[f]));
      }
    }
  }
}

TEST(Separation, IsWhatTheModelGives) {
  const std::vector<double> pose{0.1, -0.2, 0.7};
  const auto model = published("first-order");
  EXPECT_EQ(model->separation(pose).residual, separation({}, nominal_at(pose)).residual);
  EXPECT_EQ(published("exact")->separation(pose).effect, model->separation(pose).effect);
  const std::vector<std::string> classes = model->description().separation->published;
  ASSERT_EQ(classes.size(), kFactors);
  EXPECT_EQ(std::ranges::count(classes, "compensable"), 24 + 2 * 3);  // the paper's scalar c has three components
  EXPECT_EQ(std::ranges::count(classes, "non-compensable"), 21);
  EXPECT_EQ(std::ranges::count(classes, ""), 9);
}

}  // namespace
}  // namespace poesy::three_prs
