#pragma once

#include "tests/support/fake_model.h"

namespace poesy::test {

/// The fake mechanism with a solver that reaches the iteration cap if the first response exceeds kLimit, and becomes
/// non-finite if it exceeds twice kLimit. With sigma = 1e-3 the limit is at about three sigma of delta_1 or two sigma
/// of epsilon_1.
class FailingModel final : public FakeModel {
 public:
  static constexpr double kLimit = 4.5e-4;

  using FakeModel::FakeModel;

  static SolveStatus status(double first_response) {
    if (first_response > 2.0 * kLimit) return SolveStatus::non_finite;
    return first_response > kLimit ? SolveStatus::iteration_cap : SolveStatus::converged;
  }

  std::unique_ptr<Evaluator> evaluator(const SolverOptions& /*options*/) const override {
    return std::make_unique<Failing>();
  }

 private:
  class Failing final : public FakeEvaluator {
   public:
    Failing() : FakeEvaluator(kArm) {}

    void evaluate(const SampleBlock& samples, const OutcomeBlock& outcomes) override {
      FakeEvaluator::evaluate(samples, outcomes);
      for (std::size_t b = 0; b < samples.count; ++b) outcomes.status[b] = status(outcomes.responses[b]);
    }
  };
};

/// A catalog with only the FailingModel.
inline Catalog failing_catalog() {
  return {{FakeModel::describe(), [](std::span<const double> /*geometry*/, std::size_t /*fidelity*/) {
             return std::make_unique<FailingModel>();
           }}};
}

}  // namespace poesy::test
