#pragma once

#include <functional>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "engine/kinds/registry.h"
#include "engine/model/model.h"
#include "engine/study/study.h"

namespace poesy::test {

/// Computes the responses to all errors at a pose with one coordinate.
using ErrorFunction = std::function<void(std::span<const double> errors, double pose, std::span<double> responses)>;

/// A model that is a plain function, e.g. one with known statistics. Its errors are x1, x2, ...; its responses have no
/// unit.
class FunctionModel : public Model {
 public:
  FunctionModel(std::size_t errors, std::vector<std::string> responses, ErrorFunction function)
      : description_(describe(errors, responses)), function_(std::move(function)) {}

  const ModelDescription& description() const override { return description_; }
  std::optional<std::string> unreachable(std::span<const double>) const override { return std::nullopt; }
  std::vector<double> joint_displacements(std::span<const double>) const override { return {}; }
  double condition(std::span<const double>) const override { return 1.0; }
  std::unique_ptr<Evaluator> evaluator(const SolverOptions&) const override;

  const ErrorFunction& function() const { return function_; }

 private:
  static ModelDescription describe(std::size_t errors, const std::vector<std::string>& responses) {
    ModelDescription model;
    model.name = "function";
    model.title = "a function with known statistics";
    model.pose_coordinates = {{"place", Dimension::length, "where the function is taken"}};
    model.pose_lower = {0.0};
    model.pose_upper = {1.0};
    for (std::size_t p = 0; p < errors; ++p) {
      model.factors.push_back({"x" + std::to_string(p + 1), Dimension::length, p / 2 + 1, p % 2, "an argument"});
    }
    for (const std::string& name : responses) model.responses.push_back({name, Dimension::number, "a value"});
    return model;
  }

  ModelDescription description_;
  ErrorFunction function_;
};

class FunctionEvaluator : public Evaluator {
 public:
  explicit FunctionEvaluator(const FunctionModel& model) : model_(&model) {}

  void evaluate(const SampleBlock& samples, const OutcomeBlock& outcomes) override {
    const std::size_t responses = model_->description().responses.size();
    std::vector<double> errors(samples.errors.begin(), samples.errors.end());
    std::vector<double> values(responses);
    for (std::size_t b = 0; b < samples.count; ++b) {
      for (std::size_t v = 0; v < samples.varied.size(); ++v) {
        errors[samples.varied[v].value] = samples.values[v * samples.count + b];
      }
      model_->function()(errors, samples.pose[0], values);
      for (std::size_t r = 0; r < responses; ++r) outcomes.responses[r * samples.count + b] = values[r];
      outcomes.status[b] = SolveStatus::converged;
      outcomes.iterations[b] = 1;
    }
  }

 private:
  const FunctionModel* model_;
};

inline std::unique_ptr<Evaluator> FunctionModel::evaluator(const SolverOptions&) const {
  return std::make_unique<FunctionEvaluator>(*this);
}

/// A study of all errors of a function, each with this distribution. entry: that of the function; it must outlive the
/// study.
inline Study function_study(const CatalogEntry& entry, const StudyKind& kind, const Distribution& distribution,
                            std::size_t samples) {
  Study study;
  study.mechanism.entry = &entry;
  study.errors.by_factor = std::vector<Distribution>(entry.description.factors.size(), distribution);
  study.analysis.kind = &kind;
  for (std::size_t p = 0; p < entry.description.factors.size(); ++p) study.analysis.factors.emplace_back(p);
  study.analysis.samples = samples;
  return study;
}

}  // namespace poesy::test
