#include "engine/run/evaluate_unit.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include "engine/kinds/monte_carlo/kind.h"
#include "engine/kinds/monte_carlo/result.h"
#include "engine/kinds/sensitivity/kind.h"
#include "engine/random/stream.h"
#include "engine/run/run_options.h"
#include "engine/stats/buckets.h"
#include "tests/engine/stats/plain_sort.h"
#include "tests/support/fake_model.h"
#include "tests/support/kinds.h"

namespace poesy {
namespace {

constexpr double kNone = std::numeric_limits<double>::quiet_NaN();

const Catalog& catalog() {
  static const Catalog fake = test::fake_catalog();
  return fake;
}

/// A study of all three errors of the fake mechanism with different sizes. Their order differs from that of the model.
Study study_of(std::size_t poses, std::size_t samples) {
  Study study;
  study.mechanism = {&catalog().front(), {test::FakeModel::kArm}, 0, {}};
  for (const double sigma : {1e-3, 2e-3, 5e-3}) study.errors.by_factor.push_back(Distribution::normal(sigma));
  study.poses.count = poses;
  study.poses.workspace = {{-0.3, -0.2}, {-0.1, 0.1}, {-0.1, 0.1}};
  study.analysis.kind = &monte_carlo::kStudy;
  study.analysis.factors = {FactorIndex(0), FactorIndex(2), FactorIndex(1)};
  study.analysis.samples = samples;
  asked_of<monte_carlo::Options>(study.analysis).quantiles = {0.05, 0.5, 0.9, 0.99};
  study.seed = 3;
  return study;
}

/// The fake mechanism, but every fourth sample of a block reaches the iteration cap, and the sample after it is
/// singular.
class FailingModel : public test::FakeModel {
 public:
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
        if (b % 4 == 0) outcomes.status[b] = SolveStatus::iteration_cap;
        if (b % 4 != 1) continue;
        outcomes.status[b] = SolveStatus::singular;
        for (std::size_t r = 0; r < 2; ++r) outcomes.responses[r * samples.count + b] = kNone;
      }
    }
  };
};

monte_carlo::Result run(const Study& study, const Model& model, std::size_t threads) {
  RunOptions options;
  options.threads = threads;
  return monte_carlo::run_monte_carlo(Plan(study, select_poses(study.poses, model).poses), model, study.analysis,
                                      options)
      .value();
}

/// All samples of response r at a pose, recomputed one by one from the addresses of their random numbers.
std::vector<double> plain_samples(const Study& study, std::span<const double> pose, PoseIndex m, std::size_t r) {
  std::vector<double> values;
  for (std::size_t s = 0; s < study.analysis.samples; ++s) {
    double sum = 0.0;
    for (std::size_t f = 0; f < 3; ++f) {
      const double u =
          uniform_from_bits(random_bits({study.seed, Purpose::error_samples, FactorIndex(f), m}, SampleIndex(s)));
      sum += test::FakeModel::weight(test::FakeModel::kArm, r, f, pose) * study.errors.by_factor[f].quantile(u);
    }
    values.push_back(std::abs(sum));
  }
  return values;
}

TEST(RunMonteCarlo, AgreesWithAllSamplesSorted) {
  const Study study = study_of(3, 2 * Plan::kUnitSamples + 77);
  const test::FakeModel model;
  const PoseSet poses = select_poses(study.poses, model).poses;
  const monte_carlo::Result found = run(study, model, 2);
  std::vector<std::vector<double>> overall(2);
  for (std::size_t r = 0; r < 2; ++r) {
    for (std::size_t m = 0; m < 3; ++m) {
      const std::vector<double> samples = plain_samples(study, poses[PoseIndex(m)], PoseIndex(m), r);
      overall[r].insert(overall[r].end(), samples.begin(), samples.end());
      EXPECT_EQ(found.count(r, m), samples.size());
      EXPECT_EQ(found.min(r, m), std::ranges::min(samples));
      EXPECT_EQ(found.max(r, m), std::ranges::max(samples));
      for (std::size_t q = 0; q < 4; ++q) {
        const double truth =
            test::sorted_quantile(samples, asked_of<monte_carlo::Options>(study.analysis).quantiles[q]);
        EXPECT_NEAR(found.quantiles(r, m, q), truth, found.quantile_relative_error * truth);
      }
    }
    for (std::size_t q = 0; q < 4; ++q) {
      const double truth =
          test::sorted_quantile(overall[r], asked_of<monte_carlo::Options>(study.analysis).quantiles[q]);
      EXPECT_NEAR(found.overall_quantiles(r, q), truth, found.quantile_relative_error * truth);
    }
    EXPECT_EQ(found.overall_count(r), overall[r].size());
    EXPECT_EQ(found.overall_max(r), std::ranges::max(overall[r]));
    EXPECT_EQ(found.overall_min(r), std::ranges::min(overall[r]));
  }
}

/// Statistics of all samples of a response at a pose, computed from the sorted samples.
struct Plain {
  double rms;
  double low;  ///< lower end of the interval of the 0.9 quantile
  double high;
  double magnitude;  ///< the sample of rank ceil(0.99 n)
};

