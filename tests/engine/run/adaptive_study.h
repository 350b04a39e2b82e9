#pragma once

#include "engine/kinds/monte_carlo/kind.h"
#include "engine/kinds/monte_carlo/result.h"
#include "engine/kinds/sensitivity/kind.h"
#include "engine/kinds/sensitivity/result.h"
#include "engine/run/run_options.h"
#include "tests/engine/run/prepared.h"
#include "tests/support/fake_model.h"
#include "tests/support/kinds.h"

namespace poesy::test {

/// An adaptive study of the fake mechanism with all three errors. The last error has no effect. The other two stop at
/// different milestones, because the kurtosis of a uniform error is less than that of a normal one.
inline Study adaptive_study(KindOfStudy kind, double relative_error, std::size_t max) {
  static const Catalog catalog = fake_catalog();
  Study study;
  study.mechanism = {&catalog.front(), {FakeModel::kArm}, 0, {}};
  study.errors.by_factor = {Distribution::normal(1e-3), Distribution::uniform(1e-3), Distribution::normal(1e-3)};
  study.poses.count = 3;
  study.poses.workspace = {{-0.3, -0.2}, {-0.1, 0.1}, {-0.1, 0.1}};
  study.analysis.kind = kind;
  study.analysis.factors = {FactorIndex(0), FactorIndex(1), FactorIndex(2)};
  study.analysis.samples = max;
  study.analysis.adaptive = AdaptiveSamples{1000, relative_error};
  set_quantiles(study.analysis, {0.1, 0.9});
  study.seed = 3;
  return study;
}

struct AdaptiveRun : Prepared {
  using Prepared::Prepared;

  std::optional<sensitivity::Result> sensitivity(const RunOptions& options) const {
    return sensitivity::run_sensitivity(plan, *model, study.analysis.conf_level, options);
  }
  std::optional<monte_carlo::Result> monte_carlo(const RunOptions& options) const {
    return monte_carlo::run_monte_carlo(plan, *model, study.analysis, options);
  }
};

}  // namespace poesy::test
