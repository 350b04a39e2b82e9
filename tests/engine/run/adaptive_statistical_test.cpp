#include <gtest/gtest.h>

#include <boost/math/distributions/binomial.hpp>
#include <cmath>
#include <cstdio>
#include <numbers>

#include "engine/kinds/monte_carlo/result.h"
#include "engine/kinds/sensitivity/result.h"
#include "engine/stats/moments.h"
#include "tests/engine/run/adaptive_study.h"
#include "tests/support/kinds.h"

/// Adaptive sampling stops when the intervals are narrow, which could favour samples whose interval is narrow by
/// chance. So these tests measure the coverage of the final intervals over many seeds.
namespace poesy {
namespace {

constexpr std::size_t kRepetitions = 1000;
constexpr double kLevel = 0.95;
/// Probability that a test fails although the coverage is at its level.
constexpr double kAlpha = 0.001;

/// Standard deviation and mean of |e| for a standard normal error e. The response of the fake mechanism to one error is
/// |w e|.
const double kFoldedStd = std::sqrt(1.0 - 2.0 / std::numbers::pi);
const double kFoldedMean = std::sqrt(2.0 / std::numbers::pi);

Study study_of(test::KindOfStudy kind, std::size_t poses, double relative_error) {
  Study study = test::adaptive_study(kind, relative_error, 1'000'000);
  study.errors.by_factor.assign(3, Distribution::normal(1e-3));
  study.analysis.factors = {FactorIndex(0)};
  study.analysis.conf_level = kLevel;
  study.poses.count = poses;
  study.poses.workspace = {{-0.3, -0.2}, {-0.4, 0.4}, {-0.2, 0.2}};
  return study;
}

/// The weight of factor 0 in response 0 at each pose.
std::vector<double> weights(const Plan& plan) {
  std::vector<double> weights;
  for (std::size_t m = 0; m < plan.poses().size(); ++m) {
    weights.push_back(test::FakeModel::weight(test::FakeModel::kArm, 0, 0, plan.poses()[PoseIndex(m)]));
  }
  return weights;
}

/// With coverage at the level, fewer repetitions than this are covered with a probability of at most kAlpha.
std::size_t fewest_covered() {
  const boost::math::binomial binomial(static_cast<double>(kRepetitions), kLevel);
  return static_cast<std::size_t>(boost::math::quantile(binomial, kAlpha));
}

struct Tally {
  std::size_t covered = 0;
  std::size_t local_covered = 0;
  double samples = 0.0;

  void report(const char* what) const {
    std::printf("%s: coverage %.1f %%, at the first pose %.1f %%, %.0f samples on average\n", what,
                100.0 * static_cast<double>(covered) / kRepetitions,
                100.0 * static_cast<double>(local_covered) / kRepetitions, samples / kRepetitions);
    EXPECT_GE(covered, fewest_covered()) << what;
    EXPECT_GE(local_covered, fewest_covered()) << what;
  }
};

bool inside(double value, double low, double high) { return low <= value && value <= high; }

Tally sensitivity_tally(std::size_t poses, double relative_error) {
  Tally tally;
  Study study = study_of(&sensitivity::kStudy, poses, relative_error);
  for (std::size_t n = 0; n < kRepetitions; ++n) {
    study.seed = 1000 + n;
    const test::AdaptiveRun run(study);
    Moments over_poses;
    for (const double weight : weights(run.plan)) over_poses.add(std::abs(weight) * kFoldedStd);
    const double truth = over_poses.mean() + (poses > 1 ? over_poses.standard_deviation() : 0.0);
    const sensitivity::Result found = run.sensitivity({1, {}, nullptr}).value();
    const ConvergenceResult& end = found.convergence.value();
    EXPECT_EQ(end.reached[0], 1);
    EXPECT_LE(found.global_ci_high(0, 0) - found.global(0, 0), relative_error * found.global(0, 0));
    EXPECT_LE(found.global(0, 0) - found.global_ci_low(0, 0), relative_error * found.global(0, 0));
    tally.covered += inside(truth, found.global_ci_low(0, 0), found.global_ci_high(0, 0)) ? 1 : 0;
    const double local = std::abs(weights(run.plan)[0]) * kFoldedStd;
    tally.local_covered += inside(local, found.local_ci_low(0, 0, 0), found.local_ci_high(0, 0, 0)) ? 1 : 0;
    tally.samples += static_cast<double>(end.samples[0]);
  }
  return tally;
}

Tally monte_carlo_tally(std::size_t poses, double relative_error) {
  Tally tally;
  Study study = study_of(&monte_carlo::kStudy, poses, relative_error);
  for (std::size_t n = 0; n < kRepetitions; ++n) {
    study.seed = 1000 + n;
    const test::AdaptiveRun run(study);
    const monte_carlo::Result found = run.monte_carlo({1, {}, nullptr}).value();
    const ConvergenceResult& end = found.convergence.value();
    const std::vector<double> all = weights(run.plan);
    double truth = 0.0;
    for (const double weight : all) truth += std::abs(weight) * 1e-3 * kFoldedMean / static_cast<double>(poses);
    const std::size_t last = end.course.samples.size() - 1;
    EXPECT_EQ(end.reached[0], 1);
    EXPECT_LE(end.course.half_width[last], relative_error * end.course.value[last]);
    tally.covered += std::abs(end.course.value[last] - truth) <= end.course.half_width[last] ? 1 : 0;
    const double local = std::abs(all[0]) * 1e-3 * kFoldedMean;
    tally.local_covered += inside(local, found.mean_ci_low(0, 0), found.mean_ci_high(0, 0)) ? 1 : 0;
    tally.samples += static_cast<double>(end.samples[0]);
  }
  return tally;
}

TEST(AdaptiveCoverage, IndexAtOnePose) { sensitivity_tally(1, 0.05).report("index, one pose"); }

TEST(AdaptiveCoverage, IndexOverPoses) { sensitivity_tally(6, 0.02).report("index, six poses"); }

TEST(AdaptiveCoverage, IndexNearTheFirstMilestone) { sensitivity_tally(1, 0.06).report("index, 6 %, one pose"); }

TEST(AdaptiveCoverage, MeanAtOnePose) { monte_carlo_tally(1, 0.03).report("mean, one pose"); }

TEST(AdaptiveCoverage, MeanOverPoses) { monte_carlo_tally(6, 0.01).report("mean, six poses"); }

}  // namespace
}  // namespace poesy
