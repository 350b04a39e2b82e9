#include "models/two_upr_rpu/model.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <fstream>
#include <nlohmann/json.hpp>
#include <numbers>
#include <stdexcept>

#include "models/chain/limb.h"
#include "models/two_upr_rpu/errors.h"
#include "models/two_upr_rpu/kinematics.h"

namespace poesy::two_upr_rpu {
namespace {

using nlohmann::json;

std::unique_ptr<Model> published() {
  const CatalogEntry entry = catalog_entry();
  std::vector<double> geometry;
  for (const GeometryParameter& parameter : entry.description.geometry) geometry.push_back(parameter.published);
  return entry.build(geometry, 0);
}

/// Reference cases that were computed independently; see the note in the JSON file.
json oracle_cases() {
  std::ifstream file(std::string(POESY_TEST_DATA) + "/deformation_2upr_rpu.json");
  return json::parse(file).at("cases");
}

std::vector<double> pose_of(const json& reference) {
  const json& pose = reference.at("pose");
  return {pose.at("z"), pose.at("beta"), pose.at("gamma")};
}

std::vector<double> errors_of(const json& reference, const ModelDescription& description) {
  std::vector<double> errors(description.factors.size(), 0.0);
  for (const auto& [name, value] : reference.at("errors").items()) {
    errors.at(description.find_factor(name).value().value) = value;
  }
  return errors;
}

struct Solved {
  std::array<double, 3> responses{};
  std::array<double, 18> details{};
  SolveStatus status{};
  std::uint32_t iterations = 0;
};

Solved solve(const Model& model, std::span<const double> pose, std::span<const double> errors) {
  Solved out;
  model.evaluator({})->evaluate({pose, errors, {}, {}, 1},
                                {out.responses, std::span(&out.status, 1), std::span(&out.iterations, 1), out.details});
  return out;
}

TEST(Rounding, IsAboveWhatErrorsWithoutEffectLeaveAtAnySize) {
  const auto model = published();
  const ModelDescription& description = model->description();
  const std::vector<double> pose{-0.22, 0.2, -0.3};
  double largest = 0.0;
  for (const FactorIndex factor : description.find_set("benign")->factors) {
    for (const double value : {1e-2, 1e-4, 1e-7, 1e-12, -3e-3, -5e-8}) {
      std::vector<double> errors(description.factors.size(), 0.0);
      errors[factor.value] = value;
      const Solved found = solve(*model, pose, errors);
      for (std::size_t r = 0; r < found.responses.size(); ++r) {
        EXPECT_LT(found.responses[r], model->rounding(r)) << description.factors[factor.value].name << " " << value;
        largest = std::max(largest, found.responses[r]);
      }
    }
  }
  EXPECT_GT(largest, 0.02 * model->rounding(0));  // the threshold is not far too large
}

TEST(Oracle, JointDisplacements) {
  const auto model = published();
  for (const json& reference : oracle_cases()) {
    const std::vector<double> q = model->joint_displacements(pose_of(reference));
    for (std::size_t i = 0; i < 3; ++i) {
      for (std::size_t j = 0; j < 4; ++j) {
        EXPECT_NEAR(q[4 * i + j], reference.at("joint_displacements")[i][j].get<double>(), 1e-12);
      }
    }
  }
}

TEST(Condition, IsModestAtTheCornersOfTheWorkspace) {
  const auto model = published();
  const ModelDescription& description = model->description();
  for (int corner = 0; corner < 8; ++corner) {
    std::vector<double> pose;
    for (std::size_t c = 0; c < 3; ++c) {
      pose.push_back((corner >> c & 1) != 0 ? description.pose_upper[c] : description.pose_lower[c]);
    }
    EXPECT_GE(model->condition(pose), 1.0);
    EXPECT_LT(model->condition(pose), 50.0);
  }
}

TEST(Description, JointsHaveTheDimensionOfTheirKind) {
  const auto model = published();
  ASSERT_EQ(model->description().joints.size(), 12u);
  for (const JointDisplacement& joint : model->description().joints) {
    const bool slides = joint.name == "q_1_3" || joint.name == "q_2_3" || joint.name == "q_3_2";
    EXPECT_EQ(joint.dimension, slides ? Dimension::length : Dimension::angle) << joint.name;
  }
}

TEST(Oracle, LimbPosesWithErrorsAtNominalDisplacements) {
  const auto model = published();
  const chain::ParallelChain chain = parallel_chain({});
  const std::vector<chain::ErrorTerms> terms = error_terms();
  for (const json& reference : oracle_cases()) {
    const std::vector<double> errors = errors_of(reference, model->description());
    const std::vector<double> q = model->joint_displacements(pose_of(reference));
    for (std::size_t i = 0; i < 3; ++i) {
      std::array<chain::FrameError<double>, 5> frame_errors;
      frame_errors.fill(chain::FrameError<double>::Zero());
      for (std::size_t f = 0; f < terms.size(); ++f) {
        if (terms[f].front().limb != i) continue;
        frame_errors[terms[f].front().frame][static_cast<Eigen::Index>(terms[f].front().component)] = errors[f];
      }
      std::vector<lie::Transform<double>> frames;
      for (std::size_t j = 0; j < 5; ++j) frames.push_back(chain::frame_with_error(chain.limbs[i], j, frame_errors[j]));
      const auto g = chain::forward_kinematics<double>(chain.limbs[i], frames, std::span(q).subspan(4 * i, 4),
                                                       [](std::size_t, const lie::Screw<double>&) {});
      const json& expected = reference.at("initial_limb_poses")[i];
      for (Eigen::Index row = 0; row < 3; ++row) {
        const json& line = expected[static_cast<std::size_t>(row)];
        for (Eigen::Index column = 0; column < 3; ++column) {
          EXPECT_NEAR(g.R(row, column), line[static_cast<std::size_t>(column)].get<double>(), 1e-14);
        }
        EXPECT_NEAR(g.p[row], line[3].get<double>(), 1e-14);
      }
    }
  }
}

TEST(Oracle, Deformations) {
  const auto model = published();
  for (const json& reference : oracle_cases()) {
    if (!reference.at("converged")) continue;
    const std::vector<double> errors = errors_of(reference, model->description());
    const Solved found = solve(*model, pose_of(reference), errors);
    const std::array<const char*, 3> names{"delta_mu_21", "delta_mu_32", "delta_mu_13"};
    for (std::size_t n = 0; n < 3; ++n) {
      for (std::size_t k = 0; k < 6; ++k) {
        EXPECT_NEAR(found.details[6 * n + k], reference.at(names[n])[k].get<double>(), 1e-11);
      }
    }
    EXPECT_NEAR(found.responses[0], reference.at("angular_deformation").get<double>(), 1e-11);
    EXPECT_NEAR(found.responses[1], reference.at("linear_deformation").get<double>(), 1e-11);
    EXPECT_NEAR(found.responses[2], reference.at("delta_mu_max").get<double>(), 1e-11);
  }
}

TEST(Model, BlockOfVariedErrorsEqualsSingleSolves) {
  const auto model = published();
  const ModelDescription& description = model->description();
  const std::vector<FactorIndex> varied{*description.find_factor("epsilon_1_0_z"),
                                        *description.find_factor("delta_3_4_x")};
  const std::vector<double> pose{-0.22, 0.1, -0.2};
  std::vector<double> errors(71, 1e-4);
  const std::vector<double> values{0.01, -0.02, 0.003, 0.001, 0.002, -0.001};
  std::array<double, 9> responses{};
  std::array<SolveStatus, 3> status{};
  std::array<std::uint32_t, 3> iterations{};
  std::array<double, 54> details{};
  model->evaluator({})->evaluate({pose, errors, varied, values, 3}, {responses, status, iterations, details});
  for (std::size_t b = 0; b < 3; ++b) {
    errors[varied[0].value] = values[b];
    errors[varied[1].value] = values[3 + b];
    const Solved single = solve(*model, pose, errors);
    for (std::size_t r = 0; r < 3; ++r) EXPECT_NEAR(responses[3 * r + b], single.responses[r], 1e-13);
    for (std::size_t d = 0; d < 18; ++d) EXPECT_NEAR(details[3 * d + b], single.details[d], 1e-13);
    EXPECT_EQ(status[b], single.status);
    EXPECT_EQ(iterations[b], single.iterations);
  }
}

TEST(Model, BenignErrorsAreAbsorbed) {
  // Du et al. 2022, Section 5.2, group 1 of Table 8: all deformations at rounding.
  const auto model = published();
  std::vector<double> errors(71, 0.0);
  for (const FactorIndex factor : model->description().find_set("benign")->factors) errors[factor.value] = 1.6667e-3;
  for (const double gamma : {-0.5, 0.0, 0.4}) {
    const std::vector<double> pose{-0.25, 0.3, gamma};
    EXPECT_LE(solve(*model, pose, errors).responses[2], 2e-15);
  }
}

TEST(Model, SaysWhyAPoseIsOutOfReach) {
  const auto model = published();
  EXPECT_FALSE(model->unreachable(std::vector{-0.25, 0.3, 0.4}));
  EXPECT_NE(model->unreachable(std::vector{-0.25, 1.6, 0.0}).value().find("beta"), std::string::npos);
  EXPECT_NE(model->unreachable(std::vector{-0.25, 0.0, 4.0}).value().find("gamma"), std::string::npos);
  EXPECT_NE(model->unreachable(std::vector{0.25, 0.0, 0.0}).value().find("z must be negative"), std::string::npos);
  EXPECT_NE(model->unreachable(std::vector{-1e9, 0.0, 0.2}).value().find("limb"), std::string::npos);
}

TEST(Model, RefusesImpossibleGeometry) {
  const CatalogEntry entry = catalog_entry();
  EXPECT_THROW(entry.build(std::vector{-0.06, 0.15, 0.025, 0.115, -0.2}, 0), std::invalid_argument);
  EXPECT_THROW(entry.build(std::vector{0.06, 0.0, 0.025, 0.115, -0.2}, 0), std::invalid_argument);
  EXPECT_THROW(entry.build(std::vector{0.06, 0.15, 0.025, 0.115, 0.2}, 0), std::invalid_argument);
}

TEST(Model, FollowsItsGeometry) {
  const CatalogEntry entry = catalog_entry();
  const auto larger = entry.build(std::vector{0.08, 0.2, 0.03, 0.12, -0.3}, 0);
  EXPECT_FALSE(larger->unreachable(std::vector{-0.35, 0.2, -0.3}));
  EXPECT_NE(larger->joint_displacements(std::vector{-0.35, 0.2, -0.3}),
            published()->joint_displacements(std::vector{-0.35, 0.2, -0.3}));
}

TEST(Model, BoundsErrorsByPlatformAndBase) {
  const CatalogEntry entry = catalog_entry();
  const auto bound = [&](const Model& model, const char* name) {
    return model.error_bound(*entry.description.find_factor(name)).size;
  };
  EXPECT_EQ(bound(*published(), "delta_1_1_y"), 0.06);
  EXPECT_EQ(bound(*published(), "epsilon_1_4_z"), std::numbers::pi);
  EXPECT_EQ(bound(*entry.build(std::vector{0.2, 0.15, 0.025, 0.0, -0.3}, 0), "delta_3_0_x"), 0.15);
}

}  // namespace
}  // namespace poesy::two_upr_rpu
