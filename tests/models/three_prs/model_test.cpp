#include "models/three_prs/model.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <stdexcept>

#include "models/three_prs/error_mapping.h"
#include "tests/models/three_prs/reference.h"

namespace poesy::three_prs {
namespace {

using nlohmann::json;

const ModelDescription kModel = catalog_entry().description;

/// The index of an error by its short name: "dax1" is a_x_1.
std::size_t place_of(const std::string& short_name) {
  const json& names = oracle().at("names");
  const std::string source = short_name.substr(0, short_name.size() - 1);
  const auto found = std::find(names.begin(), names.end(), source);
  return static_cast<std::size_t>(short_name.back() - '1') * kSources + static_cast<std::size_t>(found - names.begin());
}

void set(std::vector<double>& errors, std::string_view group, std::size_t limb, double value) {
  const auto vector = [&](Source source) {
    std::fill_n(errors.begin() + std::ptrdiff_t(factor_of(limb, source)), 3, value);
  };
  if (group.starts_with("FS")) vector(Source::a), vector(Source::c);
  if (group == "T" || group == "FSTRL") errors[factor_of(limb, Source::q)] = value;
  if (group == "R" || group == "FSTRL") vector(Source::b);
  if (group == "L" || group == "FSTRL") errors[factor_of(limb, Source::l)] = value;
}

std::vector<double> errors_of(const json& reference) {
  std::vector<double> errors(kFactors, 0.0);
  if (reference.contains("source")) {
    errors.at(place_of(reference.at("source"))) = reference.at("value");  // these cases have angles only
    return errors;
  }
  for (std::size_t limb = 0; limb < kLimbs; ++limb) {
    set(errors, reference.at("group").get<std::string>(), limb,
        double(reference.at("limbs")[limb]) * double(reference.at("delta")) * kMm);
  }
  return errors;
}

void expect_motion(const Solved& found, const json& expected) {
  for (std::size_t k = 0; k < 3; ++k) {
    EXPECT_NEAR(found.responses[k], expected[k].get<double>(), 1e-12);
    EXPECT_NEAR(found.responses[3 + k] / kMm, expected[3 + k].get<double>(), 1e-9);
  }
}

TEST(Rounding, IsAboveWhatExactSolvesOfTinyErrorsLeave) {
  // With errors of 1e-13 (m, rad), second-order effects are about 1e-26, so every difference from the first order is
  // rounding.
  constexpr double kTiny = 1e-13;
  const auto exact = published("exact");
  const auto first_order = published("first-order");
  const std::vector<double> pose{0.1, -0.2, 0.7};
  double largest = 0.0;
  for (std::size_t f = 0; f < kFactors; ++f) {
    for (const double value : {kTiny, -0.3 * kTiny}) {
      std::vector<double> errors(kFactors, 0.0);
      errors[f] = value;
      const Solved found = solve(*exact, pose, errors);
      const Solved linear = solve(*first_order, pose, errors);
      for (std::size_t r = 0; r < found.responses.size(); ++r) {
        const double left = std::abs(found.responses[r] - linear.responses[r]);
        EXPECT_LT(left, exact->rounding(r)) << f << " " << r;
        largest = std::max(largest, left);
      }
    }
  }
  EXPECT_GT(largest, 0.02 * exact->rounding(0));  // the threshold is not far too large
  EXPECT_EQ(first_order->rounding(0), 0.0);
}

TEST(Oracle, ExactAndFirstOrderSolves) {
  ASSERT_EQ(oracle().at("exact").size(), 38u);
  const auto exact = published("exact");
  const auto first_order = published("first-order");
  for (const json& reference : oracle().at("exact")) {
    const json& at = reference.at("pose");
    const std::vector<double> pose{at[0], at[1], kMm * double(at[2])};
    const Solved found = solve(*exact, pose, errors_of(reference));
    EXPECT_TRUE(solved(found.status));
    expect_motion(found, reference.at("exact"));
    if (reference.contains("swing")) {
      for (std::size_t i = 0; i < kLimbs; ++i)
        EXPECT_NEAR(found.swing[i], reference.at("swing")[i].get<double>(), 1e-12);
    }
    const Solved linear = solve(*first_order, pose, errors_of(reference));
    EXPECT_EQ(linear.status, SolveStatus::converged);
    EXPECT_EQ(linear.iterations, 1u);
    expect_motion(linear, reference.at("linear"));
  }
}

TEST(Oracle, EffectsAtHome) {
  const Effects effects = first_order_effects({}, configuration({}, {0.0, 0.0, 0.7}));
  for (const auto& [name, column] : oracle().at("home").items()) {
    const auto place = static_cast<Eigen::Index>(place_of(name));
    for (std::size_t k = 0; k < 6; ++k) {
      const double unit = k < 3 ? 1.0 / kMm : 1.0;
      EXPECT_NEAR(effects(static_cast<Eigen::Index>(k), place), double(column[k]) * unit, 1e-12) << name;
    }
  }
}

TEST(Mapping, EveryColumnIsTheDerivativeOfTheExactSolver) {
  const auto exact = published("exact");
  for (const std::vector<double>& pose : random_poses(20, 3)) {
    const Effects effects = first_order_effects({}, configuration({}, {pose[0], pose[1], pose[2]}));
    for (std::size_t f = 0; f < kFactors; ++f) {
      const double step = 1e-5;
      std::vector<double> errors(kFactors, 0.0);
      errors[f] = step;
      const Solved above = solve(*exact, pose, errors);
      errors[f] = -step;
      const Solved below = solve(*exact, pose, errors);
      Eigen::Matrix<double, kMotions, 1> difference;
      for (std::size_t r = 0; r < 9; ++r)
        difference[Eigen::Index(r)] = (above.responses[r] - below.responses[r]) / (2 * step);
      for (std::size_t r = 0; r < 3; ++r)
        difference[Eigen::Index(9 + r)] = (above.swing[r] - below.swing[r]) / (2 * step);
      const auto column = effects.col(static_cast<Eigen::Index>(f));
      EXPECT_LE((difference - column).norm(), 1e-7 * column.norm()) << kModel.factors[f].name;
    }
  }
}

TEST(Exact, EqualCarriageErrorsLowerThePlatform) {
  const auto exact = published("exact");
  std::vector<double> errors(kFactors, 0.0);
  for (std::size_t limb = 0; limb < kLimbs; ++limb) errors[factor_of(limb, Source::q)] = 1e-3;
  for (const std::vector<double>& pose : random_poses(50, 4)) {
    const Solved found = solve(*exact, pose, errors);
    for (std::size_t k = 0; k < 5; ++k) EXPECT_NEAR(found.responses[k], 0.0, 1e-14);
    EXPECT_NEAR(found.responses[5], 1e-3, 1e-14);
  }
}

TEST(Exact, SourcesWithoutEffectMoveNothingAlone) {
  // Together, theta_Bp_y and theta_Bp_z tilt the rod to second order.
  const auto exact = published("exact");
  for (const std::vector<double>& pose : random_poses(20, 5)) {
    for (const char* name : {"theta_B_y_1", "theta_Bp_y_2", "theta_Bp_z_3"}) {
      std::vector<double> errors(kFactors, 0.0);
      errors[kModel.find_factor(name)->value] = 1e-2;
      const Solved found = solve(*exact, pose, errors);
      for (std::size_t r = 0; r < 12; ++r) EXPECT_NEAR(found.responses[r], 0.0, 1e-14) << name;
    }
  }
}

/// The largest |tip displacement| along x, y and z (mm) on trajectory 1, 30 (cos pi t, sin pi t, t) mm. The errors of
/// the group are 0.1 mm in the first `limbs` limbs.
std::array<double, 3> trajectory_maxima(const Model& model, std::string_view group, std::size_t limbs) {
  std::vector<double> errors(kFactors, 0.0);
  for (std::size_t limb = 0; limb < limbs; ++limb) set(errors, group, limb, 1e-4);
  std::array<double, 3> largest{};
  constexpr int kSteps = 400;
  for (int k = 0; k <= kSteps; ++k) {
    const double t = 2.0 * k / kSteps;
    const double angle = std::numbers::pi * t;
    const Pose pose = pose_of_tip({}, {0.03 * std::cos(angle), 0.03 * std::sin(angle), 0.85 + 0.03 * t}).value();
    const Solved found = solve(model, std::vector{pose.alpha, pose.beta, pose.z}, errors);
    for (std::size_t r = 0; r < 3; ++r) largest[r] = std::max(largest[r], std::abs(found.responses[6 + r]) / kMm);
  }
  return largest;
}

TEST(FirstOrder, MaximaOnTrajectory1) {
  struct Row {
    const char* group;
    std::size_t limbs;
    std::array<double, 3> maxima;
  };
  const auto model = published("first-order");
  for (const Row& row : {Row{"FS", 3, {.04621, .04714, .00618}}, Row{"T", 3, {0.0, 0.0, .1}},
                         Row{"R", 3, {.02307, .02364, .07933}}, Row{"L", 3, {.00011, .00010, .10216}},
                         Row{"FS", 1, {.02397, .00883, .01355}}, Row{"T", 1, {.08734, .00275, .05095}},
                         Row{"R", 1, {.07592, .05674, .04038}}, Row{"L", 1, {.08927, .00281, .05209}}}) {
    const std::array<double, 3> found = trajectory_maxima(*model, row.group, row.limbs);
    for (std::size_t k = 0; k < 3; ++k) EXPECT_NEAR(found[k], row.maxima[k], 0.5e-5) << row.group << row.limbs << k;
  }
}

TEST(Model, BlockOfVariedErrorsEqualsSingleSolves) {
  const std::vector<FactorIndex> varied{*kModel.find_factor("theta_A_x_2"), *kModel.find_factor("c_y_3")};
  constexpr std::size_t kCount = 131;  // more than two tiles of the kernel
  std::vector<double> values(2 * kCount);
  std::mt19937_64 engine(6);
  for (double& value : values) value = std::normal_distribution<double>(0.0, 2e-3)(engine);
  std::vector<double> errors(kFactors, 1e-4);
  for (const char* fidelity : {"exact", "first-order"}) {
    const auto model = published(fidelity);
    const std::vector<double> pose{0.1, -0.2, 0.8};
    std::vector<double> responses(12 * kCount), swing(3 * kCount);
    std::vector<SolveStatus> status(kCount);
    std::vector<std::uint32_t> iterations(kCount);
    model->evaluator({})->evaluate({pose, errors, varied, values, kCount}, {responses, status, iterations, swing});
    for (std::size_t b = 0; b < kCount; ++b) {
      errors[varied[0].value] = values[b];
      errors[varied[1].value] = values[kCount + b];
      const Solved single = solve(*model, pose, errors);
      for (std::size_t r = 0; r < 12; ++r) EXPECT_NEAR(responses[r * kCount + b], single.responses[r], 1e-14);
      for (std::size_t i = 0; i < 3; ++i) EXPECT_NEAR(swing[i * kCount + b], single.swing[i], 1e-14);
      EXPECT_TRUE(solved(status[b]));
    }
  }
}

TEST(Model, ASampleDoesNotDependOnItsNeighbours) {
  const std::vector<FactorIndex>& varied = kModel.find_set("all")->factors;
  const std::size_t count = 70;
  std::vector<double> values(varied.size() * count);
  std::mt19937_64 engine(7);
  for (double& value : values) value = std::normal_distribution<double>(0.0, 1e-3)(engine);
  const std::vector<double> errors(kFactors, 0.0), pose{-0.2, 0.1, 0.75};
  for (const char* fidelity : {"exact", "first-order"}) {
    const auto model = published(fidelity);
    const auto evaluator = model->evaluator({});
    const auto responses_of = [&](std::size_t first, std::size_t size) {
      std::vector<double> part, responses(12 * size);
      for (std::size_t v = 0; v < varied.size(); ++v) {
        for (std::size_t b = 0; b < size; ++b) part.push_back(values[v * count + first + b]);
      }
      std::vector<SolveStatus> status(size);
      std::vector<std::uint32_t> iterations(size);
      evaluator->evaluate({pose, errors, varied, part, size}, {responses, status, iterations, {}});
      return responses;
    };
    const std::vector<double> together = responses_of(0, count);
    for (std::size_t b = 0; b < count; ++b) {
      const std::vector<double> alone = responses_of(b, 1);
      for (std::size_t r = 0; r < 12; ++r) EXPECT_EQ(together[r * count + b], alone[r]);
    }
  }
}

TEST(Model, NormsBelongToTheirComponents) {
  for (const char* fidelity : {"exact", "first-order"}) {
    const Solved found = solve(*published(fidelity), std::vector{0.1, 0.2, 0.7}, std::vector<double>(kFactors, 1e-3));
    for (std::size_t k = 0; k < 3; ++k) {
      const Eigen::Map<const Eigen::Vector3d> vector(found.responses.data() + 3 * k);
      EXPECT_DOUBLE_EQ(found.responses[9 + k], vector.norm());
    }
  }
}

TEST(Exact, SaysHowASolveEnded) {
  const auto model = published("exact");
  std::vector<double> errors(kFactors, 0.0);
  errors[factor_of(0, Source::a)] = 1e-3;
  Solved out;
  const std::vector<double> pose{0.1, 0.2, 0.7};
  const auto status_with = [&](const SolverOptions& options) {
    model->evaluator(options)->evaluate({pose, errors, {}, {}, 1}, {out.responses, std::span(&out.status, 1),
                                                                    std::span(&out.iterations, 1), out.swing});
    return out.status;
  };
  EXPECT_EQ(status_with({.tolerance = 1e-8}), SolveStatus::converged);
  EXPECT_EQ(status_with({.tolerance = 1e-300}), SolveStatus::stagnated);
  EXPECT_EQ(status_with({.max_iterations = 1}), SolveStatus::iteration_cap);
  EXPECT_EQ(out.iterations, 1u);
  errors[factor_of(0, Source::a)] = 1e300;
  EXPECT_EQ(status_with({}), SolveStatus::non_finite);
}

TEST(Model, WorkspaceIsReachableAndRegular) {
  const auto model = published("exact");
  double lowest = 1.0, highest = 0.0;
  constexpr int kSteps = 40;
  for (int i = 0; i <= kSteps; ++i) {
    for (int j = 0; j <= kSteps; ++j) {
      for (const double z : {kModel.pose_lower[2], kModel.pose_upper[2]}) {
        const double step = 1.0 / kSteps;
        const std::vector pose{std::lerp(kModel.pose_lower[0], kModel.pose_upper[0], i * step),
                               std::lerp(kModel.pose_lower[1], kModel.pose_upper[1], j * step), z};
        EXPECT_EQ(model->unreachable(pose), std::nullopt);
        EXPECT_LT(model->condition(pose), 50.0);
        const std::vector<double> q = model->joint_displacements(pose);
        for (const std::size_t k : {0U, 2U, 4U}) lowest = std::min(lowest, q[k]), highest = std::max(highest, q[k]);
      }
    }
  }
  // The workspace leaves less than 10 mm of the rails unused at each end.
  EXPECT_LT(lowest, 0.01);
  EXPECT_GT(highest, 0.49);
}

TEST(Model, SaysWhyAPoseIsOutOfReach) {
  const auto model = published("exact");
  const auto reason = [&](double alpha, double beta, double z) {
    return model->unreachable(std::vector{alpha, beta, z}).value_or("");
  };
  EXPECT_EQ(reason(0.1, 0.1, 0.7), "");
  EXPECT_NE(reason(1.6, 0.0, 0.7).find("alpha"), std::string::npos);
  EXPECT_NE(reason(0.0, -1.6, 0.7).find("beta"), std::string::npos);
  EXPECT_EQ(reason(0.0, 0.3, 0.57), "limb 1: the carriage would stand above the upper end of its rail");
  EXPECT_NE(reason(0.0, 0.0, 1.1).find("below the lower end"), std::string::npos);
  const CatalogEntry entry = catalog_entry();
  const auto short_rods = entry.build(std::vector{0.25, 0.135, 0.116, 0.5, 0.0}, 0);
  EXPECT_NE(short_rods->unreachable(std::vector{0.0, 0.4, 0.3}).value().find("does not reach"), std::string::npos);
}

TEST(Model, RefusesImpossibleGeometry) {
  const CatalogEntry entry = catalog_entry();
  const std::vector published{0.25, 0.135, 0.57, 0.5, 0.1717};
  for (std::size_t k = 0; k < published.size(); ++k) {
    std::vector<double> geometry = published;
    geometry[k] = -0.1;
    try {
      entry.build(geometry, 0);
      ADD_FAILURE() << kModel.geometry[k].name;
    } catch (const std::invalid_argument& reason) {
      EXPECT_TRUE(std::string(reason.what()).starts_with(kModel.geometry[k].name + " must"));
    }
  }
}

TEST(Description, NamesWhatStudiesAskFor) {
  EXPECT_EQ(kModel.name, "3-prs");
  EXPECT_EQ(kModel.fidelities, (std::vector<std::string>{"exact", "first-order"}));
  EXPECT_FALSE(kModel.deformation);
  constexpr std::array kNames{"theta_x", "theta_y", "theta_z", "x",        "y",        "z",
                              "tip_x",   "tip_y",   "tip_z",   "rotation", "position", "tip_position"};
  ASSERT_EQ(kModel.responses.size(), kNames.size());
  for (std::size_t r = 0; r < kNames.size(); ++r) EXPECT_EQ(kModel.responses[r].name, kNames[r]);
  ASSERT_EQ(kModel.joints.size(), 6u);
  EXPECT_EQ(kModel.joints[2].name, "q_2");
  EXPECT_EQ(kModel.joints[5].name, "th_3");
}

}  // namespace
}  // namespace poesy::three_prs
