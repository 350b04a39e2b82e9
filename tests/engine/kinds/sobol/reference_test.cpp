// Sobol' studies of functions whose indices are known.

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <string>
#include <vector>

#include "engine/kinds/sobol/kind.h"
#include "engine/kinds/study_run.h"
#include "tests/engine/kinds/sobol/shapley_coverage.h"
#include "tests/support/function_model.h"

namespace poesy::test {
namespace {

/// The first-order and the total index of one error or one group.
struct Indices {
  double S1;
  double ST;
};

struct Reference {
  std::string name;
  Distribution distribution;
  ErrorFunction function;
  double variance;  ///< NaN: not checked
  std::vector<Indices> indices;
};

double share(double error) { return 0.5 * (error + 1.0); }

ErrorFunction g_function(std::vector<double> a) {
  return [a](std::span<const double> x, double, std::span<double> y) {
    y[0] = 1.0;
    for (std::size_t p = 0; p < a.size(); ++p) y[0] *= (std::abs(2.0 * x[p]) + a[p]) / (1.0 + a[p]);
  };
}

void ishigami(std::span<const double> x, double, std::span<double> y) {
  const double s = std::sin(x[1]);
  y[0] = std::sin(x[0]) + 7.0 * s * s + 0.1 * std::pow(x[2], 4) * std::sin(x[0]);
}

void bratley(std::span<const double> x, double, std::span<double> y) {
  y[0] = 0.0;
  double product = 1.0;
  for (std::size_t p = 0; p < x.size(); ++p) {
    product *= share(x[p]);
    y[0] += p % 2 == 0 ? -product : product;
  }
}

void wing_weight(std::span<const double> x, double, std::span<double> y) {
  constexpr double kLow[] = {150.0, 220.0, 6.0, -10.0, 16.0, 0.5, 0.08, 2.5, 1700.0, 0.025};
  constexpr double kHigh[] = {200.0, 300.0, 10.0, 10.0, 45.0, 1.0, 0.18, 6.0, 2500.0, 0.08};
  double v[10];
  for (std::size_t p = 0; p < 10; ++p) v[p] = kLow[p] + (kHigh[p] - kLow[p]) * share(x[p]);
  const double c = std::cos(v[3] * std::numbers::pi / 180.0);
  y[0] = 0.036 * std::pow(v[0], 0.758) * std::pow(v[1], 0.0035) * std::pow(v[2] / (c * c), 0.6) *
             std::pow(v[4], 0.006) * std::pow(v[5], 0.04) * std::pow(100.0 * v[6] / c, -0.3) *
             std::pow(v[7] * v[8], 0.49) +
         v[0] * v[9];
}

void folded(std::span<const double> x, double, std::span<double> y) {
  y[0] = std::abs(std::sqrt(0.8) * x[0] + std::sqrt(0.2) * x[1]);
}

void unfolded(std::span<const double> x, double, std::span<double> y) {
  y[0] = std::sqrt(0.8) * x[0] + std::sqrt(0.2) * x[1];
}

const double kUnknown = std::nan("");

/// Placeholder for an index that the references do not give.
constexpr double kAny = -1.0;

std::vector<Reference> references() {
  const Distribution unit = Distribution::uniform(1.0);
  const Distribution normal = Distribution::normal(1.0);
  std::vector<Indices> eight(8, {0.03708351, 0.27781263});
  return {{"Ishigami",
           Distribution::uniform(std::numbers::pi),
           ishigami,
           13.844587940719254,
           {{0.31390519114781, 0.55758885520996}, {0.44241114479004, 0.44241114479004}, {0.0, 0.24368366406215}}},
          {"SobolG",
           unit,
           g_function({0.0, 1.0, 4.5, 9.0, 99.0, 99.0, 99.0, 99.0}),
           0.4654244319,
           {{0.71619217, 0.78714413},
            {0.17904804, 0.24219819},
            {0.02367577, 0.03431691},
            {0.00716192, 0.01046039},
            {0.00007162, 0.00010495},
            {0.00007162, 0.00010495},
            {0.00007162, 0.00010495},
            {0.00007162, 0.00010495}}},
          {"SobolGOfThree",
           unit,
           g_function({0.0, 0.0, 0.0}),
           kUnknown,
           {{9.0 / 37.0, 0.43243243}, {9.0 / 37.0, 0.43243243}, {9.0 / 37.0, 0.43243243}}},
          {"SobolGOfEight", unit, g_function(std::vector<double>(8, 0.0)), kUnknown, eight},
          {"Bratley",
           unit,
           bratley,
           0.05551374032,
           {{0.6658664, 0.7493998},
            {0.16744438, 0.25097778},
            {0.04137292, 0.0828825},
            {0.01058803, 0.02815381},
            {0.00252532, 0.0090422},
            {0.00069289, 0.00325081},
            {0.00014316, 0.00093425},
            {0.00005154, 0.00041946},
            {0.00000573, 0.00007627},
            {0.00000573, 0.00007627}}},
          {"WingWeight",
           unit,
           wing_weight,
           2311.92627331,
           {{0.12447309, 0.12790017},
            {kAny, kAny},
            {0.22024025, 0.22601218},
            {kAny, kAny},
            {kAny, kAny},
            {kAny, kAny},
            {0.14098264, 0.14507106},
            {0.41160967, 0.41964760},
            {0.08496758, 0.08760003},
            {kAny, kAny}}},
          {"Folded", normal, folded, kUnknown, {{0.59887592, 0.96484301}, {0.03515699, 0.40112408}}},
          {"Unfolded", normal, unfolded, 1.0, {{0.8, 0.8}, {0.2, 0.2}}}};
}

/// Runs a study of a function. places: the poses.
sobol::Result run(const Study& study, const FunctionModel& model, std::vector<double> places = {0.5},
                  std::size_t threads = 2) {
  const auto result = run_study(study, model, PoseSet(1, std::move(places)), {.threads = threads});
  return result->as<sobol::Result>();
}

struct Case {
  Reference reference;
  sobol::Design design;
};

class Of : public ::testing::TestWithParam<Case> {};

std::vector<Case> cases() {
  std::vector<Case> list;
  for (const Reference& reference : references()) {
    for (const sobol::Design design : {sobol::Design::random, sobol::Design::lhs, sobol::Design::sobol})
      list.push_back({reference, design});
  }
  return list;
}

std::string case_name(const ::testing::TestParamInfo<Case>& info) {
  std::string by(name(info.param.design));
  by.front() = static_cast<char>(std::toupper(static_cast<unsigned char>(by.front())));
  return info.param.reference.name + by;
}

// About 300 intervals with a level of 1 - 1e-5 each, so alpha is below 0.3 % for all of them together.
TEST_P(Of, AreWithinTheirIntervals) {
  const auto& [reference, design] = GetParam();
  const FunctionModel model(reference.indices.size(), {"y"}, reference.function);
  const CatalogEntry entry{model.description(), nullptr};
  Study study = function_study(entry, sobol::kStudy, reference.distribution, 65536);
  study.analysis.conf_level = 1.0 - 1e-5;
  asked_of<sobol::Options>(study.analysis).design = design;
  const sobol::Result found = run(study, model);
  for (std::size_t p = 0; p < reference.indices.size(); ++p) {
    const auto [S1, ST] = reference.indices[p];
    if (S1 == kAny) continue;
    EXPECT_LE(found.aggregated.S1.ci_low(0, p), S1 + 5e-9) << p;
    EXPECT_GE(found.aggregated.S1.ci_high(0, p), S1 - 5e-9) << p;
    EXPECT_LE(found.aggregated.ST.ci_low(0, p), ST + 5e-9) << p;
    EXPECT_GE(found.aggregated.ST.ci_high(0, p), ST - 5e-9) << p;
    EXPECT_LT(found.aggregated.ST.ci_high(0, p) - found.aggregated.ST.ci_low(0, p), 0.35) << p;
  }
  if (std::isnan(reference.variance)) return;
  EXPECT_NEAR(found.variance(0, 0), reference.variance, 0.03 * reference.variance);
}

INSTANTIATE_TEST_SUITE_P(Indices, Of, ::testing::ValuesIn(cases()), case_name);

TEST(SobolPanel, AbsorbedErrorsAreZeroInEveryBit) {
  const auto function = [](std::span<const double> x, double, std::span<double> y) { y[0] = std::exp(x[0] + x[2]); };
  const FunctionModel model(3, {"y"}, function);
  const CatalogEntry entry{model.description(), nullptr};
  const sobol::Result found = run(function_study(entry, sobol::kStudy, Distribution::normal(1.0), 300), model);
  for (const auto* shares : {&found.at_poses.S1, &found.at_poses.ST}) {
    for (const auto* values : {&shares->value, &shares->ci_low, &shares->ci_high}) EXPECT_EQ((*values)(0, 1, 0), 0.0);
  }
  EXPECT_GT(found.at_poses.ST.value(0, 0, 0), 0.1);
}

/// A vector of three responses that is linear in the errors and grows with `place`.
void linear_vector(std::span<const double> x, double place, std::span<double> y) {
  y[0] = (1.0 + place) * (2.0 * x[0] + 1.0 * x[1]);
  y[1] = 0.5 * x[0] - 3.0 * x[2];
  y[2] = place * x[1];
}

TEST(SobolPanel, LinearVectorsHaveMeanSquareShares) {
  const FunctionModel model(3, {"tip_x", "tip_y", "tip_z"}, linear_vector);
  const CatalogEntry entry{model.description(), nullptr};
  Study study = function_study(entry, sobol::kStudy, Distribution::normal(0.1), 20000);
  study.analysis.conf_level = 1.0 - 1e-4;
  const sobol::Result found = run(study, model, {0.0, 1.0});
  // The sums of the squared coefficients over both places.
  const double squares[] = {4.0 + 16.0 + 2.0 * 0.25, 1.0 + 4.0 + 1.0, 2.0 * 9.0};
  const double all = squares[0] + squares[1] + squares[2];
  ASSERT_EQ(found.vectors, std::vector<std::string>{"tip"});
  double sum_low = 0.0;
  double sum_high = 0.0;
  for (std::size_t p = 0; p < 3; ++p) {
    for (const auto* ends : {&found.of_vectors.S1.ci_low, &found.of_vectors.ST.ci_low}) {
      EXPECT_LT((*ends)(0, p), squares[p] / all);
    }
    for (const auto* ends : {&found.of_vectors.S1.ci_high, &found.of_vectors.ST.ci_high}) {
      EXPECT_GT((*ends)(0, p), squares[p] / all);
    }
    sum_low += found.of_vectors.ST.ci_low(0, p);
    sum_high += found.of_vectors.ST.ci_high(0, p);
  }
  EXPECT_LT(sum_low, 1.0);
  EXPECT_GT(sum_high, 1.0);
}

TEST(SobolPanel, AggregatesPosesByTheirVariances) {
  // The variance is 1 at place 0, all from x1, and 4 at place 1, all from x2.
  const auto function = [](std::span<const double> x, double place, std::span<double> y) {
    y[0] = place == 0.0 ? x[0] : 2.0 * x[1];
  };
  const FunctionModel model(2, {"y"}, function);
  const CatalogEntry entry{model.description(), nullptr};
  Study study = function_study(entry, sobol::kStudy, Distribution::normal(1.0), 20000);
  study.analysis.conf_level = 1.0 - 1e-4;
  const sobol::Result found = run(study, model, {0.0, 1.0});
  EXPECT_LT(found.aggregated.ST.ci_low(0, 0), 0.2);
  EXPECT_GT(found.aggregated.ST.ci_high(0, 0), 0.2);
  EXPECT_LT(found.aggregated.ST.ci_low(0, 1), 0.8);
  EXPECT_GT(found.aggregated.ST.ci_high(0, 1), 0.8);
  EXPECT_TRUE(std::ranges::equal(found.at_poses.ST.value, std::vector{1.0, 0.0, 0.0, 1.0}));
}

TEST(SobolPanel, FindsTheInteractionOfIshigamisFirstAndThird) {
  const FunctionModel model(3, {"y"}, ishigami);
  const CatalogEntry entry{model.description(), nullptr};
  Study study = function_study(entry, sobol::kStudy, Distribution::uniform(std::numbers::pi), 20000);
  study.analysis.conf_level = 1.0 - 1e-4;
  asked_of<sobol::Options>(study.analysis).second_order = true;
  const sobol::Result found = run(study, model);
  const auto expect_within = [&](std::size_t i, std::size_t j, double S2) {
    EXPECT_LT(found.S2.ci_low(0, i, j), S2);
    EXPECT_GT(found.S2.ci_high(0, i, j), S2);
    EXPECT_EQ(found.S2.value(0, i, j), found.S2.value(0, j, i));
  };
  expect_within(0, 2, 0.24368366406215);
  expect_within(0, 1, 0.0);
  expect_within(1, 2, 0.0);
  EXPECT_TRUE(std::isnan(found.S2.value(0, 0, 0)));
}

TEST(SobolPanel, TakesErrorsOfAGroupTogether) {
  const FunctionModel model(3, {"y"}, ishigami);
  const CatalogEntry entry{model.description(), nullptr};
  Study study = function_study(entry, sobol::kStudy, Distribution::uniform(std::numbers::pi), 20000);
  study.analysis.conf_level = 1.0 - 1e-4;
  sobol::Options& asked = asked_of<sobol::Options>(study.analysis);
  asked.groups_by = sobol::GroupsBy::name;
  asked.named_groups = {{"both", {"x1", "x3"}}};
  const sobol::Result found = run(study, model);
  EXPECT_EQ(found.group_names, (std::vector<std::string>{"both", "others"}));
  EXPECT_EQ(found.group_members, (std::vector<std::string>{"x1 x3", "x2"}));
  const double closed = 1.0 - 0.44241114479004;
  for (const auto* ends : {&found.aggregated.S1.ci_low, &found.aggregated.ST.ci_low}) EXPECT_LT((*ends)(0, 0), closed);
  for (const auto* ends : {&found.aggregated.S1.ci_high, &found.aggregated.ST.ci_high})
    EXPECT_GT((*ends)(0, 0), closed);
}

TEST(SobolPanel, EndsWhenEveryIntervalIsNarrowEnough) {
  const FunctionModel model(3, {"y"}, ishigami);
  const CatalogEntry entry{model.description(), nullptr};
  Study study = function_study(entry, sobol::kStudy, Distribution::uniform(std::numbers::pi), 100'000);
  study.analysis.adaptive = {.min = 1000, .relative_error = 0.05};
  const sobol::Result found = run(study, model);
  ASSERT_TRUE(found.convergence);
  EXPECT_GT(found.n(0, 0, 0), 1000u);
  EXPECT_LT(found.n(0, 0, 0), 100'000u);
  double widest = 0.0;
  for (std::size_t p = 0; p < 3; ++p) {
    widest = std::max(widest, 0.5 * (found.aggregated.ST.ci_high(0, p) - found.aggregated.ST.ci_low(0, p)));
  }
  EXPECT_LE(widest, 0.05 * *std::ranges::max_element(found.aggregated.ST.value));
  Study fixed = study;
  fixed.analysis.adaptive.reset();
  fixed.analysis.samples = found.n(0, 0, 0);
  EXPECT_EQ(run(fixed, model).aggregated.ST.value, found.aggregated.ST.value);
}

void expect_shapley(const sobol::Result& found, const std::vector<double>& expected) {
  double sum = 0.0;
  for (std::size_t p = 0; p < expected.size(); ++p) {
    EXPECT_LE(found.Sh.ci_low(0, p), expected[p] + 5e-9) << p;
    EXPECT_GE(found.Sh.ci_high(0, p), expected[p] - 5e-9) << p;
    EXPECT_LT(found.Sh.ci_high(0, p) - found.Sh.ci_low(0, p), 0.03) << p;
    sum += found.Sh.value(0, p);
  }
  EXPECT_NEAR(sum, 1.0, 1e-12);
}

class KnownShapley : public ::testing::TestWithParam<sobol::Design> {};

// 13 intervals at a level of 1 - 1e-5 for each design. The linear function's effects are known in closed form (Owen and
// Prieur 2017, SIAM/ASA J. Uncertain. Quantif. 5, 986-1002).
TEST_P(KnownShapley, IsWithinItsInterval) {
  const FunctionModel model(3, {"y"}, sum_of_three);
  const CatalogEntry entry{model.description(), nullptr};
  Study study = correlated_study(entry, 65536);
  study.analysis.conf_level = 1.0 - 1e-5;
  asked_of<sobol::Options>(study.analysis).design = GetParam();
  asked_of<sobol::Options>(study.analysis).shapley = true;
  const sobol::Result found = run(study, model);
  expect_shapley(found, {0.10416667, 0.41822917, 0.47760417});
  EXPECT_NEAR(found.variance(0, 0), 9.6, 0.3);
  // The first error is independent of the others, so its S1 and ST are known too. Correlated errors have no S1 and ST.
  EXPECT_LE(found.aggregated.S1.ci_low(0, 0), 1.0 / 9.6);
  EXPECT_GE(found.aggregated.S1.ci_high(0, 0), 1.0 / 9.6);
  EXPECT_LE(found.aggregated.ST.ci_low(0, 0), 1.0 / 9.6);
  EXPECT_GE(found.aggregated.ST.ci_high(0, 0), 1.0 / 9.6);
  for (const std::size_t p : {1U, 2U}) {
    EXPECT_TRUE(std::isnan(found.aggregated.S1.value(0, p)));
    EXPECT_TRUE(std::isnan(found.aggregated.ST.ci_high(0, p)));
    EXPECT_TRUE(std::isnan(found.at_poses.ST.value(0, p, 0)));
  }
}

INSTANTIATE_TEST_SUITE_P(Designs, KnownShapley,
                         ::testing::Values(sobol::Design::random, sobol::Design::lhs, sobol::Design::sobol),
                         [](const auto& of) { return std::string(name(of.param)); });

// For independent errors the Shapley effect is S1 plus an equal part of each interaction. The first and the third error
// of the Ishigami function each get half of their interaction.
TEST(SobolPanel, ShapleyEffectsDivideInteractionsEvenly) {
  const FunctionModel model(4, {"y"}, ishigami);
  const CatalogEntry entry{model.description(), nullptr};
  Study study = function_study(entry, sobol::kStudy, Distribution::uniform(std::numbers::pi), 65536);
  study.analysis.conf_level = 1.0 - 1e-5;
  asked_of<sobol::Options>(study.analysis).shapley = true;
  const sobol::Result found = run(study, model);
  const double half = 0.5 * 0.24368366406215;
  expect_shapley(found, {0.31390519114781 + half, 0.44241114479004, half, 0.0});
  EXPECT_EQ(found.Sh.value(0, 3), 0.0);
  EXPECT_EQ(found.Sh.ci_high(0, 3), 0.0);
  asked_of<sobol::Options>(study.analysis).shapley = false;
  EXPECT_EQ(run(study, model).aggregated.ST.value, found.aggregated.ST.value);
}

TEST(SobolPanel, GroupsThatHoldCorrelatedErrorsHaveIndices) {
  const FunctionModel model(3, {"y"}, sum_of_three);
  const CatalogEntry entry{model.description(), nullptr};
  Study study = correlated_study(entry, 20000);
  study.analysis.conf_level = 1.0 - 1e-5;
  sobol::Options& asked = asked_of<sobol::Options>(study.analysis);
  asked.groups_by = sobol::GroupsBy::name;
  asked.named_groups = {{"two", {"x2", "x3"}}};
  asked.shapley = true;
  const sobol::Result found = run(study, model);
  const double two = 8.6 / 9.6;
  expect_shapley(found, {two, 1.0 - two});
  for (const auto* ends : {&found.aggregated.S1.ci_low, &found.aggregated.ST.ci_low}) EXPECT_LT((*ends)(0, 0), two);
  for (const auto* ends : {&found.aggregated.S1.ci_high, &found.aggregated.ST.ci_high}) EXPECT_GT((*ends)(0, 0), two);
}

// The product is symmetric in both errors, which have the same distribution, so each effect is one half.
TEST(SobolPanel, ShapleyEffectsOfTwoThatAreAlikeAreEqual) {
  const auto product = [](std::span<const double> x, double, std::span<double> y) { y[0] = x[0] * x[1]; };
  const FunctionModel model(2, {"y"}, product);
  const CatalogEntry entry{model.description(), nullptr};
  for (const Distribution& distribution : {Distribution::normal(1.0), Distribution::uniform(2.0)}) {
    Study study = function_study(entry, sobol::kStudy, distribution, 20000);
    study.errors.correlated = {{{FactorIndex(0), FactorIndex(1)}, {1.0, 0.7, 0.7, 1.0}}};
    study.analysis.conf_level = 1.0 - 1e-5;
    asked_of<sobol::Options>(study.analysis).shapley = true;
    const sobol::Result found = run(study, model);
    EXPECT_LT(found.Sh.ci_low(0, 0), 0.5);
    EXPECT_GT(found.Sh.ci_high(0, 0), 0.5);
    EXPECT_LT(found.Sh.ci_high(0, 0) - found.Sh.ci_low(0, 0), 0.1);
  }
}

TEST(SobolPanel, ShapleyEffectsHaveTheSameBitsOnOneThread) {
  const FunctionModel model(3, {"y"}, sum_of_three);
  const CatalogEntry entry{model.description(), nullptr};
  Study study = correlated_study(entry, 1000);
  asked_of<sobol::Options>(study.analysis).shapley = true;
  const sobol::Result one = run(study, model, {0.2, 0.4}, 1);
  const sobol::Result two = run(study, model, {0.2, 0.4}, 2);
  EXPECT_EQ(one.Sh.value, two.Sh.value);
  EXPECT_EQ(one.Sh.ci_low, two.Sh.ci_low);
}

TEST(SobolPanel, SaysWhichResponsesHaveNoSign) {
  const auto function = [](std::span<const double> x, double, std::span<double> y) {
    y[0] = x[0];
    y[1] = std::abs(x[1]);
  };
  const FunctionModel model(2, {"signed", "length"}, function);
  const CatalogEntry entry{model.description(), nullptr};
  const sobol::Result found = run(function_study(entry, sobol::kStudy, Distribution::normal(1.0), 300), model);
  EXPECT_TRUE(std::ranges::equal(found.without_sign, std::vector{0, 1}));
}

}  // namespace
}  // namespace poesy::test
