#include "engine/kinds/coupling/coupling.h"
#include "engine/run/evaluation.h"
#include "engine/stats/indices.h"

#include <gtest/gtest.h>

#include <cmath>
#include <functional>

#include "tests/support/elements.h"
#include "tests/support/fake_model.h"

namespace poesy::coupling {
namespace {

using Choice = ErrorPattern::Choice;

constexpr double kSize = 1e-3;

/// A response as a function of all errors of the model (m) at pose m.
using Effect = std::function<double(std::span<const double> errors, std::size_t m)>;

/// The evaluation of a table of errors by a model whose responses are these functions.
EvaluationResult evaluation_of(const ErrorTable& table, std::size_t factors, std::size_t poses,
                               const std::vector<Effect>& responses) {
  EvaluationResult result;
  result.response = decltype(result.response)({responses.size(), poses, table.rows});
  result.status = decltype(result.status)({poses, table.rows}, SolveStatus::converged);
  result.iterations = decltype(result.iterations)({poses, table.rows}, 2);
  for (std::size_t r = 0; r < responses.size(); ++r) {
    for (std::size_t m = 0; m < poses; ++m) {
      for (std::size_t row = 0; row < table.rows; ++row) {
        std::vector<double> errors(factors, 0.0);
        for (std::size_t v = 0; v < table.factors.size(); ++v) {
          errors[table.factors[v].value] = table.values[row * table.factors.size() + v];
        }
        result.response(r, m, row) = responses[r](errors, m);
      }
    }
  }
  return result;
}

/// The rounding thresholds for responses that are computed without rounding errors.
Array<double, axis::Response, axis::Size> rounding_of(const Options& study, std::size_t responses) {
  Array<double, axis::Response, axis::Size> rounding({responses, study.sizes()});
  for (std::size_t r = 0; r < responses; ++r) {
    for (std::size_t z = 0; z < study.sizes(); ++z) rounding(r, z) = size_rounding(0.0, study.linear[z], 0.0);
  }
  return rounding;
}

/// Two limbs with three lengths each: a_x, a_y and the scalar q. Source A has the errors a of both limbs, source Q the
/// errors q.
class CouplingOfSixErrors : public testing::Test {
 protected:
  static constexpr std::size_t kPoses = 3;

  CouplingOfSixErrors() {
    for (std::size_t limb = 1; limb <= 2; ++limb) {
      model_.factors.push_back({"a_x", Dimension::length, limb, 0, "", "x"});
      model_.factors.push_back({"a_y", Dimension::length, limb, 0, "", "y"});
      model_.factors.push_back({"q", Dimension::length, limb, 1, ""});
    }
    study_.linear = {kSize, 2.0 * kSize};
    study_.sources = {{"A", {FactorIndex(0), FactorIndex(1), FactorIndex(3), FactorIndex(4)}},
                      {"Q", {FactorIndex(2), FactorIndex(5)}}};
  }

  /// A signed response: a weighted sum of the errors, and a product of one error of each source. If all errors have the
  /// size e, source A alone gives 4 e at every pose, and source Q alone gives -5 e, -2 e and e at the three poses.
  static double bilinear(std::span<const double> e, std::size_t m) {
    const double q = 3.0 * static_cast<double>(m) - 5.0;
    return 3.0 * e[0] - 1.0 * e[1] + 4.0 * e[3] - 2.0 * e[4] + q * e[2] + 7.0 * e[0] * e[5];
  }

  Result solve(const std::vector<Effect>& responses) const {
    return coupling_result(evaluation_of(coupling_table(study_, model_), 6, kPoses, responses), study_, model_,
                           NotConverged::exclude, rounding_of(study_, responses.size()));
  }

