#pragma once

#include <memory>

#include "engine/kinds/machine_calibration.h"
#include "engine/model/forwarding_model.h"

namespace poesy {

/// A mechanism whose sets of errors are calibrated machines: its responses are the deviations that remain after
/// calibration. Measurements have no noise, so an outcome depends only on the pose and the errors. An evaluator fits
/// again only when the errors of a block of samples differ from those of the block before it, so a caller should solve
/// the same errors at one pose after another.
class CalibratedModel final : public ForwardingModel {
 public:
  /// model: as for the calibration. The calibration must outlive this object.
  CalibratedModel(std::unique_ptr<Model> model, const MachineCalibration& calibration)
      : ForwardingModel(std::move(model)), calibration_(&calibration) {}

  std::unique_ptr<Evaluator> evaluator(const SolverOptions& options) const override;

 private:
  const MachineCalibration* calibration_;
};

/// The model of a study that solves given or single errors: the mechanism, or with a calibration one that calibrates
/// each set of errors. Refers to the study and the model. Throws as MachineCalibration does.
std::shared_ptr<const Model> studied_model(const Study& study, const Model& model, const PoseSet& poses);

}  // namespace poesy
