#include <gtest/gtest.h>

#include <algorithm>
#include <optional>

#include "engine/kinds/monte_carlo/kind.h"
#include "engine/kinds/sensitivity/kind.h"
#include "engine/random/stream.h"
#include "engine/run/replay.h"
#include "engine/run/run_options.h"
#include "tests/engine/run/prepared.h"
#include "tests/support/failing_model.h"
#include "tests/support/kinds.h"
#include "tests/support/states.h"

namespace poesy {
namespace {

using test::Prepared;

FailedSamples failing(std::initializer_list<std::size_t> samples) {
  FailedSamples cell;
  for (const std::size_t sample : samples) cell.add(SampleIndex(sample), SolveStatus::singular);
  return cell;
}

std::vector<std::size_t> numbers(const FailedSamples& cell) {
  std::vector<std::size_t> list;
  for (const FailedSample& failed : cell.first()) list.push_back(failed.sample.value);
  return list;
}

TEST(FailedSamples, AreTheFirstTenThatWereNotSolved) {
  FailedSamples cell;
  for (std::size_t n = 0; n < 40; ++n) {
    cell.add(SampleIndex(n), n % 2 == 0 ? SolveStatus::stagnated : SolveStatus::iteration_cap);
  }
  EXPECT_EQ(numbers(cell), (std::vector<std::size_t>{1, 3, 5, 7, 9, 11, 13, 15, 17, 19}));
  EXPECT_EQ(cell.first()[0].status, SolveStatus::iteration_cap);
}

TEST(FailedSamples, MergeInOrderUpToTheCap) {
  FailedSamples cell = failing({3, 5, 8});
  cell.merge({});
  cell.merge(failing({1000, 1001, 1002, 1003, 1004}));
  cell.merge(failing({2000, 2001, 2002}));
  EXPECT_EQ(numbers(cell), (std::vector<std::size_t>{3, 5, 8, 1000, 1001, 1002, 1003, 1004, 2000, 2001}));
}

TEST(FailedSamples, ReadBackWhatTheyWrote) {
  FailedSamples cell = failing({3, 500, 999});
  ByteWriter to;
  Archive archive(to);
  cell.state(archive, 3, 0, 1000);
  const Bytes bytes = to.take();
  const auto read = [&](std::uint64_t failures, std::uint64_t first, std::uint64_t end) {
    ByteReader from(bytes);
    Archive reading(from);
    FailedSamples samples;
    samples.state(reading, failures, first, end);
    return numbers(samples);
  };
  EXPECT_EQ(read(3, 0, 1000), numbers(cell));
  EXPECT_THROW(read(4, 0, 1000), BytesError);
  EXPECT_THROW(read(3, 0, 999), BytesError);
  EXPECT_THROW(read(3, 4, 1000), BytesError);
}

Study study_of(test::KindOfStudy kind, std::size_t samples, std::size_t poses, double sigma = 1e-3) {
  static const Catalog catalog = test::failing_catalog();
  Study study;
  study.mechanism = {&catalog.front(), {test::FakeModel::kArm}, 0, {}};
  study.errors.by_factor.assign(3, Distribution::normal(sigma));
  study.poses.count = poses;
  study.poses.workspace = {{-0.3, -0.2}, {-0.1, 0.1}, {-0.1, 0.1}};
  study.analysis.kind = kind;
  study.analysis.factors = {FactorIndex(1), FactorIndex(0)};
  study.analysis.samples = samples;
  study.seed = 11;
  return study;
}

double draw(const Plan& plan, std::size_t p, std::size_t pose, std::size_t sample) {
  double value = uniform_from_bits(
      random_bits({plan.seed(), Purpose::error_samples, plan.factors()[p], PoseIndex(pose)}, SampleIndex(sample)));
  plan.distributions()[p].transform(std::span(&value, 1));
  return value;
}

/// The failures that a run must list: the first ten of each cell, at most 1000 in all. Computed sample by sample from
/// the draws and the closed form of the mechanism.
std::vector<Failure> expected_failures(const Prepared& prepared) {
  const Plan& plan = prepared.plan;
  std::vector<Failure> list;
  for (std::size_t cell = 0; cell < plan.cells(); ++cell) {
    const std::size_t slot = cell / plan.poses().size();
    const std::size_t pose = cell % plan.poses().size();
    std::size_t of_cell = 0;
    for (std::size_t sample = 0; sample < plan.samples(); ++sample) {
      double sum = 0.0;
      for (std::size_t p = 0; p < plan.factors().size(); ++p) {
        if (plan.slots() > 1 && p != slot) continue;
        sum +=
            test::FakeModel::weight(test::FakeModel::kArm, 0, plan.factors()[p].value, plan.poses()[PoseIndex(pose)]) *
            draw(plan, p, pose, sample);
      }
      const SolveStatus status = test::FailingModel::status(std::abs(sum));
      if (solved(status) || ++of_cell > 10 || list.size() == 1000) continue;
      list.push_back({slot, PoseIndex(pose), {SampleIndex(sample), status}});
    }
  }
  return list;
}

std::optional<std::vector<Failure>> run(const Prepared& prepared, const RunOptions& options) {
  if (prepared.study.analysis.kind == &monte_carlo::kStudy) {
    const auto result = monte_carlo::run_monte_carlo(prepared.plan, *prepared.model, prepared.study.analysis, options);
    return result ? std::optional(result->failures) : std::nullopt;
  }
  const auto result = sensitivity::run_sensitivity(prepared.plan, *prepared.model, 0.95, options);
  return result ? std::optional(result->failures) : std::nullopt;
}

class Failures : public testing::TestWithParam<test::KindOfStudy> {};

TEST_P(Failures, AreTheFirstOfEachCellForAnyThreads) {
  const Prepared prepared(study_of(GetParam(), 3300, 3));
  const std::vector<Failure> expected = expected_failures(prepared);
  ASSERT_GT(expected.size(), 20U);
  for (const std::size_t threads : {1U, 2U, 3U}) EXPECT_EQ(run(prepared, {threads, {}, {}}), expected);
}

TEST_P(Failures, AreTheFirstThousandInAll) {
  const Prepared prepared(study_of(GetParam(), 20, 150, 0.1));
  const std::vector<Failure> expected = expected_failures(prepared);
  ASSERT_EQ(expected.size(), kMostFailuresListed);
  EXPECT_EQ(run(prepared, {}), expected);
}

TEST_P(Failures, AreTheSameAfterAStopOrAnExtension) {
  const Prepared shorter(study_of(GetParam(), 1300, 2));
  const Prepared longer(study_of(GetParam(), 3300, 2));
  std::vector<std::vector<Bytes>> states;
  Checkpoints keep([] { return true; },
                   [&](std::span<const ByteSource> stages) { states.push_back(test::bytes_of_each(stages)); });
  EXPECT_EQ(run(shorter, {1, {}, {}, &keep}), expected_failures(shorter));
  keep.save();
  ASSERT_GT(states.size(), 3U);
  for (const std::vector<Bytes>& state : states) {
    for (const Prepared* prepared : {&shorter, &longer}) {
      Checkpoints resumed([] { return false; }, [](std::span<const ByteSource>) {}, state);
      EXPECT_EQ(run(*prepared, {2, {}, {}, &resumed}), expected_failures(*prepared));
    }
  }
}

TEST_P(Failures, ReplayToTheirStatusAndDraws) {
  const Prepared prepared(study_of(GetParam(), 2000, 3));
  for (const Failure& failure : expected_failures(prepared)) {
    const ReplayedSample replayed = replay_sample(prepared.study, *prepared.model, prepared.plan.poses(), failure.slot,
                                                  failure.pose, failure.failed.sample);
    EXPECT_EQ(replayed.status, failure.failed.status);
    for (std::size_t v = 0; v < replayed.varied.size(); ++v) {
      const std::size_t p = replayed.varied.size() > 1 ? v : failure.slot;
      EXPECT_EQ(replayed.values[v], draw(prepared.plan, p, failure.pose.value, failure.failed.sample.value));
      EXPECT_EQ(replayed.errors[replayed.varied[v].value], replayed.values[v]);
    }
  }
}

INSTANTIATE_TEST_SUITE_P(Kinds, Failures, testing::Values(&sensitivity::kStudy, &monte_carlo::kStudy),
                         [](const auto& made) {
                           return made.param == &sensitivity::kStudy ? "sensitivity" : "together";
                         });

}  // namespace
}  // namespace poesy
