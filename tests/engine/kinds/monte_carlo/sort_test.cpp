// Compares the streamed quantiles of a Monte Carlo study with a plain sort of the same samples, which are drawn one by
// one and solved as a table of errors. All errors of a real mechanism vary, with 10 000 samples at each pose.

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "bench/published_study.h"
#include "engine/kinds/monte_carlo/kind.h"
#include "engine/kinds/monte_carlo/result.h"
#include "engine/random/stream.h"
#include "engine/run/evaluation.h"
#include "tests/engine/stats/plain_sort.h"
#include "tests/support/kinds.h"
#include "tests/support/names.h"

namespace poesy::monte_carlo {
namespace {

constexpr std::size_t kPoses = 2;
constexpr std::size_t kSamples = 10000;

Study study_of(double scale) {
  Study study = bench::published_study(kPoses, kSamples);
  study.analysis.kind = &kStudy;
  study.analysis.background.reset();
  study.analysis.factors.clear();
  for (std::size_t f = 0; f < study.model().factors.size(); ++f) {
    study.analysis.factors.emplace_back(f);
    study.errors.by_factor[f] = Distribution::normal(scale * study.errors.by_factor[f].sigma());
  }
  asked_of<Options>(study.analysis).quantiles = {0.001, 0.05, 0.25, 0.5, 0.75, 0.95, 0.999};
  return study;
}

ErrorTable table_of(const Study& study, PoseIndex pose) {
  ErrorTable table{study.analysis.factors, {}, kSamples};
  for (std::size_t s = 0; s < kSamples; ++s) {
    for (const FactorIndex factor : table.factors) {
      const StreamAddress address{study.seed, Purpose::error_samples, factor, pose};
      table.values.push_back(
          study.errors.by_factor[factor.value].quantile(uniform_from_bits(random_bits(address, SampleIndex(s)))));
    }
  }
  return table;
}

/// [responses] For each response, the values of the solved samples at pose m.
std::vector<std::vector<double>> solved_samples(const Study& study, const Model& model, const PoseSet& poses,
                                                PoseIndex m) {
  const PoseSet pose(poses.coordinates(), {poses[m].begin(), poses[m].end()});
  const EvaluationResult found =
      run_evaluation(model, study.solver, pose, table_of(study, m), Pairing::every_pose_with_every_row, {}).value();
  std::vector<std::vector<double>> samples(found.responses());
  for (std::size_t r = 0; r < found.responses(); ++r) {
    for (std::size_t s = 0; s < kSamples; ++s) {
      if (solved(found.status(0, s))) samples[r].push_back(found.response(r, 0, s));
    }
  }
  return samples;
}

class MonteCarloOfAllErrors : public testing::TestWithParam<double> {};

TEST_P(MonteCarloOfAllErrors, HasSortedQuantiles) {
  const Study study = study_of(GetParam());
  const std::unique_ptr<Model> model = build_model(study.mechanism);
  const PoseSet poses = select_poses(study.poses, *model).poses;
  const Result found = run_monte_carlo(Plan(study, poses), *model, study.analysis, {}).value();
  double worst = 0.0;
  for (std::size_t m = 0; m < kPoses; ++m) {
    const auto samples = solved_samples(study, *model, poses, PoseIndex(m));
    for (std::size_t r = 0; r < samples.size(); ++r) {
      ASSERT_EQ(found.count(r, m), samples[r].size());
      EXPECT_EQ(found.min(r, m), std::ranges::min(samples[r]));
      EXPECT_EQ(found.max(r, m), std::ranges::max(samples[r]));
      for (std::size_t q = 0; q < found.levels.size(); ++q) {
        const double truth = test::sorted_quantile(samples[r], found.levels[q]);
        const double difference = std::abs(found.quantiles(r, m, q) - truth) / std::abs(truth);
        EXPECT_LE(difference, found.quantile_relative_error);
        worst = std::max(worst, difference);
      }
    }
  }
  RecordProperty("worst_relative_difference", std::to_string(worst));
  EXPECT_GT(worst, 0.0);
}

INSTANTIATE_TEST_SUITE_P(Scales, MonteCarloOfAllErrors, testing::Values(0.1, 1.0), test::named({"Tenth", "Whole"}));

}  // namespace
}  // namespace poesy::monte_carlo