Plain plain(std::vector<double> samples, double conf_level) {
  double squares = 0.0;
  for (const double value : samples) squares += value * value;
  std::ranges::sort(samples);
  const RankInterval ranks = quantile_ranks(samples.size(), 0.9, conf_level);
  return {std::sqrt(squares / static_cast<double>(samples.size())), samples[ranks.low - 1], samples[ranks.high - 1],
          test::sorted_quantile(samples, 0.99)};
}

TEST(RunMonteCarlo, HasRootMeanSquaresAndIntervalsOfItsSamples) {
  Study study = study_of(3, 2 * Plan::kUnitSamples + 77);
  asked_of<monte_carlo::Options>(study.analysis).judge = Judge::share;
  asked_of<monte_carlo::Options>(study.analysis).share = 0.99;
  study.analysis.limits = {{0, 1e9}, {1, 1e-9}};
  const test::FakeModel model;
  const PoseSet poses = select_poses(study.poses, model).poses;
  const monte_carlo::Result found = run(study, model, 2);
  constexpr double kBucket = 2.0 * QuantileSketch::kRelativeError;
  double worst = 0.0;
  for (std::size_t m = 0; m < 3; ++m) {
    const Plain truth = plain(plain_samples(study, poses[PoseIndex(m)], PoseIndex(m), 1), study.analysis.conf_level);
    EXPECT_NEAR(found.rms(1, m), truth.rms, 1e-12 * truth.rms);
    EXPECT_LE(found.quantiles_ci_low(1, m, 2), truth.low);
    EXPECT_NEAR(found.quantiles_ci_low(1, m, 2), truth.low, kBucket * truth.low);
    EXPECT_GE(found.quantiles_ci_high(1, m, 2), truth.high);
    EXPECT_NEAR(found.quantiles_ci_high(1, m, 2), truth.high, kBucket * truth.high);
    EXPECT_NEAR(found.share_magnitude(1, m), truth.magnitude, found.quantile_relative_error * truth.magnitude);
    worst = std::max(worst, found.share_magnitude(1, m));
  }
  ASSERT_TRUE(found.verdicts);
  EXPECT_TRUE(found.verdicts->limits[0].passed);
  EXPECT_FALSE(found.verdicts->limits[1].passed);
  EXPECT_EQ(found.verdicts->limits[1].value, worst);
  EXPECT_EQ(found.verdicts->limits[0].within, found.verdicts->limits[0].tried);
  EXPECT_EQ(found.verdicts->limits[0].tried, 3 * study.analysis.samples);
}

double normal_density(double z) { return std::exp(-0.5 * z * z) / std::sqrt(2.0 * std::numbers::pi); }

TEST(RunMonteCarlo, FindsTheFoldedNormal) {
  constexpr std::size_t kSamples = 40000;
  constexpr std::size_t kPoses = 4;
  const Study study = study_of(kPoses, kSamples);
  const test::FakeModel model;
  const PoseSet poses = select_poses(study.poses, model).poses;
  const monte_carlo::Result found = run(study, model, 2);
  // The quantiles of |N(0, 1)| for 0.05, 0.5, 0.9 and 0.99 are those of N(0, 1) for 0.525, 0.75, 0.95 and 0.995.
  constexpr double kFolded[4] = {0.0627067779432, 0.6744897501961, 1.6448536269515, 2.5758293035489};
  const double n = kSamples;
  // There are 48 comparisons: eight cells with six estimates each. alpha = 0.001 in all, or 2e-5 each, means 4.3
  // standard errors.
  constexpr double kErrors = 4.3;
  for (std::size_t r = 0; r < 2; ++r) {
    for (std::size_t m = 0; m < kPoses; ++m) {
      double variance = 0.0;
      for (std::size_t f = 0; f < 3; ++f) {
        variance += std::pow(test::FakeModel::weight(test::FakeModel::kArm, r, f, poses[PoseIndex(m)]) *
                                 study.errors.by_factor[f].standard_deviation(),
                             2);
      }
      const double s = std::sqrt(variance);
      const double std = s * std::sqrt(1.0 - 2.0 / std::numbers::pi);
      EXPECT_NEAR(found.mean(r, m), s * std::sqrt(2.0 / std::numbers::pi), kErrors * std / std::sqrt(n));
      // The folded normal's kurtosis is 3.87.
      EXPECT_NEAR(found.std(r, m), std, kErrors * std * std::sqrt((3.87 - 1.0) / (4.0 * n)));
      for (std::size_t q = 0; q < 4; ++q) {
        const double level = asked_of<monte_carlo::Options>(study.analysis).quantiles[q];
        const double error = std::sqrt(level * (1.0 - level) / n) / (2.0 * normal_density(kFolded[q]));
        EXPECT_NEAR(found.quantiles(r, m, q), s * kFolded[q],
                    s * (kErrors * error + found.quantile_relative_error * kFolded[q]));
      }
    }
  }
}

