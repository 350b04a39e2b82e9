// Responses that do not vary have no Sobol' indices. The function has three responses: one varies, one is constant
// except for rounding, and one varies at a single pose only.

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

#include "engine/kinds/monte_carlo/kind.h"
#include "engine/kinds/sobol/kind.h"
#include "engine/kinds/study_run.h"
#include "engine/stats/first_order.h"
#include "tests/support/function_model.h"

namespace poesy::test {
namespace {

constexpr double kSigma = 1e-3;
constexpr std::size_t kMoving = 0;
constexpr std::size_t kStill = 1;
constexpr std::size_t kAtOnePose = 2;

/// A rounding error like that of a solve (m): about one unit in the last place of 5 mm.
double noise(double x) { return 1e-18 * std::sin(1e7 * x); }

/// moving = x1 + 2 x2. still = 5 mm plus rounding. at_one_pose = x1 if the pose is above 0.5, else only rounding.
void parts(std::span<const double> x, double pose, std::span<double> y) {
  y[kMoving] = x[0] + 2.0 * x[1];
  y[kStill] = 5e-3 + noise(x[0]);
  y[kAtOnePose] = pose > 0.5 ? x[0] : noise(x[1]);
}

/// The function with two additional vectors as details: (x1 + 2 x2, rounding) and (rounding, rounding).
class PartsModel final : public FunctionModel {
 public:
  PartsModel() : FunctionModel(2, {"moving", "still", "at_one_pose"}, parts), described_(FunctionModel::description()) {
    for (Response& response : described_.responses) response.dimension = Dimension::length;
    described_.details = {{"some", {"v_x", "v_y"}, "m,m", "one component moves"},
                          {"none", {"v_x", "v_y"}, "m,m", "no component moves"}};
  }

  const ModelDescription& description() const override { return described_; }

  std::unique_ptr<Evaluator> evaluator(const SolverOptions& options) const override {
    class WithDetails final : public Evaluator {
     public:
      explicit WithDetails(std::unique_ptr<Evaluator> responses) : responses_(std::move(responses)) {}

      void evaluate(const SampleBlock& samples, const OutcomeBlock& outcomes) override {
        responses_->evaluate(samples, outcomes);
        for (std::size_t b = 0; b < samples.count && !outcomes.details.empty(); ++b) {
          const double last_place = noise(samples.values[b]);
          const double details[]{outcomes.responses[b], last_place, 2.0 * last_place, last_place};
          for (std::size_t d = 0; d < 4; ++d) outcomes.details[d * samples.count + b] = details[d];
        }
      }

     private:
      std::unique_ptr<Evaluator> responses_;
    };
    return std::make_unique<WithDetails>(FunctionModel::evaluator(options));
  }

 private:
  ModelDescription described_;
};

struct Found {
  explicit Found(const StudyKind& kind, std::size_t samples = 4096) : Found(kind, samples, std::nullopt) {}
  Found(const StudyKind& kind, std::size_t samples, std::optional<AdaptiveSamples> adaptive) {
    entry.description = model.description();
    study = function_study(entry, kind, Distribution::normal(kSigma), samples);
    study.analysis.adaptive = adaptive;
  }

  StudyResult run() { return run_study(study, model, poses, {1, {}, {}}).value(); }

