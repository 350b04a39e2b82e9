#pragma once

#include "engine/model/model.h"
#include "models/chain/deformation_model.h"

namespace poesy::bench {

/// The published 2UPR-RPU solved by chain::DeformationSolver: plain double arithmetic, one sample at a time.
class ReferenceModel final : public Model {
 public:
  /// The model must outlive this one.
  explicit ReferenceModel(const Model& model);

  const ModelDescription& description() const override { return model_->description(); }
  std::optional<std::string> unreachable(std::span<const double> pose) const override {
    return model_->unreachable(pose);
  }
  std::vector<double> joint_displacements(std::span<const double> pose) const override {
    return model_->joint_displacements(pose);
  }
  double condition(std::span<const double> pose) const override { return model_->condition(pose); }
  /// Details are not given.
  std::unique_ptr<Evaluator> evaluator(const SolverOptions& options) const override;

 private:
  const Model* model_;
  chain::DeformationModel deformation_;
};

}  // namespace poesy::bench