TEST(RunMonteCarlo, HasTheSameBitsForAnyNumberOfThreads) {
  const Study study = study_of(5, 3 * Plan::kUnitSamples + 17);
  const test::FakeModel model;
  const monte_carlo::Result one = run(study, model, 1);
  for (const std::size_t threads : {1u, 2u, 3u, 7u}) {
    const monte_carlo::Result many = run(study, model, threads);
    EXPECT_EQ(many.mean, one.mean);
    EXPECT_EQ(many.mean_ci_low, one.mean_ci_low);
    EXPECT_EQ(many.mean_ci_high, one.mean_ci_high);
    EXPECT_EQ(many.std, one.std);
    EXPECT_EQ(many.quantiles, one.quantiles);
    EXPECT_EQ(many.overall_mean, one.overall_mean);
    EXPECT_EQ(many.overall_std, one.overall_std);
    EXPECT_EQ(many.overall_quantiles, one.overall_quantiles);
    EXPECT_EQ(many.rms, one.rms);
    EXPECT_EQ(many.quantiles_ci_low, one.quantiles_ci_low);
    EXPECT_EQ(many.quantiles_ci_high, one.quantiles_ci_high);
    EXPECT_EQ(many.histogram_edges, one.histogram_edges);
    EXPECT_EQ(many.histogram_counts, one.histogram_counts);
  }
}

TEST(RunMonteCarlo, FirstSamplesAreTheSameInALongerStudy) {
  const test::FakeModel model;
  const auto unit = [&](const Study& study, std::size_t u) {
    const Plan plan(study, select_poses(study.poses, model).poses);
    return PoseUnitEvaluator(plan, model)(plan.unit(u));
  };
  const PoseUnit shorter = unit(study_of(2, Plan::kUnitSamples), 1);
  const PoseUnit longer = unit(study_of(2, 3 * Plan::kUnitSamples), 3);
  for (std::size_t r = 0; r < 2; ++r) {
    EXPECT_EQ(shorter.responses[r].moments.mean(), longer.responses[r].moments.mean());
    EXPECT_EQ(shorter.responses[r].values.values, longer.responses[r].values.values);
  }
}

TEST(RunMonteCarlo, OfOneErrorDrawsWhatASensitivityStudyDraws) {
  Study study = study_of(3, 1500);
  study.analysis.factors = {FactorIndex(1)};
  const test::FakeModel model;
  const monte_carlo::Result together = run(study, model, 2);
  study.analysis.kind = &sensitivity::kStudy;
  const auto alone = sensitivity::run_sensitivity(Plan(study, select_poses(study.poses, model).poses), model,
                                                  study.analysis.conf_level, {})
                         .value();
  EXPECT_TRUE(std::ranges::equal(together.mean, alone.mean));
  EXPECT_TRUE(std::ranges::equal(together.std, alone.std));
}

TEST(RunMonteCarlo, CountsWhatThePolicySays) {
  Study study = study_of(2, 1002);  // units of 1000 and 2 samples
  const FailingModel model;
  const monte_carlo::Result solved = run(study, model, 1);
  study.not_converged = NotConverged::include;
  const monte_carlo::Result usable = run(study, model, 1);
  EXPECT_TRUE(std::ranges::equal(solved.count, std::vector<std::uint64_t>(4, 500)));
  EXPECT_TRUE(std::ranges::equal(usable.count, std::vector<std::uint64_t>(4, 751)));
  EXPECT_TRUE(std::ranges::equal(usable.overall_count, std::vector<std::uint64_t>(2, 1502)));
  for (const double value : usable.quantiles) EXPECT_TRUE(std::isfinite(value));
  EXPECT_EQ(solved.total().total(), 2004u);
  EXPECT_EQ(solved.total().not_converged(), 1004u);
  EXPECT_EQ(solved.solves[1].by_status[static_cast<std::size_t>(SolveStatus::singular)], 251u);
}

TEST(RunMonteCarlo, KnowsNothingWhereNoSampleCounts) {
  const monte_carlo::Result found = run(study_of(1, 2), FailingModel(), 1);
  EXPECT_TRUE(std::ranges::equal(found.count, std::vector<std::uint64_t>(2, 0)));
  for (const std::span<const double> values : std::initializer_list<std::span<const double>>{
           found.mean, found.mean_ci_low, found.std, found.min, found.max, found.quantiles, found.overall_mean,
           found.overall_quantiles, found.rms, found.overall_rms, found.quantiles_ci_low,
           found.overall_quantiles_ci_high, found.histogram_edges}) {
    for (const double value : values) EXPECT_TRUE(std::isnan(value));
  }
}

TEST(RunMonteCarlo, StopsWhenAsked) {
  const Study study = study_of(50, 100000);
  const test::FakeModel model;
  std::atomic<bool> stop{false};
  RunOptions options;
  options.threads = 2;
  options.stop = &stop;
  options.progress = [&](const Progress& /*progress*/) { stop = true; };
  EXPECT_FALSE(monte_carlo::run_monte_carlo(Plan(study, select_poses(study.poses, model).poses), model, study.analysis,
                                            options));
}

}  // namespace
}  // namespace poesy
