// Compares the 3-PRS with corrected carriages with separation() and with the mechanism whose carriages are moved.
#include "engine/model/calibrated.h"

#include <gtest/gtest.h>

#include <Eigen/QR>
#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "engine/kinds/monte_carlo/kind.h"
#include "engine/kinds/monte_carlo/result.h"
#include "engine/kinds/study_file.h"
#include "models/registry.h"
#include "models/three_prs/error_mapping.h"
#include "models/three_prs/evaluators.h"
#include "tests/models/three_prs/reference.h"
#include "tests/support/input_error.h"

namespace poesy::three_prs {
namespace {

using Errors = std::vector<double>;
using Screw = lie::Screw<double>;

const std::array<std::string_view, 2> kFidelities{"exact", "first-order"};

std::unique_ptr<Model> corrected(std::string_view fidelity) { return calibrated(published(fidelity)); }

Configuration nominal_at(const std::vector<double>& pose) { return configuration({}, {pose[0], pose[1], pose[2]}); }

Screw displacement_of(const Solved& found) { return Eigen::Map<const Screw>(found.responses.data()); }

/// The displacements of the three spherical joints, divided by sqrt(3). Their norm is the measure of the separation.
Eigen::Matrix<double, 9, 1> joints(const Configuration& nominal, const Screw& x) {
  Eigen::Matrix<double, 9, 1> moved;
  for (std::size_t i = 0; i < kLimbs; ++i) {
    const Eigen::Vector3d arm = nominal.limbs[i].c;
    moved.segment<3>(3 * static_cast<Eigen::Index>(i)) = x.tail<3>() + Eigen::Vector3d(x.head<3>()).cross(arm);
  }
  return moved / std::sqrt(3.0);
}

double measure(const Configuration& nominal, const Screw& x) { return joints(nominal, x).norm(); }

Errors one_error(std::size_t factor, double size) {
  Errors errors(kFactors, 0.0);
  errors[factor] = size;
  return errors;
}

/// Random values for all errors, uniform between -size and size (m, rad).
Errors all_errors(double size, unsigned seed) {
  std::mt19937_64 engine(seed);
  Errors errors(kFactors);
  for (double& error : errors) error = std::uniform_real_distribution<double>(-size, size)(engine);
  return errors;
}

/// The carriage displacements dq (m) whose effect is closest to this displacement of the platform, so that moving back
/// by dq leaves the least. Computed from first-order solves.
Eigen::Vector3d best_carriages(const std::vector<double>& pose, const Screw& displacement) {
  const auto model = published("first-order");
  const Configuration nominal = nominal_at(pose);
  Eigen::Matrix<double, 9, 3> by_carriages;
  for (std::size_t i = 0; i < kLimbs; ++i) {
    const Solved unit = solve(*model, pose, one_error(factor_of(i, Source::q), 1.0));
    by_carriages.col(static_cast<Eigen::Index>(i)) = joints(nominal, displacement_of(unit));
  }
  return by_carriages.completeOrthogonalDecomposition().solve(joints(nominal, displacement));
}

/// The errors with the carriages moved back by dq.
Errors with_carriages(Errors errors, const Eigen::Vector3d& dq) {
  for (std::size_t i = 0; i < kLimbs; ++i) errors[factor_of(i, Source::q)] -= dq[static_cast<Eigen::Index>(i)];
  return errors;
}

double largest_difference(const Solved& a, const Solved& b) {
  double largest = 0.0;
  for (std::size_t r = 0; r < kResponses; ++r) largest = std::max(largest, std::abs(a.responses[r] - b.responses[r]));
  for (std::size_t i = 0; i < kLimbs; ++i) largest = std::max(largest, std::abs(a.swing[i] - b.swing[i]));
  return largest;
}

TEST(Calibrated, LeavesTheResidualOfEveryError) {
  for (const std::vector<double>& pose : random_poses(5, 21)) {
    const Configuration nominal = nominal_at(pose);
    const Separation truth = separation({}, nominal);
    for (const std::string_view fidelity : kFidelities) {
      const auto model = corrected(fidelity);
      const auto plain = published(fidelity);
      const bool exact = fidelity == "exact";
      const double size = exact ? 1e-7 : 1.0;
      const double tolerance = exact ? 2e-6 : 1e-13;
      for (std::size_t f = 0; f < kFactors; ++f) {
        const Solved found = solve(*model, pose, one_error(f, size));
        ASSERT_TRUE(solved(found.status));
        const double left = measure(nominal, displacement_of(found)) / size;
        const double effect = measure(nominal, displacement_of(solve(*plain, pose, one_error(f, size)))) / size;
        EXPECT_NEAR(left, truth.residual[f], tolerance * (1.0 + truth.effect[f])) << fidelity << " " << f;
        EXPECT_NEAR(effect - left, truth.effect[f] - truth.residual[f], tolerance * (1.0 + truth.effect[f]));
      }
    }
  }
}

/// Nothing is left of errors whose whole effect enters through the carriages.
TEST(Calibrated, RemovesWhatTheCarriagesCanMove) {
  for (const std::vector<double>& pose : random_poses(5, 22)) {
    const Separation truth = separation({}, nominal_at(pose));
    std::size_t removed = 0;
    for (std::size_t f = 0; f < kFactors; ++f) {
      if (truth.effect[f] == 0.0 || truth.constraint[f] != 0.0) continue;
      ++removed;
      const Errors errors = one_error(f, 1e-3);
      const Solved first = solve(*corrected("first-order"), pose, errors);
      const Solved exact = solve(*corrected("exact"), pose, errors);
      for (std::size_t r = 0; r < kResponses; ++r) {
        EXPECT_NEAR(first.responses[r], 0.0, 2e-17) << f << " " << r;
        // Second-order effects remain, because the correction is linear; the errors are a thousandth of the mechanism's
        // size.
        EXPECT_NEAR(exact.responses[r], 0.0, 2e-5) << f << " " << r;
      }
    }
    EXPECT_EQ(removed, 21u);  // a_x, a_z, q, theta_A_y, b_x, b_z and l of three limbs
  }
}

TEST(Calibrated, IsTheMechanismWithItsCarriagesMoved) {
  const auto first_order = published("first-order");
  const auto exact = published("exact");
  double largest = 0.0;
  for (const std::vector<double>& pose : random_poses(20, 23)) {
    const Errors errors = all_errors(1e-3, 24);
    const Solved uncorrected = solve(*first_order, pose, errors);
    const Eigen::Vector3d dq = best_carriages(pose, displacement_of(uncorrected));
    EXPECT_LE(largest_difference(solve(*corrected("first-order"), pose, errors),
                                 solve(*first_order, pose, with_carriages(errors, dq))),
              1e-15);
    // Exact solves differ by second-order terms: with half the errors, the difference is a quarter.
    const auto difference = [&](double size) {
      Errors smaller = errors;
      for (double& error : smaller) error *= size;
      const Screw moved = displacement_of(solve(*exact, pose, smaller));
      return largest_difference(solve(*corrected("exact"), pose, smaller),
                                solve(*exact, pose, with_carriages(smaller, best_carriages(pose, moved))));
    };
    const double whole = difference(1.0);
    EXPECT_LE(whole, 1e-3);
    EXPECT_NEAR(whole / difference(0.5), 4.0, 0.4);
    largest = std::max(largest, whole);
  }
  RecordProperty("second_order_um", std::to_string(1e6 * largest));
}

TEST(Calibrated, IsLinearToFirstOrder) {
  const auto model = corrected("first-order");
  for (const std::vector<double>& pose : random_poses(5, 25)) {
    const Errors a = all_errors(1e-3, 26);
    const Errors b = all_errors(1e-3, 27);
    Errors both(kFactors);
    for (std::size_t f = 0; f < kFactors; ++f) both[f] = 2.0 * a[f] - 3.0 * b[f];
    const Solved of_a = solve(*model, pose, a), of_b = solve(*model, pose, b), of_both = solve(*model, pose, both);
    for (std::size_t r = 0; r < kComponents; ++r) {
      EXPECT_NEAR(of_both.responses[r], 2.0 * of_a.responses[r] - 3.0 * of_b.responses[r], 1e-15) << r;
    }
    for (std::size_t i = 0; i < kLimbs; ++i) {
      EXPECT_NEAR(of_both.swing[i], 2.0 * of_a.swing[i] - 3.0 * of_b.swing[i], 1e-15) << i;
    }
  }
}

/// Two errors are corrected together, and the responses of the corrected platform are consistent with each other.
TEST(Calibrated, CorrectsTwoErrorsAtOnce) {
  for (const std::vector<double>& pose : random_poses(3, 28)) {
    const Configuration nominal = nominal_at(pose);
    for (const std::string_view fidelity : kFidelities) {
      const auto model = corrected(fidelity);
      Errors errors = one_error(factor_of(0, Source::theta_A), 2e-3);
      errors[factor_of(1, Source::c)] = 1e-3;
      const Solved found = solve(*model, pose, errors);
      const Screw left = displacement_of(found);
      // No further correction is possible: the rest is orthogonal to the effect of each carriage.
      EXPECT_LE(best_carriages(pose, left).norm(), 1e-16 + 1e-13 * left.norm()) << fidelity;
      const Eigen::Vector3d arm = tool({}, nominal.platform.R);
      const Eigen::Vector3d theta = left.head<3>();
      const bool exact = fidelity == "exact";
      const Eigen::Vector3d swept = exact ? Eigen::Vector3d(lie::exp<double>(theta) * arm - arm) : theta.cross(arm);
      const Eigen::Vector3d tip(found.responses.data() + 6);
      EXPECT_LE((tip - left.tail<3>() - swept).norm(), 1e-15) << fidelity;
      EXPECT_DOUBLE_EQ(found.responses[9], theta.norm());
      EXPECT_DOUBLE_EQ(found.responses[10], left.tail<3>().norm());
      EXPECT_DOUBLE_EQ(found.responses[11], tip.norm());
    }
  }
}

/// A sample has the same outcome alone and in a block, with and without details.
TEST(Calibrated, GivesABlockAsItsSamples) {
  constexpr std::size_t kCount = 67;
  const std::vector<double> pose = random_poses(1, 29).front();
  const std::vector<FactorIndex> varied{FactorIndex(2), FactorIndex(17), FactorIndex(44)};
  for (const std::string_view fidelity : kFidelities) {
    const auto evaluator = corrected(fidelity)->evaluator({});
    const Errors errors = all_errors(1e-3, 30);
    const Errors pool = all_errors(1e-3, 31);
    std::vector<double> values;
    for (std::size_t k = 0; k < varied.size() * kCount; ++k)
      values.push_back(pool[k % pool.size()] * (1.0 + 1e-3 * static_cast<double>(k)));
    const auto solve_block = [&](std::span<const double> rows, std::size_t count, bool with_details) {
      std::vector<double> outcome((kResponses + kLimbs) * count);
      std::vector<SolveStatus> status(count);
      std::vector<std::uint32_t> iterations(count);
      evaluator->evaluate({pose, errors, varied, rows, count},
                          {std::span(outcome).first(kResponses * count), status, iterations,
                           std::span(outcome).subspan(kResponses * count, with_details ? kLimbs * count : 0)});
      return outcome;
    };
    const std::vector<double> block = solve_block(values, kCount, true);
    const std::vector<double> without = solve_block(values, kCount, false);
    EXPECT_TRUE(std::equal(block.begin(), block.begin() + kResponses * kCount, without.begin()));
    for (std::size_t b = 0; b < kCount; b += 11) {
      const std::vector<double> own{values[b], values[kCount + b], values[2 * kCount + b]};
      const std::vector<double> single = solve_block(own, 1, true);
      for (std::size_t r = 0; r < single.size(); ++r) EXPECT_EQ(single[r], block[r * kCount + b]) << fidelity;
    }
  }
}

TEST(Calibrated, IsTheSameMechanismWithoutATrace) {
  const auto plain = published("exact");
  const auto model = corrected("exact");
  const std::vector<double> pose = random_poses(1, 32).front();
  EXPECT_EQ(model->description().name, "3-prs");
  EXPECT_EQ(model->joint_displacements(pose), plain->joint_displacements(pose));
  EXPECT_EQ(model->condition(pose), plain->condition(pose));
  EXPECT_EQ(model->separation(pose).residual, plain->separation(pose).residual);
  EXPECT_EQ(model->rounding(0), plain->rounding(0));
  EXPECT_EQ(model->error_bound(FactorIndex(0)).part, plain->error_bound(FactorIndex(0)).part);
  EXPECT_EQ(model->unreachable(std::vector{2.0, 0.0, 0.8}), plain->unreachable(std::vector{2.0, 0.0, 0.8}));
  EXPECT_FALSE(model->trace(pose, all_errors(1e-3, 33), {}));
  EXPECT_TRUE(plain->trace(pose, all_errors(1e-3, 33), {}));
}

Study study_of(const std::string& model, const std::string& analysis) {
  return study_of_text("format = \"poesy-study\"\nversion = 1\nmechanism = { model = \"" + model +
                           "\" }\nposes = { count = 4 }\n[errors]\nlinear = { distribution = \"normal\", sigma = \"0.1 "
                           "mm\" }\nangular = { distribution = \"normal\", sigma = \"0.1 mrad\" }\n[analysis]\nkind = "
                           "\"monte-carlo\"\nsamples = 2000\ndraws = \"per machine\"\n" +
                           analysis,
                       "study.toml", registry(), StudyUse::run);
}

double yield_of(const Study& study) {
  const auto model = build_model(study.mechanism);
  const Plan plan(study, select_poses(study.poses, *model).poses);
  return monte_carlo::run_monte_carlo(plan, *model, study.analysis, {}).value().machines->yield->value;
}

TEST(CalibratedStudy, HasAYieldNoLower) {
  const std::string limits = "limits = { tip_position = \"0.5 mm\", rotation = \"1 mrad\" }\n";
  const double plain = yield_of(study_of("3-prs", limits));
  const double corrected = yield_of(study_of("3-prs", "calibrated = true\n" + limits));
  RecordProperty("yields", std::to_string(plain) + " " + std::to_string(corrected));
  EXPECT_GE(corrected, plain);
  EXPECT_GT(corrected, plain + 0.1) << plain;
  EXPECT_EQ(yield_of(study_of("3-prs", "calibrated = false\n" + limits)), plain);
}

TEST(CalibratedStudy, IsRefusedWhereNoActuatedDirectionsAreApart) {
  for (const char* model : {"2upr-rpu", "xy-3-prs"}) {
    test::expect_input_error([&] { study_of(model, "calibrated = true\n"); }, {"study.toml", 12, 14},
                             {"analysis.calibrated is true", model,
                              "does not separate actuated from constrained directions", "leave it out"});
  }
}

}  // namespace
}  // namespace poesy::three_prs