  ModelDescription model_;
  Options study_;
};

TEST_F(CouplingOfSixErrors, HasClosedFormsWhereBlocksAreSources) {
  const Result found = solve({bilinear});
  ASSERT_EQ(found.effect.size(), 18u);
  const double q[] = {-5.0, -2.0, 1.0};
  for (std::size_t z = 0; z < 2; ++z) {
    const double e = study_.linear[z];
    for (std::size_t m = 0; m < kPoses; ++m) {
      EXPECT_NEAR(found.effect(0, z, 0, m), 4.0 * e, 1e-17);
      EXPECT_NEAR(found.effect(0, z, 1, m), q[m] * e, 1e-17);
      EXPECT_EQ(found.interaction(0, z, 0, m), 0.0);
      EXPECT_EQ(found.cancellation(0, z, 1, m), 0.0);
      EXPECT_EQ(found.first_order_sum(0, z, 1, m), std::abs(found.effect(0, z, 1, m)));
      EXPECT_NEAR(found.sum(0, z, 2, m), (4.0 + q[m]) * e, 1e-17);
      EXPECT_NEAR(found.effect(0, z, 2, m), (4.0 + q[m]) * e + 7.0 * e * e, 1e-17);
      EXPECT_NEAR(found.interaction(0, z, 2, m), 7.0 * e * e, 1e-17);
      EXPECT_NEAR(found.first_order_sum(0, z, 2, m), (4.0 + std::abs(q[m])) * e, 1e-17);
      EXPECT_NEAR(found.root_sum_square(0, z, 2, m), std::hypot(4.0, q[m]) * e, 1e-17);
      EXPECT_NEAR(found.cancellation(0, z, 2, m), 1.0 - std::abs(4.0 + q[m]) / (4.0 + std::abs(q[m])), 1e-14);
    }
  }
}

TEST_F(CouplingOfSixErrors, SumsUpOverThePoses) {
  const Result found = solve({bilinear});
  const double e = kSize;
  EXPECT_EQ(found.count(0, 0, 2), kPoses);
  EXPECT_NEAR(found.effect_max(0, 0, 2), 5.0 * e + 7.0 * e * e, 1e-17);
  EXPECT_EQ(found.effect_max_pose(0, 0, 2), 2);
  EXPECT_NEAR(found.interaction_max(0, 0, 2), 7.0 * e * e, 1e-17);
  EXPECT_NEAR(found.first_order_sum_max(0, 0, 2), 9.0 * e, 1e-17);
  EXPECT_NEAR(found.root_sum_square_max(0, 0, 2), std::hypot(4.0, 5.0) * e, 1e-17);
  EXPECT_DOUBLE_EQ(found.opposed_share(0, 0, 2), 2.0 / 3.0);  // at two of three poses: |4 - 5| < 5 and |4 - 2| < 4
  EXPECT_NEAR(found.cancellation_max(0, 0, 2), 8.0 / 9.0, 1e-14);
  EXPECT_EQ(found.cancellation_max_pose(0, 0, 2), 0);
  EXPECT_EQ(found.effect_max_pose(0, 0, 0), 0);  // all poses are equal, so the first
  EXPECT_EQ(found.opposed_share(0, 0, 0), 0.0);
}

TEST_F(CouplingOfSixErrors, TakesBlocksOnTheirOwnInTheFirstOrderSum) {
  const auto worst_of_a = [&](Choice limbs, Choice components) {
    study_.pattern = {limbs, 0, components, {}};
    const Result found = solve({bilinear});
    EXPECT_NEAR(found.effect(0, 0, 0, 1), 4.0 * kSize, 1e-17);  // for every pattern
    return std::pair(found.first_order_sum(0, 0, 0, 1) / kSize, found.root_sum_square(0, 0, 0, 1) / kSize);
  };
  const auto near = [](std::pair<double, double> found, double worst, double squares) {
    EXPECT_NEAR(found.first, worst, 1e-13);
    EXPECT_NEAR(found.second, std::sqrt(squares), 1e-13);
  };
  near(worst_of_a(Choice::all, Choice::all), 4.0, 16.0);
  near(worst_of_a(Choice::independent, Choice::all), 4.0, 8.0);            // limbs: 2 and 2
  near(worst_of_a(Choice::all, Choice::independent), 10.0, 58.0);          // components: 7 and -3
  near(worst_of_a(Choice::independent, Choice::independent), 10.0, 30.0);  // errors: 3, -1, 4, -2
}

TEST_F(CouplingOfSixErrors, KnowsNoOppositionWhereAResponseIsANorm) {
  const Result found = solve({[](auto errors, std::size_t m) { return std::abs(bilinear(errors, m)); }});
  for (std::size_t m = 0; m < kPoses; ++m) {
    EXPECT_EQ(found.cancellation(0, 0, 2, m), 0.0);
    EXPECT_EQ(found.sum(0, 0, 2, m), found.first_order_sum(0, 0, 2, m));
    EXPECT_LE(found.effect(0, 0, 2, m), found.first_order_sum(0, 0, 2, m) + 7.0 * kSize * kSize);
  }
  EXPECT_EQ(found.opposed_share(0, 0, 2), 0.0);
}

TEST_F(CouplingOfSixErrors, TakesRoundingForNothing) {
  const Result found =
      solve({[](std::span<const double> errors, std::size_t) { return 1e-12 * errors[0] - 1e-12 * errors[2]; }});
  EXPECT_EQ(found.cancellation(0, 0, 2, 0), 0.0);
  EXPECT_EQ(found.opposed_share(0, 0, 2), 0.0);
}

TEST_F(CouplingOfSixErrors, LeavesOutWhatDoesNotCount) {
  study_.pattern.limbs = Choice::independent;
  const ErrorTable table = coupling_table(study_, model_);
  const std::size_t rows = table.rows / 2;
  ASSERT_EQ(rows, 7u);  // A, Q, A+Q, and the two limbs of A and of Q
  EvaluationResult some = evaluation_of(table, 6, kPoses, {bilinear});
  some.status(0, 0) = SolveStatus::singular;       // pose 0: source A
  some.status(1, 6) = SolveStatus::iteration_cap;  // pose 1: one limb of Q
  some.status(2, rows) = SolveStatus::non_finite;  // pose 2, second size: source A
  const auto found_with = [&](NotConverged policy) {
    return coupling_result(some, study_, model_, policy, rounding_of(study_, 1));
  };
  const Result exclude = found_with(NotConverged::exclude);
  EXPECT_EQ(test::elements(exclude.count), (std::vector<std::uint64_t>{2, 2, 1, 2, 3, 2}));
  EXPECT_TRUE(std::isnan(exclude.effect(0, 0, 0, 0)));
  EXPECT_FALSE(std::isnan(exclude.effect(0, 0, 2, 0)));
  EXPECT_TRUE(std::isnan(exclude.interaction(0, 0, 2, 0)));
  EXPECT_TRUE(std::isnan(exclude.cancellation(0, 0, 2, 0)));
  EXPECT_TRUE(std::isnan(exclude.first_order_sum(0, 0, 1, 1)));
  EXPECT_FALSE(std::isnan(exclude.interaction(0, 0, 2, 1)));
  EXPECT_EQ(exclude.effect_max_pose(0, 0, 2), 2);
  EXPECT_EQ(test::elements(found_with(NotConverged::include).count), (std::vector<std::uint64_t>{2, 3, 2, 2, 3, 2}));
  EXPECT_EQ(exclude.solves.size(), 2 * kPoses);
  EXPECT_EQ(exclude.solves(0, 0).not_converged(), 1u);
  EXPECT_EQ(exclude.solves(0, 1).not_converged(), 1u);
  EXPECT_EQ(exclude.solves(0, 2).not_converged(), 0u);
  EXPECT_EQ(exclude.solves(1, 2).not_converged(), 1u);
  EXPECT_EQ(exclude.total().total(), table.rows * kPoses);
  std::ranges::fill(some.status, SolveStatus::singular);
  const Result nothing = found_with(NotConverged::include);
  EXPECT_TRUE(std::isnan(nothing.effect_max(0, 0, 0)));
  EXPECT_TRUE(std::isnan(nothing.opposed_share(0, 0, 0)));
  EXPECT_EQ(nothing.effect_max_pose(0, 0, 0), -1);
}

TEST(CouplingOfAMechanism, IsThatOfItsAbsoluteValues) {
  const test::FakeModel fake;
  const ModelDescription& model = fake.description();
  Options study{{1e-3}, {1e-2}, {}, {{"d", {FactorIndex(0)}}, {"e", {FactorIndex(1)}}, {"n", {FactorIndex(2)}}}};
  const PoseSet poses(3, {-0.2, 0.1, 0.2, -0.25, 0.3, -0.1});
  const auto evaluation = run_evaluation(fake, {}, poses, coupling_table(study, model),
                                         Pairing::every_pose_with_every_row, {1, {}, {}}, Outcomes::responses);
  const Result found =
      coupling_result(*evaluation, study, model, NotConverged::exclude, coupling_rounding(study, fake));
  ASSERT_EQ(found.subsets.size(), 7u);
  for (std::size_t r = 0; r < 2; ++r) {
    for (std::size_t m = 0; m < 2; ++m) {
      const auto weight = [&](std::size_t p) {
        return test::FakeModel::weight(test::FakeModel::kArm, r, p, poses[PoseIndex(m)]);
      };
      EXPECT_NEAR(found.effect(r, 0, 6, m), 1e-3 * weight(0) + 1e-2 * weight(1), 1e-17);
      EXPECT_NEAR(found.interaction(r, 0, 6, m), 0.0, 1e-17);
      EXPECT_NEAR(found.root_sum_square(r, 0, 6, m), std::hypot(1e-3 * weight(0), 1e-2 * weight(1)), 1e-17);
    }
  }
}

TEST(SubsetNames, AreJoined) {
  const std::vector<ErrorSource> sources{{"FS", {}}, {"T", {}}, {"R", {}}};
  EXPECT_EQ(subset_names(sources), (std::vector<std::string>{"FS", "T", "R", "FS+T", "FS+R", "T+R", "FS+T+R"}));
}

}  // namespace
}  // namespace poesy::coupling
