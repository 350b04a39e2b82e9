#include "engine/kinds/identification/identification.h"
#include "engine/run/evaluation.h"
#include "tests/support/elements.h"
#include "tests/support/kinds.h"

#include <gtest/gtest.h>

#include <cmath>
#include <functional>

namespace poesy::identification {
namespace {

constexpr double kRounding = 1e-14;
constexpr std::size_t kPoses = 20;

/// Six errors: a length and an angle on frame 0 of limb 1 and two more angles on frame 1, a length and an angle on
/// frame 0 of limb 2.
ModelDescription model() {
  ModelDescription description;
  description.factors = {{"a", Dimension::length, 1, 0, ""}, {"b", Dimension::angle, 1, 0, ""},
                         {"c", Dimension::angle, 1, 1, ""},  {"d", Dimension::angle, 1, 1, ""},
                         {"e", Dimension::length, 2, 0, ""}, {"f", Dimension::angle, 2, 0, ""}};
  description.responses = {{"other", Dimension::length, ""}, {"deformation", Dimension::number, ""}};
  description.deformation = DeformationMeasure{1, kRounding};
  return description;
}

using Deformation = std::function<double(std::span<const double> errors, std::size_t pose)>;

/// A solver whose deformations come from a formula. NaN means that the sample is not solved.
SolveTable solver(Deformation deformation) {
  return [deformation](const ErrorTable& errors) {
    EvaluationResult result;
    result.response = decltype(result.response)({2, kPoses, errors.rows}, 1.0);
    result.status = decltype(result.status)({kPoses, errors.rows});
    result.iterations = decltype(result.iterations)({kPoses, errors.rows}, 1);
    for (std::size_t m = 0; m < kPoses; ++m) {
      for (std::size_t s = 0; s < errors.rows; ++s) {
        const double value =
            deformation(std::span(errors.values).subspan(s * errors.factors.size(), errors.factors.size()), m);
        result.response(1, m, s) = value;
        result.status(m, s) = std::isnan(value) ? SolveStatus::iteration_cap : SolveStatus::converged;
      }
    }
    return std::optional(result);
  };
}

Analysis analysis() {
  Analysis identification;
  identification.kind = &kStudy;
  for (std::size_t f = 0; f < 6; ++f) identification.factors.emplace_back(f);
  asked_of<Options>(identification).groups = {{"large", 5e-3, 5e-3}, {"small", 5e-5, 4e-4}};
  return identification;
}

Result identified(const Deformation& deformation, const Analysis& what = analysis()) {
  return identify(what, model(), solver(deformation)).value();
}

using Verdicts = std::vector<std::uint8_t>;

TEST(Identify, FindsErrorsThatDeformAloneAndCouplingsOfAFrame) {
  const Result found =
      identified([](auto e, std::size_t) { return std::abs(e[4]) + std::abs(e[0] * e[1]) + std::abs(e[2] * e[3]); });
  EXPECT_EQ(test::elements(found.single), (Verdicts{0, 0, 0, 0, 1, 0}));
  // For a coupled length and angle only the angle is reported, for two coupled angles both.
  EXPECT_EQ(test::elements(found.coupled), (Verdicts{0, 1, 1, 1, 1, 0}));
  ASSERT_EQ(found.couplings.size(), 4u);
  EXPECT_EQ(found.couplings[0].first, 0u);
  EXPECT_EQ(found.couplings[0].second, 1u);
  EXPECT_EQ(found.couplings[1].first, 2u);
  EXPECT_EQ(found.couplings[1].deforming_poses, kPoses);
  EXPECT_EQ(found.couplings[3].group, 1u);
  EXPECT_EQ(found.coupled_reduced(0, 0), kPoses);
  EXPECT_EQ(found.coupled_reduced(0, 4), 0u);
}

TEST(Identify, DoesNotCoupleErrorsOfDifferentFrames) {
  const Result found = identified([](auto e, std::size_t) { return std::abs(e[0] * e[2]); });
  EXPECT_EQ(test::elements(found.coupled), (Verdicts{0, 0, 0, 0, 0, 0}));
  EXPECT_TRUE(found.couplings.empty());
}

TEST(Identify, FindsOverlappingPairs) {
  // Both pairs (c, d) and (c, f) deform. Without c no deformation is left; without d it is reduced by much less than 90
  // %.
  ModelDescription three = model();
  three.factors[5].limb = 1;
  three.factors[5].frame = 1;
  const auto found = identify(analysis(), three,
                              solver([](auto e, std::size_t) { return std::abs(e[2] * e[3]) + std::abs(e[2] * e[5]); }))
                         .value();
  EXPECT_EQ(test::elements(found.coupled), (Verdicts{0, 0, 1, 1, 0, 1}));
  EXPECT_EQ(found.couplings.size(), 4u);
}

TEST(Identify, CallsRoundingZeroAndAnythingAboveDeformed) {
  EXPECT_EQ(identified([](auto e, std::size_t) { return e[0] != 0.0 ? kRounding : 0.0; }).single(0), 0);
  EXPECT_EQ(identified([](auto e, std::size_t) { return e[0] != 0.0 ? 1.01 * kRounding : 0.0; }).single(0), 1);
}

TEST(Identify, AsksForAShareOfThePoses) {
  // An error is negligible if 19 of 20 poses are not deformed. One deformed pose is allowed, two are not.
  const auto deformed_at = [](std::size_t poses) {
    return [poses](auto e, std::size_t pose) { return pose < poses ? std::abs(e[0]) : 0.0; };
  };
  EXPECT_EQ(identified(deformed_at(1)).required_poses, 19u);
  EXPECT_EQ(identified(deformed_at(1)).single(0), 0);
  EXPECT_EQ(identified(deformed_at(2)).single(0), 1);
  EXPECT_EQ(identified(deformed_at(2)).single_below(0, 0), 18u);
}

TEST(Identify, AsksForOnePoseAtLeast) {
  Analysis hardly = analysis();
  asked_of<Options>(hardly).pose_share = 0.01;
  const Result found = identified([](auto e, std::size_t) { return std::abs(e[0]); }, hardly);
  EXPECT_EQ(found.required_poses, 1u);
  EXPECT_EQ(test::elements(found.single), (Verdicts{1, 0, 0, 0, 0, 0}));
}

TEST(Identify, CountsAnUnsolvedPoseAsDeformed) {
  const Result found =
      identified([](auto e, std::size_t pose) { return e[0] != 0.0 && pose < 2 ? std::nan("") : 0.0; });
  EXPECT_EQ(found.single(0), 1);
  EXPECT_EQ(found.not_solved(0, 0), 2u);
  EXPECT_EQ(found.single_max(0, 0), 0.0);
}

TEST(Identify, KeepsGroupsApart) {
  const Result found = identified([](auto e, std::size_t) { return e[0] > 1e-3 ? 1.0 : 0.0; });
  EXPECT_EQ(found.single_by_group(0, 0), 1);
  EXPECT_EQ(found.single_by_group(1, 0), 0);
  EXPECT_EQ(found.single(0), 1);
}

TEST(Identify, StopsWhenTheSolvesStop) {
  EXPECT_FALSE(identify(analysis(), model(), [](const ErrorTable&) { return std::optional<EvaluationResult>(); }));
}

}  // namespace
}  // namespace poesy::identification
