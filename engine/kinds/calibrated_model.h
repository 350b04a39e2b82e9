#pragma once

#include <memory>

#include "engine/kinds/machine_calibration.h"
#include "engine/model/forwarding_model.h"

namespace poesy {

/// The model of calibrated machines. Each set of errors is a machine that is calibrated from measurements without
/// noise. Responses for the displacement of the platform give the displacement that remains after calibration. An
/// outcome depends only on the pose and the errors. An evaluator fits again only when the errors of a block of samples
/// differ from those of the block before it, so a caller should solve the same errors at all poses before it solves
/// other errors.
class CalibratedModel final : public ForwardingModel {
 public:
  /// model: the model for which the calibration was made. The calibration must outlive this object.
  CalibratedModel(std::unique_ptr<Model> model, const MachineCalibration& calibration)
      : ForwardingModel(std::move(model)), calibration_(&calibration) {}

  std::unique_ptr<Evaluator> evaluator(const SolverOptions& options) const override;

 private:
  const MachineCalibration* calibration_;
};

/// The model for a study that states its errors, or that varies one error at a time: `model`, or a CalibratedModel if
/// the study has [analysis.calibration]. The result keeps references to the study and the model. Throws InputError as
/// the constructor of MachineCalibration does.
std::shared_ptr<const Model> studied_model(const Study& study, const Model& model, const PoseSet& poses);

}  // namespace poesy