  PartsModel model;
  CatalogEntry entry;
  Study study;
  PoseSet poses{1, {0.25, 0.75}};
};

bool all_nan(std::span<const double> values) {
  return std::ranges::all_of(values, [](double value) { return std::isnan(value); });
}

TEST(SobolOfConstants, HaveNoShares) {
  Found study(sobol::kStudy);
  asked_of<sobol::Options>(study.study.analysis).second_order = true;
  asked_of<sobol::Options>(study.study.analysis).shapley = true;
  const StudyResult result = study.run();
  const auto& found = result.as<sobol::Result>();
  EXPECT_TRUE(std::ranges::equal(found.varies, std::array{1, 0, 1}));
  const auto& [conf_level, S1, ST] = found.aggregated;
  for (const auto* list : {&S1.value, &ST.value, &ST.ci_low, &found.Sh.value}) {
    EXPECT_TRUE(all_nan(list->row(kStill)));
    EXPECT_FALSE(all_nan(list->row(kMoving)));
    EXPECT_FALSE(all_nan(list->row(kAtOnePose)));
  }
  EXPECT_TRUE(all_nan(found.S2.value.row(kStill)));
  EXPECT_NEAR(ST.value(kMoving, 0), 0.2, 0.05);
  EXPECT_NEAR(ST.value(kMoving, 1), 0.8, 0.05);
  EXPECT_NEAR(ST.value(kAtOnePose, 0), 1.0, 1e-12) << "the other pose adds nothing";
}

/// At the pose where the response is constant it has no indices; at the other pose x1 has the index 1.
TEST(SobolOfConstants, AreJudgedPoseByPose) {
  const StudyResult result = Found(sobol::kStudy).run();
  const auto& [conf_level, S1, ST] = result.as<sobol::Result>().at_poses;
  EXPECT_TRUE(all_nan(S1.value.row(kStill)));
  for (std::size_t p = 0; p < 2; ++p) EXPECT_TRUE(std::isnan(ST.value(kAtOnePose, p, 0)));
  EXPECT_EQ(ST.value(kAtOnePose, 0, 1), 1.0);
  EXPECT_EQ(ST.value(kAtOnePose, 1, 1), 0.0);
}

TEST(SobolOfConstants, VectorsAreJudgedByTheirComponents) {
  const StudyResult result = Found(sobol::kStudy).run();
  const auto& found = result.as<sobol::Result>();
  ASSERT_EQ(found.vectors, (std::vector<std::string>{"some_v", "none_v"}));
  EXPECT_TRUE(std::ranges::equal(found.vector_varies, std::array{1, 0}));
  EXPECT_TRUE(all_nan(found.of_vectors.ST.value.row(1)));
  EXPECT_TRUE(std::ranges::equal(found.of_vectors.ST.value.row(0), found.aggregated.ST.value.row(kMoving)))
      << "rounding adds no bit";
}

/// Adaptive sampling must not wait for the interval of ST of a constant response, which never becomes narrower.
TEST(SobolOfConstants, NeedNoSamples) {
  Found study(sobol::kStudy, 100'000, AdaptiveSamples{1000, 0.2});
  const StudyResult result = study.run();
  const auto& found = result.as<sobol::Result>();
  ASSERT_TRUE(found.convergence);
  EXPECT_EQ(found.convergence->samples.front(), 1000u);
  EXPECT_EQ(found.convergence->reached[kStill], 1);
}

TEST(MonteCarloOfConstants, HasNoIndicesAndNoMainEffects) {
  for (const Draws draws : {Draws::per_pose, Draws::per_machine}) {
    Found study(monte_carlo::kStudy);
    study.study.analysis.draws = draws;
    const StudyResult result = study.run();
    const auto& found = result.as<monte_carlo::Result>();
    EXPECT_TRUE(std::ranges::equal(found.varies, std::array{1, 0, 1}));
    const monte_carlo::MainEffects& effects = found.effects.effects;
    EXPECT_TRUE(all_nan(effects.s1.row(kStill)));
    EXPECT_TRUE(all_nan(effects.mean.row(kStill)));
    EXPECT_NEAR(effects.s1(kMoving, 1), 0.8, 0.05);
    EXPECT_NEAR(effects.s1(kAtOnePose, 0), 1.0, 0.05);
    if (draws == Draws::per_machine) {
      EXPECT_TRUE(all_nan(found.machines->effects_on_largest.s1.row(kStill)));
    }
  }
}

}  // namespace
}  // namespace poesy::test
