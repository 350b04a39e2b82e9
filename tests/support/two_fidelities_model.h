#pragma once

#include "tests/support/fake_model.h"

namespace poesy::test {

/// The fake mechanism with one signed response: the sum of kWeights[p] e_p over its errors. The exact fidelity adds the
/// quadratic term bend e_p^2 for each error. So a normal error with the standard deviation s shifts the mean by bend
/// s^2 and contributes the variance weight^2 s^2 + 2 bend^2 s^4. delta_2 has no effect.
class TwoFidelitiesModel final : public FakeModel {
 public:
  static constexpr double kBend = 0.5;
  static constexpr double kWeights[3] = {2.0, 1.0, 0.0};

  explicit TwoFidelitiesModel(bool exact) : exact_(exact) {}

  static ModelDescription describe_both() {
    ModelDescription model = describe();
    model.responses = {{"y", Dimension::length, "the response"}};
    model.deformation.reset();
    model.details.clear();
    model.fidelities = {"exact", "first-order"};
    return model;
  }

  const ModelDescription& description() const override { return both_; }

  std::unique_ptr<Evaluator> evaluator(const SolverOptions& /*options*/) const override {
    return std::make_unique<Quadratic>(exact_ ? kBend : 0.0);
  }

 private:
  class Quadratic final : public Evaluator {
   public:
    explicit Quadratic(double bend) : bend_(bend) {}

    void evaluate(const SampleBlock& samples, const OutcomeBlock& outcomes) override {
      std::vector<double> errors(samples.errors.begin(), samples.errors.end());
      for (std::size_t b = 0; b < samples.count; ++b) {
        for (std::size_t v = 0; v < samples.varied.size(); ++v) {
          errors[samples.varied[v].value] = samples.values[v * samples.count + b];
        }
        double sum = 0.0;
        for (std::size_t p = 0; p < 2; ++p) sum += kWeights[p] * errors[p] + bend_ * errors[p] * errors[p];
        outcomes.responses[b] = sum;
        outcomes.status[b] = SolveStatus::converged;
        outcomes.iterations[b] = 1;
      }
    }

   private:
    double bend_;
  };

  ModelDescription both_ = describe_both();
  bool exact_;
};

/// A catalog with only the TwoFidelitiesModel.
inline Catalog two_fidelities_catalog() {
  return {{TwoFidelitiesModel::describe_both(), [](std::span<const double> /*geometry*/, std::size_t fidelity) {
             return std::make_unique<TwoFidelitiesModel>(fidelity == 0);
           }}};
}

}  // namespace poesy::test
