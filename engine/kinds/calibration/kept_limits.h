#pragma once

#include <span>
#include <string>
#include <vector>

#include "engine/calibration/left.h"
#include "engine/model/model.h"
#include "engine/study/study.h"

namespace poesy::calibration {

/// The probability that a calibrated machine keeps the limits of its study. It is estimated as the share of 1000
/// machines that keep all limits. The errors of these machines are drawn from the estimated distribution of the
/// calibrated machine's errors, and the machines are solved exactly.
class KeptLimits {
 public:
  /// Draws the machines. known: estimates and covariance of the calibrated machine's errors.
  KeptLimits(const Study& study, const Model& model, const calibration::Knowledge& known);

  /// Solves the machines at a pose and returns the displacements (rad, m) that remain after the correction, [components
  /// x machines]. The drive positions are those of the perfect mechanism at the pose `drive_at`. Empty if no limit can
  /// be judged. Several threads may call this at once, each with its own `machine`.
  calibration::Matrix left_at(calibration::ExactMachine& machine, std::span<const double> pose,
                              std::span<const double> drive_at, const calibration::Corrected& corrected) const;
  /// Adds the displacements that left_at() returned for the next pose.
  void add(const calibration::Matrix& left);

  /// The share of machines that keep all limits that can be judged; NaN if no limit can be judged.
  double share() const;
  /// A clause that names the limits that cannot be judged, because their responses are not displacements of the
  /// platform; empty if there are none.
  std::string not_judged() const { return not_judged_; }

 private:
  /// A limit, and the components of the displacement from which its response is computed.
  struct Judged {
    ValueLimit allowed;
    /// Indices in kComponents: the response itself, or the components of which it is the norm.
    std::vector<std::size_t> components;
    std::vector<std::vector<double>> values = {};  ///< [machines] responses at the poses so far
  };

  std::vector<Judged> limits_;
  calibration::Matrix errors_;  ///< [all errors x machines] errors, SI
  calibration::Matrix phi_;  ///< [places x machines] numbers that place the measuring device's frame and the target, SI
  std::string not_judged_;
};

}  // namespace poesy::calibration
