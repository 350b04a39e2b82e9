#pragma once

#include <memory>
#include <optional>
#include <utility>

#include "engine/base/contract.h"
#include "engine/model/model.h"

namespace poesy {

/// The base class of models that wrap another model and change some of its functions. All functions that a derived
/// class does not override call those of the wrapped model.
class ForwardingModel : public Model {
 public:
  const ModelDescription& description() const override { return model_->description(); }
  std::optional<std::string> unreachable(std::span<const double> pose) const override {
    return model_->unreachable(pose);
  }
  std::vector<double> joint_displacements(std::span<const double> pose) const override {
    return model_->joint_displacements(pose);
  }
  double condition(std::span<const double> pose) const override { return model_->condition(pose); }
  std::optional<bool> are_separated(std::span<const double> one, std::span<const double> other) const override {
    return model_->are_separated(one, other);
  }
  std::unique_ptr<Evaluator> evaluator(const SolverOptions& options) const override {
    return formed(model_->evaluator(options));
  }
  std::unique_ptr<Evaluator> calibrated_evaluator(const SolverOptions& options) const override {
    return formed(model_->calibrated_evaluator(options));
  }
  std::optional<SolveTrace> trace(std::span<const double> pose, std::span<const double> errors,
                                  const SolverOptions& options) const override {
    return model_->trace(pose, errors, options);
  }
  std::optional<std::vector<double>> pose_from_chart(std::size_t chart,
                                                     std::span<const double> coordinates) const override {
    return model_->pose_from_chart(chart, coordinates);
  }
  std::string no_pose_because(std::size_t chart, std::span<const double> coordinates) const override {
    return model_->no_pose_because(chart, coordinates);
  }
  std::vector<double> norm_of_details(std::size_t response, std::span<const double> pose) const override {
    return model_->norm_of_details(response, pose);
  }
  Separation separation(std::span<const double> pose) const override { return model_->separation(pose); }
  double rounding(std::size_t response) const override { return model_->rounding(response); }
  ErrorBound error_bound(FactorIndex factor) const override { return model_->error_bound(factor); }
  std::vector<PlatformPoint> metric_points() const override { return model_->metric_points(); }
  std::vector<std::string> mobility() const override { return model_->mobility(); }
  std::vector<std::string> remarks() const override { return model_->remarks(); }
  std::optional<Sketch> sketch(std::span<const double> pose) const override { return model_->sketch(pose); }
  std::vector<std::string> unusual_geometry() const override { return model_->unusual_geometry(); }
  std::vector<std::string> unusual_errors() const override { return model_->unusual_errors(); }

  const Model& behind() const { return *model_; }  ///< The wrapped model.
  /// Wraps an evaluator of the wrapped model, so that the result also computes the responses that this model adds; by
  /// default there are none. Returns null if the evaluator is null.
  virtual std::unique_ptr<Evaluator> formed(std::unique_ptr<Evaluator> evaluator) const { return evaluator; }

 protected:
  /// model: the model to wrap, not null.
  explicit ForwardingModel(std::shared_ptr<const Model> model) : model_(std::move(model)) {
    POESY_EXPECTS(model_ != nullptr);
  }

 private:
  std::shared_ptr<const Model> model_;
};

/// The model that solves the mechanism: the innermost of the wrapped models, or `model` itself if it wraps none. Each
/// wrapper appends responses to the list of the model inside it, so the responses of the innermost model come first.
const Model& solving_model(const Model& model);

/// Wraps an evaluator of solving_model(model) in the evaluators of all wrappers, so that it computes all responses of
/// `model`.
std::unique_ptr<Evaluator> all_formed(const Model& model, std::unique_ptr<Evaluator> solving);

}  // namespace poesy
