#pragma once

#include <memory>

#include "engine/run/evaluation.h"
#include "engine/study/plan.h"
#include "tests/support/fake_model.h"
#include "tests/support/kinds.h"

namespace poesy::fuzz {

/// A study of the fake mechanism at two poses, with a last unit that is smaller than the others.
struct SmallPlan {
  explicit SmallPlan(const StudyKind* kind)
      : study(study_of(kind)),
        model(build_model(study.mechanism)),
        plan(study, select_poses(study.poses, *model).poses) {}

  static Study study_of(const StudyKind* kind) {
    static const Catalog catalog = test::fake_catalog();
    Study study;
    study.mechanism = {&catalog.front(), {test::FakeModel::kArm}, 0, {}};
    study.errors.by_factor.assign(3, Distribution::uniform(1e-3));
    study.poses.count = 2;
    study.poses.workspace = {{-0.3, -0.2}, {-0.1, 0.1}, {-0.1, 0.1}};
    study.analysis.kind = kind;
    study.analysis.factors = {FactorIndex(0), FactorIndex(1)};
    study.analysis.samples = 2 * Plan::kUnitSamples + 300;
    test::set_quantiles(study.analysis, {0.1, 0.9});
    return study;
  }

  Study study;
  std::unique_ptr<Model> model;
  Plan plan;
};

inline constexpr std::size_t kResponses = 2;
inline constexpr std::size_t kDetails = 2;
inline constexpr std::size_t kEvaluationSamples = 10;
inline constexpr std::size_t kBlockRows = 4;

/// Room for the outcomes of an evaluation at the same poses.
inline EvaluationResult empty_evaluation() {
  constexpr std::size_t kPoses = 2;
  constexpr std::size_t kAll = kPoses * kEvaluationSamples;
  EvaluationResult result;
  result.poses = kPoses;
  result.samples = kEvaluationSamples;
  result.responses = kResponses;
  result.details = kDetails;
  result.response.resize(kAll * kResponses);
  result.detail.resize(kAll * kDetails);
  result.status.resize(kAll);
  result.iterations.resize(kAll);
  return result;
}

}  // namespace poesy::fuzz
