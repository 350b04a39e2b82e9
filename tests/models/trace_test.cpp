// Compares the trace of iterations of each mechanism with its evaluator.

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <string>

#include "models/registry.h"

namespace poesy {
namespace {

struct Case {
  const char* model;
  std::size_t fidelity;
  bool iterates;
};

class Trace : public testing::TestWithParam<Case> {
 protected:
  Trace() {
    const CatalogEntry& entry = *find(registry(), GetParam().model);
    std::vector<double> geometry;
    for (const GeometryParameter& parameter : entry.description.geometry) geometry.push_back(parameter.published);
    model_ = entry.build(geometry, GetParam().fidelity);
    for (std::size_t c = 0; c < entry.description.pose_lower.size(); ++c) {
      pose_.push_back(0.4 * entry.description.pose_lower[c] + 0.6 * entry.description.pose_upper[c]);
    }
    for (std::size_t f = 0; f < entry.description.factors.size(); ++f) {
      errors_.push_back(1e-4 * static_cast<double>(f % 5));
    }
  }

  std::unique_ptr<Model> model_;
  std::vector<double> pose_;
  std::vector<double> errors_;
};

TEST_P(Trace, HasARowForEachIterationAndTheSolution) {
  SolverOptions options;
  options.method = SolverOptions::Method::gauss_newton;
  const auto trace = model_->trace(pose_, errors_, options);
  ASSERT_TRUE(trace.has_value());
  EXPECT_TRUE(solved(trace->status));
  EXPECT_EQ(!trace->columns.empty(), GetParam().iterates);
  EXPECT_EQ(trace->rows.size(), GetParam().iterates ? trace->iterations * trace->columns.size() : 0U);
  std::vector<double> responses(model_->description().responses.size());
  SolveStatus status{};
  std::uint32_t iterations = 0;
  model_->evaluator(options)->evaluate({pose_, errors_, {}, {}, 1}, {responses, {&status, 1}, {&iterations, 1}, {}});
  EXPECT_TRUE(solved(status));
  ASSERT_EQ(trace->responses.size(), responses.size());
  for (std::size_t r = 0; r < responses.size(); ++r) EXPECT_NEAR(trace->responses[r], responses[r], 1e-13) << r;
}

/// Tests for mechanisms whose solver iterates.
class IteratedTrace : public Trace {};

TEST_P(IteratedTrace, EndsWhereTheCapIs) {
  SolverOptions options;
  options.max_iterations = 1;
  const auto trace = model_->trace(pose_, errors_, options);
  EXPECT_EQ(trace->status, SolveStatus::iteration_cap);
  EXPECT_EQ(trace->iterations, 1U);
  EXPECT_EQ(trace->rows.size(), trace->columns.size());
}

TEST_P(Trace, StepsBecomeSmallerThanTheTolerance) {
  SolverOptions options;
  options.tolerance = 1e-11;
  const auto trace = model_->trace(pose_, errors_, options);
  EXPECT_EQ(trace->status, SolveStatus::converged);
  if (!GetParam().iterates) return;
  // The first column of a row is the number that is compared with the tolerance.
  EXPECT_LT(trace->rows[trace->rows.size() - trace->columns.size()], options.tolerance);
  EXPECT_GT(trace->rows[0], options.tolerance);
}

std::string name_of(const testing::TestParamInfo<Case>& made) {
  std::string text = made.param.model;
  std::ranges::replace(text, '-', '_');
  return text;
}

constexpr std::array kIterated{Case{"2upr-rpu", 0, true}, Case{"3-prs", 0, true}, Case{"xy-3-prs", 0, true}};
constexpr std::array kFirstOrder{Case{"3-prs", 1, false}, Case{"xy-3-prs", 1, false}};
INSTANTIATE_TEST_SUITE_P(Iterated, Trace, testing::ValuesIn(kIterated), name_of);
INSTANTIATE_TEST_SUITE_P(FirstOrder, Trace, testing::ValuesIn(kFirstOrder), name_of);
INSTANTIATE_TEST_SUITE_P(Iterated, IteratedTrace, testing::ValuesIn(kIterated), name_of);

}  // namespace
}  // namespace poesy
