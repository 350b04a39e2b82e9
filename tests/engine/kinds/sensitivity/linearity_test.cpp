#include "engine/kinds/sensitivity/linearity.h"
#include "engine/kinds/sensitivity/kind.h"
#include "engine/run/run_options.h"

#include <gtest/gtest.h>

#include <atomic>
#include <bit>
#include <cmath>

#include "engine/run/evaluate_unit.h"
#include "engine/stats/indices.h"
#include "tests/engine/kinds/study_kinds.h"
#include "tests/support/fake_ranks.h"
#include "tests/support/kinds.h"

namespace poesy::sensitivity {
namespace {

using namespace test;

constexpr double kSigma = 1e-3;

/// One response, y = f(e): a function of the error that varies.
class CurveModel final : public FakeModel {
 public:
  using Curve = std::function<double(double error, SolveStatus& status)>;

  explicit CurveModel(Curve curve, double rounding = 0.0) : curve_(std::move(curve)), rounding_(rounding) {
    described_.responses = {{"y", Dimension::length, "the response"}};
    described_.deformation.reset();
    described_.details.clear();
  }

  const ModelDescription& description() const override { return described_; }
  double rounding(std::size_t) const override { return rounding_; }

  std::unique_ptr<Evaluator> evaluator(const SolverOptions&) const override {
    return std::make_unique<CurveEvaluator>(curve_);
  }

 private:
  class CurveEvaluator final : public Evaluator {
   public:
    explicit CurveEvaluator(const Curve& curve) : curve_(curve) {}

    void evaluate(const SampleBlock& samples, const OutcomeBlock& outcomes) override {
      for (std::size_t b = 0; b < samples.count; ++b) {
        outcomes.status[b] = SolveStatus::converged;
        outcomes.responses[b] = curve_(samples.values[b], outcomes.status[b]) * (1.0 - samples.pose[0]);
        outcomes.iterations[b] = 1;
      }
    }

   private:
    Curve curve_;
  };

