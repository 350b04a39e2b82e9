#include "engine/kinds/calibrated_model.h"

#include <optional>
#include <utility>

#include "engine/run/outlook.h"

namespace poesy {
namespace {

using calibration::Matrix;

class CalibratingEvaluator final : public Evaluator {
 public:
  explicit CalibratingEvaluator(const MachineCalibration& calibration)
      : calibrator_(calibration), corrected_(calibration.corrected()) {}

  void evaluate(const SampleBlock& samples, const OutcomeBlock& outcomes) override {
    Matrix errors = all_errors(samples);
    if (errors.rows() != errors_.rows() || errors.cols() != errors_.cols() || errors != errors_) {
      corrected_->set(calibrator_.without_noise(errors));
      errors_ = std::move(errors);
    }
    corrected_->evaluate(samples, outcomes);
  }

 private:
  MachineCalibrator calibrator_;
  std::unique_ptr<calibration::CorrectedEvaluator> corrected_;
  Matrix errors_;  ///< [all errors x samples] errors of the last block of samples, SI; `corrected_` has the controllers
                   ///< of the machines with these errors
};

}  // namespace

std::unique_ptr<Evaluator> CalibratedModel::evaluator(const SolverOptions&) const {
  return all_formed(behind(), std::make_unique<CalibratingEvaluator>(*calibration_));
}

std::shared_ptr<const Model> studied_model(const Study& study, const Model& model, const PoseSet& poses) {
  struct Calibrated {
    std::optional<MachineCalibration> calibration;
    std::unique_ptr<Model> model = nullptr;
  };
  const auto both = std::make_shared<Calibrated>(Calibrated{machine_calibration(study, model, poses)});
  if (!both->calibration) return borrowed(model);
  both->model = std::make_unique<CalibratedModel>(build_model(study.mechanism), *both->calibration);
  return {both, both->model.get()};
}

}  // namespace poesy
