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

/// How the machines of a study are calibrated: at which poses they are measured, with which noise, and what is fitted.
/// Immutable, and shared by all threads.
class MachineCalibration {
 public:
  /// Refers to the study and the model. poses: those of the study. Precondition: analysis.calibration is set. Throws
  /// InputError if the measurements do not determine what is fitted, or if a pose cannot be measured.
  MachineCalibration(const Study& study, const Model& model, const PoseSet& poses);

  /// This calibration for the machines of another study, which differs only in the sizes of its errors and in its seed.
  /// Only a prior depends on the sizes. Refers to the other study.
  MachineCalibration of(const Study& study) const;

  const Study& study() const { return *study_; }                   ///< The study.
  const Model& model() const { return *model_; }                   ///< The mechanism.
  std::span<const double> noise() const { return noise_; }         ///< [values] Noise of each measured value, SI.
  std::size_t values() const { return values_.size(); }            ///< The number of measured values.
  std::size_t measured_poses() const { return measured_.size(); }  ///< The number of poses that are measured.
  std::size_t fitted() const { return table().fit.size(); }        ///< The number of fitted errors.
  /// The directions of errors that are fitted.
  const calibration::FittedDirections& directions() const { return columns_.directions; }
  /// Prior knowledge of the errors; empty: none.
  const calibration::Prior& prior() const { return columns_.prior; }
  /// [values] Standard deviation by which each residual is divided: the noise, or equal values if all noise is 0.
  const calibration::Vector& weights() const { return weights_; }
  /// The polynomials from which the derivatives of the measurement are computed at any estimate.
  const calibration::Expansion& expansion() const { return *expansion_; }

  /// The measurement of this study, whose measured values are still 0. machine: computes the displacements of measured
  /// machines.
  calibration::Measurement measurement(calibration::ExactMachine& machine) const;
  /// An evaluator of calibrated machines, for one thread. Its responses are those of the model.
  std::unique_ptr<calibration::CorrectedEvaluator> corrected() const;
  /// An evaluator of calibrated machines with these controllers. It computes all responses of the model, also those
  /// that the study defines.
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

/// What the calibration costs in addition to the solves of a study, for `check`. each: "machine" or "case".
std::string calibration_cost_text(const MachineCalibration& calibration, std::string_view each);

/// [F x B] All errors of the samples of a block, SI.
calibration::Matrix all_errors(const SampleBlock& samples);

/// Calibrates machines: measures each with noise, and fits it. Owns the scratch of one thread. What it finds of a
/// machine depends only on the study, the machine's number and its errors.
class MachineCalibrator {
 public:
  /// The calibration must outlive this object and must not be moved.
  explicit MachineCalibrator(const MachineCalibration& calibration);

  /// The controllers of machines with these numbers [B], which determine the noise. errors: [F x B], SI.
  calibration::Controllers operator()(const calibration::Matrix& errors, std::span<const std::size_t> machines);
  /// The controllers of machines [F x B] that are measured without noise.
  calibration::Controllers without_noise(const calibration::Matrix& errors);
  /// The controllers of machines [F x B] whose values are measured with this noise [m x B], SI.
  calibration::Controllers with_noise(const calibration::Matrix& errors, const calibration::Matrix& noise);

 private:
  /// [m x B] Noise of each value, from streams of its own.
  calibration::Matrix noise(std::span<const std::size_t> machines) const;

  const MachineCalibration* calibration_;
  calibration::ExactMachine machine_;
  calibration::Measurement measurement_;
};

}  // namespace poesy