  ModelDescription described_ = describe();
  Curve curve_;
  double rounding_;
};

/// The relative change of the index of one error at a tenth of its size, for a model with this curve.
double change_of(const CurveModel::Curve& curve, double rounding = 0.0, std::size_t samples = 200) {
  Study study = study_of(&kStudy, samples);
  study.analysis.factors = {FactorIndex(0)};
  const Prepared prepared(study);
  const auto changes = index_changes(prepared.plan, CurveModel(curve, rounding), {});
  EXPECT_EQ(changes.value().size(), 1U);
  return changes.value()(0, 0);
}

double linear(double error, SolveStatus&) { return 2.0 * error; }
double quadratic(double error, SolveStatus&) { return 2.0 * error * error; }

TEST(IndexChanges, OfALinearErrorAreNone) {
  EXPECT_NEAR(change_of(linear), 0.0, 1e-12);
  EXPECT_NEAR(change_of([](double error, SolveStatus&) { return std::abs(3.0 * error); }), 0.0, 1e-12);
  EXPECT_NEAR(change_of(linear, 0.0, 3), 0.0, 1e-12);
}

TEST(IndexChanges, OfAQuadraticErrorAreNineTenths) { EXPECT_NEAR(change_of(quadratic), -0.9, 1e-12); }

TEST(IndexChanges, SeeNoCurvatureThatAveragesOut) {
  // For a normal error (std / sigma)^2 = 1 + 2 bend^2 sigma^2, which differs from 1 by 2e-4. The test uses 16 draws in
  // pairs e and -e. Without these pairs, the product of the linear and the quadratic term would not average out and
  // would change the index by several percent.
  const double bend = 0.01 / kSigma;
  const double change = change_of([&](double error, SolveStatus&) { return error + bend * error * error; });
  EXPECT_LT(std::abs(change), 1e-3);
  EXPECT_NE(change, 0.0);
}

TEST(IndexChanges, OfEffectsThatAreRoundingAreUnknown) {
  EXPECT_TRUE(std::isnan(change_of([](double, SolveStatus&) { return 0.0; })));
  EXPECT_TRUE(std::isnan(change_of([](double error, SolveStatus&) { return 1e-12 * error; })));
  // The index 2 is above the rounding at the size of the study, but not always at a tenth of this size.
  EXPECT_NEAR(change_of(linear, 0.1 * kSigma), 0.0, 1e-12);
  EXPECT_TRUE(std::isnan(change_of(linear, 0.5 * kSigma)));
  EXPECT_TRUE(std::isnan(change_of(linear, 5.0 * kSigma)));
}

TEST(IndexChanges, LeaveOutDrawsThatAreNotSolvedAtEitherSize) {
  const auto cut = [](double error, SolveStatus& status) {
    if (std::abs(error) < kSigma) return 2.0 * error;
    status = SolveStatus::singular;
    return 1e6;
  };
  EXPECT_NEAR(change_of(cut), 0.0, 1e-12);
}

TEST(IndexChanges, SayWhetherAnIndexHolds) {
  EXPECT_FALSE(changes_with_size(0.019));
  EXPECT_TRUE(changes_with_size(-0.021));
  EXPECT_FALSE(changes_with_size(std::nan("")));
}

Bits changes_in(const Prepared& prepared, const RunOptions& options) {
  Bits bits;
  append(bits, index_changes(prepared.plan, *prepared.model, options).value());
  return bits;
}

TEST(IndexChanges, HaveTheSameBitsForAnyThreadsAndRanks) {
  const Prepared prepared(study_of(&kStudy, 100));
  const Bits expected = changes_in(prepared, {.threads = 1, .progress = {}});
  ASSERT_EQ(expected.size(), 4U);
  for (const std::size_t threads : {2U, 3U, 7U}) {
    EXPECT_EQ(changes_in(prepared, {.threads = threads, .progress = {}}), expected);
  }
  for (const std::size_t ranks : {1U, 2U, 3U}) {
    std::vector<Bits> found(ranks);
    const FakeRun ended = run_on_fake_ranks(ranks, [&](Team& team) {
      RunOptions options{.threads = 2, .progress = {}};
      options.team = &team;
      found[team.ranks().rank()] = changes_in(prepared, options);
    });
    EXPECT_EQ(ended.exit_codes, std::vector<int>(ranks, 0));
    for (const Bits& bits : found) EXPECT_EQ(bits, expected);
  }
}

TEST(IndexChanges, DependOnTheFirstDrawsAlone) {
  const Prepared few(study_of(&kStudy, kLinearityDraws));
  const Prepared many(study_of(&kStudy, 5000));
  EXPECT_EQ(changes_in(few, {}), changes_in(many, {}));
}

TEST(IndexChanges, TakeNoMoreThanSomePosesOfMany) {
  for (const std::size_t poses : {std::size_t{3}, kSomePoses, 2 * kSomePoses + 5}) {
    Study study = study_of(&kStudy, 1000);
    study.poses.count = poses;
    const Prepared prepared(study);
    std::atomic<std::size_t> solves = 0;
    const CurveModel model([&](double error, SolveStatus& status) {
      ++solves;
      return linear(error, status);
    });
    ASSERT_TRUE(index_changes(prepared.plan, model, {}));
    EXPECT_EQ(solves, 2 * std::min(poses, kSomePoses) * 4 * kLinearityDraws);
    EXPECT_EQ(static_cast<double>(solves), index_change_solves(prepared.plan));
  }
}

TEST(IndexChanges, AreNoneWhenStopped) {
  const Prepared prepared(study_of(&kStudy, 100));
  const std::atomic<bool> stop{true};
  RunOptions options;
  options.stop = &stop;
  EXPECT_FALSE(index_changes(prepared.plan, *prepared.model, options));
}

TEST(IndexChanges, StoppedAfterItsStagesARunIsNotComplete) {
  std::size_t saved = 0;
  Checkpoints checkpoints([] { return false; }, [&](std::span<const ByteSource>) { ++saved; });
  const Prepared prepared(study_of(&kStudy, 100));
  RunOptions options;
  options.checkpoints = &checkpoints;
  ASSERT_TRUE(run_sensitivity(prepared.plan, *prepared.model, 0.95, options));
  EXPECT_TRUE(checkpoints.complete());
  checkpoints.stopped_after_stages();
  EXPECT_FALSE(checkpoints.complete());
  EXPECT_EQ(saved, 1U);
}

}  // namespace
}  // namespace poesy::sensitivity
