#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numbers>
#include <utility>

#include "engine/kinds/monte_carlo/kind.h"
#include "engine/kinds/monte_carlo/machine_table.h"
#include "engine/kinds/monte_carlo/result.h"
#include "engine/random/stream.h"
#include "engine/run/run_options.h"
#include "engine/stats/main_effects.h"
#include "tests/engine/stats/plain_sort.h"
#include "tests/engine/stats/yield_cases.h"
#include "tests/support/fake_model.h"
#include "tests/support/kinds.h"

namespace poesy::monte_carlo {
namespace {

/// The first response is y = a . e with a = (1, 2, 0.5), the second is |y| / 2. Both are the same at each pose.
class LinearModel : public test::FakeModel {
 public:
  static constexpr std::array<double, 3> kSlopes{1.0, 2.0, 0.5};

  std::unique_ptr<Evaluator> evaluator(const SolverOptions& /*options*/) const override {
    return std::make_unique<LinearEvaluator>();
  }

 private:
  class LinearEvaluator : public Evaluator {
   public:
    void evaluate(const SampleBlock& samples, const OutcomeBlock& outcomes) override {
      for (std::size_t b = 0; b < samples.count; ++b) {
        double sum = 0.0;
        for (std::size_t v = 0; v < samples.varied.size(); ++v) {
          sum += kSlopes[samples.varied[v].value] * samples.values[v * samples.count + b];
        }
        outcomes.responses[b] = sum;
        outcomes.responses[samples.count + b] = 0.5 * std::abs(sum);
        outcomes.status[b] = SolveStatus::converged;
        outcomes.iterations[b] = 1;
      }
    }
  };
};

/// The fake mechanism, but at poses with beta above zero machines whose first error exceeds kMost are not solved.
class FailingModel : public test::FakeModel {
 public:
  static constexpr double kMost = 1.5e-3;

  std::unique_ptr<Evaluator> evaluator(const SolverOptions& /*options*/) const override {
    return std::make_unique<FailingEvaluator>();
  }

 private:
  class FailingEvaluator : public test::FakeEvaluator {
   public:
    FailingEvaluator() : FakeEvaluator(kArm) {}

