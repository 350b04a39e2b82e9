#pragma once

#include <cstddef>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "engine/calibration/corrected_evaluator.h"
#include "engine/calibration/expansion.h"
#include "engine/kinds/fitted_errors.h"
#include "engine/model/model.h"
#include "engine/study/calibration.h"
#include "engine/study/study.h"

namespace poesy {

/// How the machines of a study are calibrated: the poses at which they are measured, the noise, and the errors that are
/// fitted. An object is immutable, and all threads share it.
class MachineCalibration {
 public:
  /// Keeps references to the study and the model. poses: poses of the study. Precondition: `analysis.calibration` is
  /// set. Throws InputError if the machines cannot be calibrated, for instance because the measurements do not
  /// determine the fitted errors.
  MachineCalibration(const Study& study, const Model& model, const PoseSet& poses);

  /// This calibration for the machines of another study. Precondition: the studies differ only in the sizes of the
  /// errors and in the seed. Only the scales of the fitted errors and the prior depend on the sizes. The result keeps a
  /// reference to `study`.
  MachineCalibration of(const Study& study) const;

  const Study& study() const { return *study_; }  ///< The study.
  const Model& model() const { return *model_; }  ///< The model of the mechanism.
  /// [values] Standard deviation of the noise of each measured value, SI.
  std::span<const double> noise() const { return noise_; }
  std::size_t values() const { return values_.size(); }            ///< The number of measured values.
  std::size_t measured_poses() const { return measured_.size(); }  ///< The number of poses that are measured.
  std::size_t fitted() const { return table().fit.size(); }        ///< The number of fitted errors.
  /// The fitted errors, as directions in the space of all errors.
  const calibration::FittedDirections& directions() const { return columns_.directions; }
  /// Prior knowledge of the fitted errors; empty if there is none.
  const calibration::Prior& prior() const { return columns_.prior; }
  /// [values] Number by which the residual of each measured value is divided, SI: the standard deviation of its noise,
  /// or 1e-6 for all values if all noise is 0.
  const calibration::Vector& weights() const { return weights_; }
  /// The polynomials that give the derivatives of the measured values at any estimate of the errors.
  const calibration::Expansion& expansion() const { return *expansion_; }

  /// A measurement at the poses of the calibration; its measured values are 0 until they are set. machine: solves the
  /// machines that are measured; it must outlive the result.
  calibration::Measurement measurement(calibration::ExactMachine& machine) const;
  /// An evaluator of calibrated machines, for one thread. It computes the model's own responses, without those that the
  /// study defines.
  std::unique_ptr<calibration::CorrectedEvaluator> corrected() const;
  /// An evaluator of machines with these controllers. It computes all responses, including those that the study
  /// defines.
  std::unique_ptr<Evaluator> evaluator(calibration::Controllers controllers) const;

 private:
  const CalibrationTable& table() const { return *study_->analysis.calibration; }
  calibration::Frame frame() const { return static_cast<calibration::Frame>(table().frame); }
  calibration::Target target() const { return static_cast<calibration::Target>(table().target); }
  void list_values();
  void set_weights();
  void check_limits() const;
  void check_count() const;
  void check_seen(const calibration::Measurement& measurement) const;

  const Study* study_;
  const Model* model_;
  PoseSet measured_;
  calibration::CoordinateError commanded_;
  std::vector<calibration::MeasuredValue> values_;
  std::vector<double> noise_;
  calibration::Vector weights_;
  FittedColumns columns_;
  std::shared_ptr<const calibration::Expansion> expansion_;
};

/// The calibration of a study's machines; none if the study has no [analysis.calibration].
std::optional<MachineCalibration> machine_calibration(const Study& study, const Model& model, const PoseSet& poses);

/// A text for `poesy check`: the work that the calibration adds to the solves of a study. each: the word for what is
/// calibrated, "machine" or "case".
std::string calibration_cost_text(const MachineCalibration& calibration, std::string_view each);

/// [all errors x samples] The values of all errors in the samples of a block, SI.
calibration::Matrix all_errors(const SampleBlock& samples);

/// Calibrates simulated machines: computes the measured values of each machine, adds noise, and fits the errors. Owns
/// the scratch memory of one thread. The result for a machine depends only on the study, the machine's number and its
/// errors.
class MachineCalibrator {
 public:
  /// The calibration must outlive this object and must not be moved.
  explicit MachineCalibrator(const MachineCalibration& calibration);

  /// Calibrates machines and returns their controllers. errors: [all errors x machines], SI. machines: the number of
  /// each machine, which determines its noise.
  calibration::Controllers operator()(const calibration::Matrix& errors, std::span<const std::size_t> machines);
  /// Calibrates machines that are measured without noise. errors: [all errors x machines], SI.
  calibration::Controllers without_noise(const calibration::Matrix& errors);
  /// Calibrates machines that are measured with this noise. errors: [all errors x machines], SI. noise: [measured
  /// values x machines], SI.
  calibration::Controllers with_noise(const calibration::Matrix& errors, const calibration::Matrix& noise);

 private:
  /// [measured values x machines] The noise of each value of each machine, SI. Each value has its own stream of random
  /// numbers.
  calibration::Matrix noise(std::span<const std::size_t> machines) const;

  const MachineCalibration* calibration_;
  calibration::ExactMachine machine_;
  calibration::Measurement measurement_;
};

}  // namespace poesy
