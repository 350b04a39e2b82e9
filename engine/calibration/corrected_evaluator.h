#pragma once

#include <array>
#include <map>
#include <memory>
#include <optional>
#include <span>
#include <vector>

#include "engine/calibration/drive_correction.h"
#include "engine/calibration/left.h"

namespace poesy::calibration {

/// The controllers of several calibrated machines, one for each machine.
struct Controllers {
  Matrix errors;  ///< [all errors x machines] errors that each controller corrects, SI; NaN if not calibrated
  /// [places x machines] Fitted numbers of the frame of the measuring device and of the target (Measurement), SI. Their
  /// true values are 0.
  Matrix phi;
};

/// Solves calibrated machines, each at the drive positions to which its own controller moves. Responses that are
/// components of the platform's displacement, or norms of them, get the values of the remaining displacement, which is
/// the displacement from the commanded pose as the measuring device sees it. All other responses are those of the
/// machine at these drive positions. The status is SolveStatus::non_finite if the machine was not calibrated, or if its
/// controller finds no drive positions.
class CorrectedEvaluator final : public Evaluator {
 public:
  /// The model that is solved is solving_model(model), without the responses that a study adds. Throws
  /// std::invalid_argument as ExactMachine does.
  CorrectedEvaluator(const Model& model, const SolverOptions& solver, CoordinateError commanded, Frame frame);

  /// Sets the controllers for the next blocks of samples. Precondition: each of these blocks has one sample for each
  /// controller.
  void set(Controllers controllers) { controllers_ = std::move(controllers); }

  void evaluate(const SampleBlock& samples, const OutcomeBlock& outcomes) override;

 private:
  /// The outcomes at one pose for two sets of errors: the errors that the controller knows, and the true errors.
  struct Pair {
    std::vector<double> responses;  ///< [responses x 2] responses of both sets
    std::vector<double> details;    ///< [components x 2] additional outputs of both sets
    std::array<SolveStatus, 2> status;
    std::array<std::uint32_t, 2> iterations;

    /// Returns the values for the second set of errors from rows [rows x 2] with a value for each set.
    static std::vector<double> second(const std::vector<double>& rows);
  };
  /// The outcome of one machine; see OutcomeBlock.
  struct Outcome {
    std::vector<double> responses;
    std::vector<double> details;
    SolveStatus status = SolveStatus::non_finite;
    std::uint32_t iterations = 0;
  };

  /// `poses_` keeps the CommandedPose of at most this number of poses, for later samples at the same poses.
  static constexpr std::size_t kMostPoses = 1024;

  const CommandedPose& commanded_at(std::span<const double> pose);
  /// [all errors x 2] First the errors that the controller knows, then the true errors of sample b, SI.
  Matrix errors_of(const SampleBlock& samples, std::size_t b) const;
  /// Solves the machine at a pose with the errors that the controller knows, and with the true errors of the sample.
  Pair solve(std::span<const double> pose, const Matrix& errors, std::size_t details);
  /// The displacement of the platform for one set of errors (0 or 1), from the responses that are its components.
  Displacement displacement_of(const Pair& pair, std::size_t set) const;
  /// Solves sample b with the drive positions to which its controller moves. uncorrected: the displacement at the
  /// commanded pose with the errors that the controller knows and without a correction of the drives.
  Outcome corrected(const SampleBlock& samples, std::size_t b, const CommandedPose& commanded,
                    const Displacement& uncorrected, std::size_t details);
  /// Replaces those responses that are components of the platform's displacement, or norms of them, by the values for
  /// the remaining displacement `left` as the device sees it.
  void move(const CommandedPose& commanded, const Displacement& left, std::size_t b, Outcome& outcome) const;

  ExactMachine machine_;
  DriveCorrection correction_;
  Frame frame_;
  Controllers controllers_;
  /// [responses] Index in kComponents of each response; none for a response that is not a component of the
  /// displacement.
  std::vector<std::optional<std::size_t>> component_;
  std::map<std::vector<double>, CommandedPose> poses_;
  std::vector<FactorIndex> all_;  ///< all errors of the model
};

}  // namespace poesy::calibration