    void evaluate(const SampleBlock& samples, const OutcomeBlock& outcomes) override {
      FakeEvaluator::evaluate(samples, outcomes);
      for (std::size_t b = 0; b < samples.count; ++b) {
        if (samples.pose[1] > 0.0 && samples.values[b] > kMost) outcomes.status[b] = SolveStatus::iteration_cap;
      }
    }
  };
};

Study study_of(const Catalog& catalog, std::size_t poses, std::size_t machines, std::array<double, 3> sigma) {
  Study study;
  study.mechanism = {&catalog.front(), {test::FakeModel::kArm}, 0, {}};
  for (const double one : sigma) study.errors.by_factor.push_back(Distribution::normal(one));
  study.poses.count = poses;
  study.poses.workspace = {{-0.3, -0.2}, {-0.1, 0.1}, {-0.1, 0.1}};
  study.analysis.kind = &kStudy;
  study.analysis.factors = {FactorIndex(0), FactorIndex(1), FactorIndex(2)};
  study.analysis.samples = machines;
  study.analysis.draws = Draws::per_machine;
  asked_of<Options>(study.analysis).judge = Judge::yield;
  study.seed = 3;
  return study;
}

Result run(const Study& study, const Model& model, std::size_t threads = 2) {
  RunOptions options;
  options.threads = threads;
  return run_monte_carlo(Plan(study, select_poses(study.poses, model).poses), model, study.analysis, options).value();
}

/// Expects that the main effects of the first response are straight lines with the slopes of LinearModel.
void expect_lines(const EffectResult& found) {
  const MainEffects& effects = found.effects;
  for (std::size_t p = 0; p < 3; ++p) {
    for (std::size_t b = 0; b < kEffectBins; ++b) {
      const double half = 0.5 * (effects.ci_high(0, p, b) - effects.ci_low(0, p, b));
      EXPECT_NEAR(effects.mean(0, p, b), LinearModel::kSlopes[p] * found.bin_error(p, b), half * 4.9 / 1.96);
    }
  }
}

/// Compares yield, gradient and first-order indices with their closed forms. The limit is |y| <= 0.3.
TEST(Machines, FindTheYieldOfALinearModel) {
  constexpr std::size_t kMachines = 40'500;
  const Catalog catalog = test::fake_catalog();
  Study study = study_of(catalog, 3, kMachines, {0.1, 0.05, 0.2});
  study.analysis.limits = {{0, 0.3}};
  const Result found = run(study, LinearModel());
  ASSERT_TRUE(found.machines && found.machines->yield);
  const YieldResult& yield = *found.machines->yield;
  constexpr double kYield = 0.9167354833;
  constexpr double kErrors = 3.9;  // alpha 1e-4, seven comparisons
  EXPECT_NEAR(yield.value, kYield, kErrors * std::sqrt(kYield * (1.0 - kYield) / kMachines));
  EXPECT_EQ(yield.machines, kMachines);
  EXPECT_EQ(yield.rejects, static_cast<std::uint64_t>(std::lround((1.0 - yield.value) * kMachines)));
  EXPECT_EQ(yield.by_response(0), yield.value);
  EXPECT_TRUE(std::isnan(yield.by_response(1)));
  for (std::size_t m = 0; m < 3; ++m) EXPECT_DOUBLE_EQ(yield.worst_pose_share(0, m), 1.0 - yield.value);
  constexpr std::array kGradient{-1.02786887, -2.05573773, -0.51393443};
  for (std::size_t p = 0; p < 3; ++p) {
    const double half = 0.5 * (yield.gradient_ci_high(p) - yield.gradient_ci_low(p));
    EXPECT_NEAR(yield.gradient(p), kGradient[p], half * kErrors / 1.96);
    EXPECT_LT(half, 0.1 * std::abs(kGradient[p]));
    // Each error causes a third of the variance.
    EXPECT_NEAR(found.effects.effects.s1(0, p), 1.0 / 3.0, 0.02);
    EXPECT_LT(found.effects.effects.s1_ci_low(0, p), 1.0 / 3.0);
    EXPECT_GT(found.effects.effects.s1_ci_high(0, p), 1.0 / 3.0);
  }
  expect_lines(found.effects);
}

/// The mean of each error is +shift or -shift, with equal probability. The expected yield is the mean over the signs of
/// the probability that a normal sum is within the limit. The likelihood-ratio gradient does not exist for shifted
/// errors.
TEST(Machines, FindTheYieldOfShiftedErrors) {
  constexpr std::size_t kMachines = 40'500;
  constexpr std::array kSigma{0.1, 0.05, 0.2};
  constexpr std::array kShift{0.164, 0.04, 0.0};
  const Catalog catalog = test::fake_catalog();
  Study study = study_of(catalog, 1, kMachines, kSigma);
  for (std::size_t p = 0; p < 3; ++p) {
    study.errors.by_factor[p] = Distribution::normal(kSigma[p]).shifted(kShift[p]);
  }
  study.analysis.limits = {{0, 0.3}};
  const Result found = run(study, LinearModel());
  const YieldResult& yield = *found.machines->yield;
  const double deviation = 0.1 * std::sqrt(3.0);
  double expected = 0.0;
  for (const double mean : {0.244, 0.084, -0.084, -0.244}) {  // +-0.164 +- 2 x 0.04
    const auto below = [&](double y) { return 0.5 * std::erfc((mean - y) / deviation / std::sqrt(2.0)); };
    expected += 0.25 * (below(0.3) - below(-0.3));
  }
  constexpr double kErrors = 3.9;
  EXPECT_NEAR(yield.value, expected, kErrors * std::sqrt(expected * (1.0 - expected) / kMachines));
  EXPECT_TRUE(std::isnan(yield.gradient(0)) && std::isnan(yield.gradient_ci_low(0)));
  EXPECT_TRUE(std::isnan(yield.gradient(1)) && std::isnan(yield.gradient_ci_high(1)));
  EXPECT_LT(yield.gradient(2), 0.0);
  // An error has the variance sigma^2 + shift^2, which determines its first-order index.
  double all = 0.0;
  for (std::size_t p = 0; p < 3; ++p) {
    all += std::pow(LinearModel::kSlopes[p] * study.errors.by_factor[p].standard_deviation(), 2);
  }
  for (std::size_t p = 0; p < 3; ++p) {
    const double share = std::pow(LinearModel::kSlopes[p] * study.errors.by_factor[p].standard_deviation(), 2) / all;
    EXPECT_NEAR(found.effects.effects.s1(0, p), share, 0.02) << p;
  }
}

/// The estimates of the yield's derivatives by the standard deviation of each of the three errors.
std::vector<Estimate> gradient_of(const Study& study) {
  const Result found = run(study, LinearModel());
  const YieldResult& yield = *found.machines->yield;
  std::vector<Estimate> gradient;
  for (std::size_t p = 0; p < 3; ++p) {
    gradient.push_back({yield.gradient(p), {yield.gradient_ci_low(p), yield.gradient_ci_high(p)}});
  }
  return gradient;
}

TEST(Machines, HaveAGradientByErrorsOfEveryShape) {
  const Catalog catalog = test::fake_catalog();
  Study study = study_of(catalog, 3, 40'500, {0.1, 0.05, 0.2});
  study.analysis.limits = {{0, 0.3}};
  // The sum of three uniform terms has a closed form. slope x standard deviation is 0.1 for each error.
  for (std::size_t p = 0; p < 3; ++p) {
    study.errors.by_factor[p] = Distribution::uniform(std::sqrt(3.0) * 0.1 / LinearModel::kSlopes[p]);
  }
  const test::YieldCase uniform = test::uniform_case(std::array{0.1, 0.1, 0.1}, 0.3);
  const std::vector<Estimate> found = gradient_of(study);
  for (std::size_t p = 0; p < 3; ++p) {
    const double expected = uniform.gradient[p] * LinearModel::kSlopes[p];
    const double half = 0.5 * (found[p].interval.high - found[p].interval.low);
    EXPECT_NEAR(found[p].value, expected, half * 3.9 / 1.96) << p;
    EXPECT_LT(half, 0.02 * std::abs(expected)) << p;
  }
  study.errors.by_factor[0] = Distribution::triangular(0.2);
  study.errors.by_factor[1] = Distribution::measured({-.08, -.04, -.03, 0.0, 0.01, 0.01, 0.02, 0.12});
  for (const Estimate& one : gradient_of(study)) {
    EXPECT_LT(one.interval.low, one.value);
    EXPECT_LT(one.interval.high, 0.0);
  }
}

double normal_share(double from, double to, double deviation) {
  const auto below = [&](double y) { return 0.5 * std::erfc(-y / deviation / std::sqrt(2.0)); };
  return below(to) - below(from);
}

/// The limit -0.1 <= y <= 0.35 on a normal sum, for which the yield has a closed form.
TEST(Machines, FindTheYieldBetweenTwoEnds) {
  constexpr std::size_t kMachines = 40'500;
  constexpr double kFrom = -0.1;
  constexpr double kTo = 0.35;
  const Catalog catalog = test::fake_catalog();
  Study study = study_of(catalog, 3, kMachines, {0.1, 0.05, 0.2});
  study.analysis.limits = {{0, ValueLimit::between(kFrom, kTo)}};
  asked_of<Options>(study.analysis).yield = 0.7;
  const Result found = run(study, LinearModel());
  const YieldResult& yield = *found.machines->yield;
  const double deviation = 0.1 * std::sqrt(3.0);
  const double expected = normal_share(kFrom, kTo, deviation);
  constexpr double kErrors = 3.9;  // alpha 1e-4
  EXPECT_NEAR(yield.value, expected, kErrors * std::sqrt(expected * (1.0 - expected) / kMachines));
  const auto density = [&](double y) {
    return std::exp(-0.5 * y * y / (deviation * deviation)) / std::sqrt(2.0 * std::numbers::pi);
  };
  const double slope = (kFrom * density(kFrom) - kTo * density(kTo)) / (deviation * deviation);
  for (std::size_t p = 0; p < 3; ++p) {
    const double gradient = slope * LinearModel::kSlopes[p] * 0.1 / deviation;  // slope x sigma is 0.1 for each error
    const double half = 0.5 * (yield.gradient_ci_high(p) - yield.gradient_ci_low(p));
    EXPECT_NEAR(yield.gradient(p), gradient, half * kErrors / 1.96) << p;
    EXPECT_LT(half, 0.1 * std::abs(gradient)) << p;
  }
  // The verdict's value is `out` beyond the nearer end of the limit: 70 % of the machines are within the limit if both
  // ends are moved outwards by `out`.
  const LimitVerdict& verdict = found.verdicts->limits.at(0);
  const double out = verdict.value < 0.0 ? kFrom - verdict.value : verdict.value - kTo;
  EXPECT_NEAR(normal_share(kFrom - out, kTo + out, deviation), 0.7, kErrors * std::sqrt(0.21 / kMachines));
  EXPECT_EQ(verdict.within, kMachines - yield.rejects);
}

/// The gradient and the change of the yield for one uniform error, if the limit has two ends and if it has one.
TEST(Machines, TellTheGradientBetweenTwoEnds) {
  const Catalog catalog = test::fake_catalog();
  Study study = study_of(catalog, 2, 20'000, {1e-4, 1e-4, 1e-4});
  study.errors.by_factor[0] = Distribution::uniform(0.1);
  for (const std::size_t p : {1U, 2U}) study.errors.by_factor[p] = Distribution::uniform(1e-9);
  constexpr double kInfinity = std::numeric_limits<double>::infinity();
  for (const auto& [limit, expected] :
       {std::pair(ValueLimit::between(-0.02, 0.08), 0.5), std::pair(ValueLimit::between(-kInfinity, 0.08), 0.9)}) {
    study.analysis.limits = {{0, limit}};
    const YieldResult yield = *run(study, LinearModel()).machines->yield;
    // The part of the yield that is proportional to 1 / width of the distribution; the rest does not depend on the
    // width.
    const double inside = expected == 0.5 ? 0.5 : 0.4;
    EXPECT_NEAR(yield.gradient(0), -inside * std::sqrt(3.0) / 0.1, 0.02 * inside * std::sqrt(3.0) / 0.1);
    EXPECT_NEAR(yield.change(0), -inside * (1.0 - 1.0 / 1.1), 1e-3);
  }
}

/// Machines are judged by the spread of the response: its largest minus its least value over the poses. The rejects are
/// compared with a count of all machines.
TEST(Machines, JudgeTheSpreadOverThePoses) {
  constexpr std::size_t kPoses = 5;
  const Catalog catalog = test::fake_catalog();
  Study study = study_of(catalog, kPoses, 4'000, {1e-3, 2e-3, 5e-3});
  study.errors.by_factor[1] = Distribution::uniform(3e-3);
  study.analysis.limits = {{0, ValueLimit::of_spread(1e-4)}};
  const PoseSet poses = select_poses(study.poses, test::FakeModel()).poses;
  const Result found = run(study, test::FakeModel());
  const YieldResult& yield = *found.machines->yield;
  std::uint64_t rejects = 0;
  for (std::size_t s = 0; s < study.analysis.samples; ++s) {
    double least = std::numeric_limits<double>::infinity();
    double most = -least;
    for (std::size_t m = 0; m < kPoses; ++m) {
      double sum = 0.0;
      for (std::size_t f = 0; f < 3; ++f) {
        const StreamAddress address{study.seed, Purpose::error_samples, FactorIndex(f), PoseIndex(0)};
        const double error =
            study.errors.by_factor[f].quantile(uniform_from_bits(random_bits(address, SampleIndex(s))));
        sum += test::FakeModel::weight(test::FakeModel::kArm, 0, f, poses[PoseIndex(m)]) * error;
      }
      least = std::min(least, std::abs(sum));
      most = std::max(most, std::abs(sum));
    }
    rejects += most - least > 1e-4 ? 1 : 0;
  }
  EXPECT_EQ(yield.rejects, rejects);
  EXPECT_GT(rejects, 400u);
  EXPECT_LT(rejects, 3600u);
  EXPECT_TRUE(std::isnan(yield.worst_pose_share(0, 0)));
  EXPECT_LT(yield.gradient(1), yield.gradient_ci_high(1));
  EXPECT_EQ(run(study, test::FakeModel(), 1).machines->yield->value, yield.value);
}

/// One error causes practically all rejects, so gradient and change have closed forms. An estimate with polynomials of
/// the errors would find only a twelfth of the gradient.
TEST(Machines, TellTheGradientByAnErrorThatAloneMakesTheRejects) {
  constexpr double kGood = 0.9973;
  const Catalog catalog = test::fake_catalog();
  Study study = study_of(catalog, 2, 20'000, {1e-4, 1e-4, 1e-4});
  study.errors.by_factor[0] = Distribution::uniform(0.1);
  study.errors.by_factor[1] = Distribution::uniform(1e-9);
  study.errors.by_factor[2] = Distribution::uniform(1e-9);
  study.analysis.limits = {{0, kGood * 0.1}};
  const YieldResult yield = *run(study, LinearModel()).machines->yield;
  EXPECT_NEAR(yield.gradient(0), -kGood * std::sqrt(3.0) / 0.1, 0.02 * kGood * std::sqrt(3.0) / 0.1);
  EXPECT_NEAR(yield.change(0), -kGood * (1.0 - 1.0 / 1.1), 1e-3);
  EXPECT_LT(yield.change_ci_high(0), -0.08);
  for (const std::size_t p : {1U, 2U}) {
    EXPECT_LE(yield.change_ci_low(p), 0.0);
    EXPECT_GE(yield.change_ci_high(p), 0.0);
    EXPECT_LT(yield.change_ci_high(p) - yield.change_ci_low(p), 1e-3);
  }
}

/// The change for each error equals the difference from a study in which this error is 10 % larger, with the same
/// random numbers. The interval of the change does not go below minus the yield.
TEST(Machines, TellWhatAStepChangesTheYieldBy) {
  constexpr std::size_t kMachines = 40'000;
  const Catalog catalog = test::fake_catalog();
  Study study = study_of(catalog, 2, kMachines, {0.1, 0.05, 0.2});
  study.errors.by_factor[0] = Distribution::uniform(0.3);
  study.analysis.limits = {{0, 0.25}};
  const YieldResult yield = *run(study, LinearModel()).machines->yield;
  for (std::size_t p = 0; p < 3; ++p) {
    Study grown = study;
    Distribution& error = grown.errors.by_factor[p];
    error = p == 0 ? Distribution::uniform(0.33) : Distribution::normal(1.1 * error.sigma());
    const double expected = run(grown, LinearModel()).machines->yield->value - yield.value;
    // The noise of the difference of the two studies comes from the machines that cross the limit (alpha = 1e-4 for
    // three comparisons).
    const double half = 0.5 * (yield.change_ci_high(p) - yield.change_ci_low(p)) / 1.96;
    const double noise = std::hypot(half, std::sqrt(2.0 * std::abs(expected) / kMachines));
    EXPECT_NEAR(yield.change(p), expected, 4.2 * noise) << p;
    EXPECT_LT(half, 0.1 * std::abs(expected)) << p;
    EXPECT_GE(yield.change_ci_low(p), -yield.value);
  }
}

TEST(Machines, TellTheSharesOfTheMeanSquare) {
  const Catalog catalog = test::fake_catalog();
  Study study = study_of(catalog, 3, 2'000, {0.1, 0.05, 0.4});
  study.errors.by_factor[1] = Distribution::uniform(0.05 * std::sqrt(3.0));
  study.analysis.limits = {{0, 0.3}};
  const YieldResult yield = *run(study, LinearModel()).machines->yield;
  const std::array expected{1.0 / 6.0, 1.0 / 6.0, 4.0 / 6.0};
  for (std::size_t p = 0; p < 3; ++p) {
    EXPECT_NEAR(yield.mean_square_share(0, p), expected[p], 1e-9);
    EXPECT_NEAR(yield.mean_square_share_ci_low(0, p), expected[p], 1e-6);
    EXPECT_NEAR(yield.mean_square_share_ci_high(0, p), expected[p], 1e-6);
    EXPECT_TRUE(std::isnan(yield.mean_square_share(1, p)));  // this response has no limit
  }
  EXPECT_NEAR(yield.linear_share(0), 1.0, 1e-9);
  EXPECT_TRUE(std::isnan(yield.linear_share(1)));
}

/// The linear fit has four unknowns (three slopes and an offset). Shares need at least twice as many machines.
TEST(Machines, AreTooFewForSharesBelowTwiceTheUnknowns) {
  const Catalog catalog = test::fake_catalog();
  Study study = study_of(catalog, 2, 7, {0.1, 0.05, 0.2});
  study.errors.by_factor[1] = Distribution::uniform(0.1);
  study.analysis.limits = {{0, 0.1}};
  EXPECT_TRUE(std::isnan(run(study, LinearModel()).machines->yield->mean_square_share(0, 0)));
  study.analysis.samples = 8;
  EXPECT_NEAR(run(study, LinearModel()).machines->yield->linear_share(0), 1.0, 1e-9);
}

/// A machine that is not solved at some pose is left out of the linear fit, but it is a reject.
TEST(Machines, ThatAreNotSolvedAreNotFitted) {
  const Catalog catalog = test::fake_catalog();
  Study study = study_of(catalog, 4, 5'000, {1e-3, 2e-3, 5e-3});
  study.errors.by_factor[1] = Distribution::uniform(4e-3);
  study.analysis.limits = {{0, 6e-4}};
  const YieldResult yield = *run(study, FailingModel()).machines->yield;
  EXPECT_GT(yield.unsolved, 0u);
  // The response is a magnitude that belongs to no vector of the model, so little of it is linear in the errors. The
  // gradient is then estimated with polynomials.
  EXPECT_LT(yield.linear_share(0), 0.5);
  EXPECT_LT(yield.gradient(1), 0.0);
}

TEST(Machines, HaveAGradientByCorrelatedNormalErrors) {
  constexpr double kCorrelation = 0.5;
  const Catalog catalog = test::fake_catalog();
  Study study = study_of(catalog, 3, 40'500, {0.1, 0.05, 0.2});
  study.analysis.limits = {{0, 0.3}};
  study.errors.correlated = {{{FactorIndex(0), FactorIndex(2)}, {1.0, kCorrelation, kCorrelation, 1.0}}};
  // slope x sigma is 0.1 for each error
  constexpr double kVariance = 0.03 + 0.02 * kCorrelation;
  const double density = std::exp(-0.5 * 0.09 / kVariance) / std::sqrt(2.0 * std::numbers::pi);
  const std::vector<Estimate> found = gradient_of(study);
  for (std::size_t p = 0; p < 3; ++p) {
    const double slope = 0.1 * LinearModel::kSlopes[p] * (p == 1 ? 1.0 : 1.0 + kCorrelation);
    const double expected = -2.0 * density * 0.3 * slope / std::pow(kVariance, 1.5);
    const double half = 0.5 * (found[p].interval.high - found[p].interval.low);
    EXPECT_NEAR(found[p].value, expected, half * 3.9 / 1.96) << p;
    EXPECT_LT(half, 0.1 * std::abs(expected)) << p;
  }
  study.errors.by_factor[2] = Distribution::uniform(0.3);
  const std::vector<Estimate> mixed = gradient_of(study);
  EXPECT_TRUE(std::isnan(mixed[0].value));
  EXPECT_LT(mixed[1].interval.high, 0.0);
  EXPECT_TRUE(std::isnan(mixed[2].value));
}

/// First-order indices and main effects if the errors are drawn anew at each pose.
TEST(MonteCarloEffects, AreThoseOfALinearModel) {
  const Catalog catalog = test::fake_catalog();
  Study study = study_of(catalog, 11, 5'500, {0.1, 0.05, 0.2});
  study.analysis.draws = Draws::per_pose;
  asked_of<Options>(study.analysis).judge = Judge::rms;
  const Result found = run(study, LinearModel());
  EXPECT_EQ(found.effects.s1_poses, (std::vector<std::uint64_t>{0, 1, 2, 4, 5, 6, 8, 9}));
  for (std::size_t p = 0; p < 3; ++p) {
    const double half = 0.5 * (found.effects.effects.s1_ci_high(0, p) - found.effects.effects.s1_ci_low(0, p));
    EXPECT_NEAR(found.effects.effects.s1(0, p), 1.0 / 3.0, half * 4.0 / 1.96);
    EXPECT_LT(half, 0.02);
  }
  expect_lines(found.effects);
}

/// Compares the counts with a loop over all machines. The errors are recomputed from the addresses of their random
/// numbers.
TEST(Machines, AgreeWithAllMachinesCountedOneByOne) {
  constexpr std::size_t kMachines = 2 * Plan::kUnitSamples + 77;
  constexpr std::size_t kPoses = 4;
  const Catalog catalog = test::fake_catalog();
  Study study = study_of(catalog, kPoses, kMachines, {1e-3, 2e-3, 5e-3});
  study.analysis.limits = {{0, 6e-4}, {1, 1.6e-4}};
  const FailingModel model;
  const PoseSet poses = select_poses(study.poses, model).poses;
  const Result found = run(study, model);
  std::uint64_t rejects = 0;
  std::uint64_t unsolved = 0;
  std::uint64_t lenient = 0;
  Array<std::uint64_t, axis::Response, axis::Pose> at_pose({2, kPoses});
  std::vector<std::vector<double>> largest(2);
  for (std::size_t s = 0; s < kMachines; ++s) {
    std::array<double, 3> errors{};
    for (std::size_t f = 0; f < 3; ++f) {
      const StreamAddress address{study.seed, Purpose::error_samples, FactorIndex(f), PoseIndex(0)};
      errors[f] = study.errors.by_factor[f].quantile(uniform_from_bits(random_bits(address, SampleIndex(s))));
    }
    bool bad = false;
    bool lost = false;
    std::array<double, 2> most{};
    for (std::size_t m = 0; m < kPoses; ++m) {
      const auto pose = poses[PoseIndex(m)];
      const bool solved = !(pose[1] > 0.0 && errors[0] > FailingModel::kMost);
      for (std::size_t r = 0; r < 2; ++r) {
        double sum = 0.0;
        for (std::size_t f = 0; f < 3; ++f)
          sum += test::FakeModel::weight(test::FakeModel::kArm, r, f, pose) * errors[f];
        const bool beyond = std::abs(sum) > study.analysis.limits[r].allowed.to();
        at_pose(r, m) += beyond || !solved ? 1 : 0;
        bad = bad || (solved && beyond);
        most[r] = std::max(most[r], std::abs(sum));
      }
      lost = lost || !solved;
    }
    rejects += bad || lost ? 1 : 0;
    lenient += bad ? 1 : 0;
    unsolved += lost ? 1 : 0;
    for (std::size_t r = 0; r < 2 && !lost; ++r) largest[r].push_back(most[r]);
  }
  const YieldResult& yield = *found.machines->yield;
  EXPECT_GT(unsolved, 0u);
  EXPECT_EQ(yield.rejects, rejects);
  EXPECT_EQ(yield.unsolved, unsolved);
  EXPECT_EQ(yield.unsolved_pass_rejects, lenient);
  for (std::size_t r = 0; r < 2; ++r) {
    for (std::size_t m = 0; m < kPoses; ++m) {
      EXPECT_EQ(yield.worst_pose_share(r, m), static_cast<double>(at_pose(r, m)) / kMachines);
    }
    const MachineValues& values = found.machines->largest;
    EXPECT_EQ(values.count(r), largest[r].size());
    EXPECT_EQ(values.max(r), std::ranges::max(largest[r]));
    const double truth = test::sorted_quantile(largest[r], 0.95);
    EXPECT_NEAR(values.quantiles(r, 2), truth, found.quantile_relative_error * truth);
  }
}

TEST(Machines, HaveTheDrawsOfTheFirstPoseEverywhere) {
  const Catalog catalog = test::fake_catalog();
  Study study = study_of(catalog, 3, 100, {1e-3, 2e-3, 5e-3});
  const Plan machines(study, select_poses(study.poses, test::FakeModel()).poses);
  for (std::size_t m = 0; m < 3; ++m) EXPECT_EQ(machines.address(1, PoseIndex(m)).pose, PoseIndex(0));
  study.analysis.draws = Draws::per_pose;
  const Plan poses(study, select_poses(study.poses, test::FakeModel()).poses);
  EXPECT_EQ(poses.address(1, PoseIndex(2)).pose, PoseIndex(2));
}

/// With a single pose, machines are the same as samples.
TEST(Machines, OfOnePoseAreItsSamples) {
  const Catalog catalog = test::fake_catalog();
  Study study = study_of(catalog, 1, 2500, {1e-3, 2e-3, 5e-3});
  const Result machines = run(study, test::FakeModel());
  study.analysis.draws = Draws::per_pose;
  asked_of<Options>(study.analysis).judge = Judge::rms;
  const Result samples = run(study, test::FakeModel());
  EXPECT_EQ(machines.quantiles, samples.quantiles);
  EXPECT_EQ(machines.min, samples.min);
  EXPECT_EQ(machines.max, samples.max);
  for (std::size_t r = 0; r < 2; ++r) {
    EXPECT_NEAR(machines.mean(r, 0), samples.mean(r, 0), 1e-13 * samples.mean(r, 0));
    EXPECT_NEAR(machines.std(r, 0), samples.std(r, 0), 1e-12 * samples.std(r, 0));
  }
  EXPECT_TRUE(std::ranges::equal(machines.machines->largest.max, samples.max));
  EXPECT_FALSE(samples.machines);
}

TEST(Machines, StopWhenTheMeansOfMachinesAreKnown) {
  const Catalog catalog = test::fake_catalog();
  Study study = study_of(catalog, 4, 100'000, {1e-3, 2e-3, 5e-3});
  study.analysis.adaptive = AdaptiveSamples{1000, 0.02};
  const Result found = run(study, test::FakeModel());
  ASSERT_TRUE(found.convergence);
  // The response is a folded normal with std = 0.756 mean, so n samples give the half-width 1.96 * 0.756 mean /
  // sqrt(n). This ratio is the same at every pose of a linear mechanism.
  const auto needed = static_cast<std::uint64_t>(std::pow(1.96 * 0.756 / 0.02, 2));
  EXPECT_GT(found.convergence->samples[0], needed * 9 / 10);
  EXPECT_LT(found.convergence->samples[0], 2 * needed);
  EXPECT_EQ(found.machines->largest.count(0), found.convergence->samples[0]);
}

TEST(MachineTable, HasSmallerUnitsForMorePoses) {
  EXPECT_EQ(MachineTable::unit_machines(1), 1000u);
  EXPECT_EQ(MachineTable::unit_machines(160), 1000u);
  EXPECT_EQ(MachineTable::unit_machines(161), 200u);
  EXPECT_EQ(MachineTable::unit_machines(2000), 40u);
  EXPECT_EQ(MachineTable::units_for(1001, 161), 6u);
}

}  // namespace
}  // namespace poesy::monte_carlo
