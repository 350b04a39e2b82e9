#pragma once

#include "engine/model/model.h"
#include "models/chain/deformation_model.h"

namespace poesy::bench {

/// The mechanism 2upr-rpu with the published metric, solved by chain::DeformationSolver in plain double arithmetic, one
/// sample at a time.
class ReferenceModel final : public Model {
 public:
  /// model: the mechanism 2upr-rpu with its published geometry; must outlive this object.
  explicit ReferenceModel(const Model& model);

  const ModelDescription& description() const override { return model_->description(); }
  std::optional<std::string> unreachable(std::span<const double> pose) const override {
    return model_->unreachable(pose);
  }
  std::vector<double> joint_displacements(std::span<const double> pose) const override {
    return model_->joint_displacements(pose);
  }
  double condition(std::span<const double> pose) const override { return model_->condition(pose); }
  /// The evaluator does not write OutcomeBlock::details.
  std::unique_ptr<Evaluator> evaluator(const SolverOptions& options) const override;

 private:
  const Model* model_;
  chain::DeformationModel deformation_;
};

}  // namespace poesy::bench
