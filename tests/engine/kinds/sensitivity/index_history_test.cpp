#include "engine/kinds/sensitivity/collector.h"
#include "engine/kinds/sensitivity/kind.h"
#include "engine/kinds/sensitivity/result.h"

#include <gtest/gtest.h>

#include <cmath>

#include "bench/published_study.h"
#include "tests/engine/kinds/study_kinds.h"
#include "tests/support/kinds.h"

namespace poesy::sensitivity {
namespace {

using namespace test;

Result result_of(const Study& study) {
  const Prepared prepared(study);
  return run_sensitivity(prepared.plan, *prepared.model, 0.95, {}).value();
}

Study with_samples(Study study, std::size_t samples) {
  study.analysis.samples = samples;
  return study;
}

/// The bits of the indices and intervals at point k of a history.
Bits at_point(const EstimateCourse& history, std::size_t k) {
  Bits bits;
  for (const auto* values : {&history.value, &history.ci_low, &history.ci_high}) {
    for (std::size_t at = k; at < values->size(); at += history.samples.size())
      bits.push_back(std::bit_cast<std::uint64_t>((*values)[at]));
  }
  return bits;
}

Bits indices(const Result& result) {
  Bits bits;
  for (const auto* values : {&result.global, &result.global_ci_low, &result.global_ci_high}) append(bits, *values);
  return bits;
}

/// Expects that each point of the history equals the result of a study with that number of samples. The last point is
/// the result itself.
void expect_results_of_shorter_studies(const Study& study) {
  const Result result = result_of(study);
  ASSERT_TRUE(result.history);
  const EstimateCourse& history = *result.history;
  ASSERT_EQ(history.samples.back(), study.analysis.samples);
  EXPECT_EQ(history.value.size(), result.global.size() * history.samples.size());
  EXPECT_EQ(at_point(history, history.samples.size() - 1), indices(result));
  for (std::size_t k = 0; k + 1 < history.samples.size(); ++k) {
    EXPECT_EQ(at_point(history, k), indices(result_of(with_samples(study, history.samples[k])))) << history.samples[k];
  }
}

class History : public testing::TestWithParam<NotConverged> {
 protected:
  static Study failing(std::size_t samples) {
    Study study = study_of(&kStudy, samples);
    study.not_converged = GetParam();
    return study;
  }
};

TEST_P(History, IsTheResultsOfShorterStudies) {
  EXPECT_GT(result_of(failing(500)).total().not_converged(), 0U);
  for (const std::size_t samples : {2UL, 99UL, 100UL, 101UL, 700UL, 1000UL, 1300UL, 2000UL, 5300UL}) {
    expect_results_of_shorter_studies(failing(samples));
  }
}

TEST_P(History, OfAMechanismIsOfShorterOnes) {
  Study study = bench::published_study(5, 2300);
  study.solver.method = SolverOptions::Method::gauss_newton;
  study.not_converged = GetParam();
  study.errors.by_factor.assign(study.errors.by_factor.size(), Distribution::normal(0.05));
  study.analysis.factors.resize(4);
  EXPECT_GT(result_of(with_samples(study, 500)).total().not_converged(), 0U);
  expect_results_of_shorter_studies(study);
}

TEST_P(History, IsUnknownWhereAPoseHasNoIndex) {
  Study study = failing(5000);
  study.errors.by_factor.assign(3, Distribution::normal(0.3));  // only one sample in a hundred is solved
  expect_results_of_shorter_studies(study);
  if (GetParam() == NotConverged::include) return;
  const EstimateCourse history = result_of(study).history.value();
  EXPECT_TRUE(std::isnan(history.value.front()));
  EXPECT_FALSE(std::isnan(history.value.back()));
}

INSTANTIATE_TEST_SUITE_P(Policies, History, testing::Values(NotConverged::exclude, NotConverged::include),
                         [](const auto& tested) {
                           return tested.param == NotConverged::exclude ? "exclude" : "include";
                         });

TEST(History, HasThePointsAndTheEnd) {
  using List = std::vector<std::uint64_t>;
  const auto samples = [](std::size_t count) { return result_of(study_of(&kStudy, count)).history.value().samples; };
  EXPECT_EQ(samples(2), List{2});
  EXPECT_EQ(samples(100), List{100});
  EXPECT_EQ(samples(2300), (List{100, 200, 500, 1000, 2000, 2300}));
  EXPECT_EQ(samples(5000), (List{100, 200, 500, 1000, 2000, 5000}));
}

TEST(History, KeepsThePosesOfOneErrorAtATime) {
  Study study = study_of(&kStudy, 10000);
  study.poses.count = 50;
  const Prepared prepared(study);
  const std::size_t poses = prepared.plan.poses().size();
  constexpr std::size_t kResponses = 2;
  constexpr std::size_t kPoints = 7;
  HistoryCollector collect(prepared.plan, kResponses, 0.95);
  const std::vector<LocalIndex> within(3 * kResponses, LocalIndex{1.0, 0.1});
  std::vector<std::size_t> units_done(prepared.plan.cells());
  std::vector<UnitStats> cells(prepared.plan.cells());
  UnitStats stats;
  stats.responses.resize(kResponses);
  for (std::size_t n = 0; n < Plan::kUnitSamples; ++n) stats.solves.add(SolveStatus::converged, 1);
  const auto state_size = [&] {
    ByteWriter to;
    Archive archive(to);
    collect.state(archive, units_done, prepared.plan.samples());
    return to.take().size();
  };
  std::size_t largest = 0;
  for (std::size_t u = 0; u < prepared.plan.units(); ++u) {
    const WorkUnit unit = prepared.plan.unit(u);
    const std::size_t cell = unit.slot * poses + unit.pose.value;
    cells[cell].merge(stats);
    collect.add(unit, unit.first.value == 0 ? std::span(within) : std::span(within).first(0), cells[cell]);
    ++units_done[cell];
    largest = std::max(largest, state_size());
  }
  const std::size_t of_slot = kPoints * kResponses * 3 * sizeof(double);
  const std::size_t of_poses = kPoints * kResponses * (poses - 1) * sizeof(LocalIndex);
  EXPECT_EQ(largest, of_slot + of_poses);  // largest when the first error is done and the second is at its last pose
  EXPECT_EQ(state_size(), 2 * of_slot);
}

}  // namespace
}  // namespace poesy::sensitivity
